/* Run of one parameter set, its trace on the grid of steps, and the samples of every channel through its sensor. */

#define SCAN_POINTS 8192

/* What `run` returns beside the number of a step. */
enum { RAN = -1, NO_CURRENT = -2 };

/* Cooling branch less heating branch at x [degC]. */
static inline double branch_gap(const double *up, const double *down, double x)
{
    return gompertz(down[0], down[1], down[2], down[3], x) - gompertz(up[0], up[1], up[2], up[3], x);
}

/* Where the gap becomes negative between `low` and `high`, to the last bit. */
static double bisect_crossing(const double *up, const double *down, double low, double high)
{
    for (double middle = 0.5 * (low + high); middle > low && middle < high; middle = 0.5 * (low + high)) {
        if (branch_gap(up, down, middle) < 0.0) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return high;
}

/* Highest temperature [degC] at which the cooling branch passes below the heating branch; infinite if it stays above it.
 * The same search as in fmus/thermal_stiffness/model.c. */
static double find_crossing(const double *up, const double *down)
{
    const double absolute_zero = -CELSIUS;
    double high = fmax((log(up[1]) + 40.0) / up[2], (log(down[1]) + 40.0) / down[2]);
    if (!(branch_gap(up, down, high) < 0.0)) {
        return INFINITY;
    }
    const double width = (high - absolute_zero) / SCAN_POINTS;
    double low = high;
    for (int i = 0; branch_gap(up, down, low) < 0.0; i++) {
        if (i == SCAN_POINTS) {
            return absolute_zero; /* below everywhere: the heating branch alone */
        }
        high = low;
        low = high - width;
    }
    return bisect_crossing(up, down, low, high);
}

/* The same where it is known to lie near `guess`; not a number if it does not. */
static double crossing_near(double guess, const double *up, const double *down)
{
    const double low = guess - 2.0, high = guess + 2.0;
    if (!isfinite(guess) || guess < 2.0 - CELSIUS || !(branch_gap(up, down, high) < 0.0) ||
        branch_gap(up, down, low) < 0.0) {
        return NAN;
    }
    return bisect_crossing(up, down, low, high);
}

/* A search takes longer than many steps. Most sets of a batch have the coils of the one before: a coil whose shape is
 * that of the set before, and whose neighbour's crossing is too, has the same crossing to the last bit. */
static void find_crossings(Step *s)
{
    double last[8] = {NAN};
    const Crossings *known = s->known;
    for (int64_t i = 0; i < s->width; i++) {
        double shape[8];
        for (int64_t j = 0; j < 8; j++) {
            shape[j] = COIL(heating_a)[j * s->width + i]; /* heating_a to cooling_d follow each other */
        }
        const int is_known = known && !memcmp(shape, known->shape + 8 * i, sizeof shape);
        if (i > 0 && !memcmp(shape, last, sizeof shape)) {
            s->crossing[i] = s->crossing[i - 1];
        } else if (is_known && (i == 0 || s->crossing[i - 1] == known->crossing[i - 1])) {
            s->crossing[i] = known->crossing[i];
        } else {
            const double near = i > 0 ? crossing_near(s->crossing[i - 1], shape, shape + 4) : NAN;
            s->crossing[i] = isfinite(near) ? near : find_crossing(shape, shape + 4);
        }
        memcpy(last, shape, sizeof shape);
    }
    /* kept only now: a coil looks at the crossing that its neighbour had in the set before */
    for (int64_t i = 0; known && i < s->width; i++) {
        known->crossing[i] = s->crossing[i];
        for (int64_t j = 0; j < 8; j++) {
            known->shape[8 * i + j] = COIL(heating_a)[j * s->width + i];
        }
    }
}

static void begin(Step *s)
{
    const Plan *plan = s->plan;
    const double *start = plan->given ? plan->given : COIL(initial_temperature);
    for (int64_t i = 0; i < s->width; i++) {
        s->temperature[i] = s->before[i] = s->middle[i] = start[i];
        s->rate[i] = s->slope[i] = s->energy[i] = s->power[i] = s->current[i] = s->voltage[i] = s->phase[i] = 0.0;
        s->ambient[i] = plan->ambient[0] + COIL(ambient_offset)[i];
        s->tension[i] = COIL(load)[i];
        s->extension[i] = s->shift[i] = 0.0;
        s->stiffness[i] = COIL(heating_d)[i];
        s->heating[i] = s->cooling[i] = s->remembered[i] = 0.0;
    }
    for (int64_t n = 0; n < s->strings; n++) {
        s->string_current[n] = s->string_voltage[n] = s->terminal_voltage[n] = 0.0;
    }
    s->supply_power[0] = s->supply_current[0] = 0.0;
    find_crossings(s);
    s->t = s->t_begin = s->t_end = plan->time[0];
    s->dt = s->dt_middle = 0.0;
    s->felt = s->temperature;
    START_states(s);
    find_resistance(s, s->temperature);
    find_stiffness(s);
    for (int64_t i = 0; i < s->width; i++) { /* a coil that was never heated is on the heating branch */
        s->remembered[i] = s->heating[i] + COIL(initial_loop_position)[i] * (s->cooling[i] - s->heating[i]);
    }
    find_stiffness(s);
    START_states(s); /* again: some states begin at the phase */
    find_length(s);
}

static void keep(Step *s, double *const *trace, int64_t row)
{
    double *const from[QUANTITIES] = {QUANTITY_ARRAYS};
    for (int q = 0; q < QUANTITIES; q++) {
        if (trace[q]) {
            const int64_t elements = quantity_elements(s, q);
            memcpy(trace[q] + row * elements, from[q], elements * sizeof(double));
        }
    }
}

/* Rows and weight for a sample at `time`: value = (1 - w) trace[a] + w trace[b]. `hint` moves up with the samples. */
static double locate(const Plan *plan, int is_flow, double time, int64_t *hint, int64_t *a, int64_t *b)
{
    const double *grid = plan->time;
    int64_t k = *hint;
    while (k < plan->steps - 1 && grid[k + 1] < time) {
        k++;
    }
    while (k > 0 && grid[k] >= time) {
        k--;
    }
    *hint = k;
    *a = k;
    *b = k + 1;
    if (!is_flow) {
        return clip((time - grid[k]) / (grid[k + 1] - grid[k]), 0.0, 1.0);
    }
    /* A flow belongs to its whole step; its value at the middle is joined to that of a neighbour without a jump. */
    *a = *b = k + 1;
    if (!plan->is_midpoint) {
        return 0.0;
    }
    const double middle = 0.5 * (grid[k] + grid[k + 1]);
    const int can_rise = k + 1 < plan->steps && !plan->is_switch[k + 1], can_fall = k > 0 && !plan->is_switch[k];
    const int64_t other = (time > middle && can_rise) || !can_fall ? k + 1 : k - 1;
    if (other > k ? !can_rise : !can_fall) {
        return 0.0;
    }
    *b = other + 1;
    return (time - middle) / (0.5 * (grid[other] + grid[other + 1]) - middle);
}

/* First-order lag, exact for values that run straight (or, for a flow, stand still) between the rows. */
static void lag_column(const Plan *plan, int is_flow, double lag, double *column)
{
    double y = column[0], last = -1.0, decay = 0.0, before = column[0];
    for (int64_t k = 0; k < plan->steps; k++) {
        const double dt = plan->time[k + 1] - plan->time[k], now = column[k + 1];
        if (dt != last) {
            decay = network_exp(-dt / lag);
            last = dt;
        }
        const double behind = is_flow ? 0.0 : (now - before) / dt * lag;
        y = now - behind + (y - (is_flow ? now : before) + behind) * decay;
        before = now;
        column[k + 1] = y;
    }
}

/* The same for all elements of a quantity at once, from rows to rows. */
static void lag_rows(const Plan *plan, int is_flow, double lag, int64_t elements, const double *restrict trace,
                     double *restrict rows)
{
    double last = -1.0, decay = 0.0;
    memcpy(rows, trace, elements * sizeof(double));
    for (int64_t k = 0; k < plan->steps; k++) {
        const double dt = plan->time[k + 1] - plan->time[k];
        const double *before = trace + k * elements, *now = before + elements, *y = rows + k * elements;
        double *next = rows + (k + 1) * elements;
        if (dt != last) {
            decay = network_exp(-dt / lag);
            last = dt;
        }
        if (is_flow) {
            _Pragma("GCC ivdep") for (int64_t i = 0; i < elements; i++) next[i] = now[i] + (y[i] - now[i]) * decay;
        } else {
            _Pragma("GCC ivdep") for (int64_t i = 0; i < elements; i++)
            {
                const double behind = (now[i] - before[i]) / dt * lag;
                next[i] = now[i] - behind + (y[i] - before[i] + behind) * decay;
            }
        }
    }
}

static int64_t string_of(const Plan *plan, int64_t coil)
{
    int64_t n = 0;
    while (plan->first[n + 1] <= coil) {
        n++;
    }
    return n;
}

/* Current of the coil that a channel reads, by its clock; the lag of a sensor lies before what picks the current up. */
static void sample_current(const Plan *plan, const double *trace, int64_t element, int64_t partner, Sensor *sensor)
{
    const int64_t own = string_of(plan, element), other = string_of(plan, partner);
    int64_t hint = 0, a, b;
    for (int64_t n = 0; n < sensor->samples; n++) {
        const double w = locate(plan, 1, sensor->time[n] - sensor->offset, &hint, &a, &b);
        const double *low = trace + a * plan->strings, *high = trace + b * plan->strings;
        const double here = low[own] + w * (high[own] - low[own]), there = low[other] + w * (high[other] - low[other]);
        sensor->current[n] = here + sensor->share * (there - here);
    }
}

static void sample_channel(const Step *s, int q, double *const *traces, Sensor *sensor, double *column, double *raw)
{
    const double *trace = traces[q];
    const Plan *plan = s->plan;
    const int64_t elements = quantity_elements(s, q), element = sensor->channel - quantity_channel(s, q);
    const int is_flow = quantity_is_flow[q];
    sensor->partner = element;
    sensor->offset = s->late[q];
    sensor->lag = s->slow[q];
    HOOK_channel(sensor);
    const int64_t partner = sensor->partner < 0 || sensor->partner >= elements ? element : sensor->partner;
    for (int64_t k = 0; k <= plan->steps; k++) {
        const double own = trace[k * elements + element];
        column[k] = own + sensor->share * (trace[k * elements + partner] - own);
    }
    int64_t hint = 0, a, b;
    const int is_lagged_flow = is_flow && sensor->lag > 0.0;
    if (is_lagged_flow) {
        memcpy(raw, column, (plan->steps + 1) * sizeof(double));
    }
    if (sensor->lag > 0.0) {
        lag_column(plan, is_flow, sensor->lag, column);
    }
    for (int64_t n = 0; n < sensor->samples; n++) {
        const double w = locate(plan, is_flow && !is_lagged_flow, sensor->time[n] - sensor->offset, &hint, &a, &b);
        if (is_lagged_flow) { /* a flow stands still within a step, so that what is behind it dies away exactly */
            const double since = w * (plan->time[b] - plan->time[a]);
            sensor->value[n] = raw[b] + (column[a] - raw[b]) * network_exp(-since / sensor->lag);
        } else {
            sensor->value[n] = column[a] + w * (column[b] - column[a]);
        }
    }
    if (sensor->current) {
        sample_current(plan, traces[QUANTITY_current], element, partner, sensor);
    }
    HOOK_sensor(sensor);
}

/* Samples of a quantity whose sensors are all alike: each instant is looked up once, and so is each step of the lag. */
static void sample_alike(const Step *s, int q, const double *trace, double *restrict out, double *rows)
{
    const Plan *plan = s->plan;
    const int64_t elements = quantity_elements(s, q), samples = plan->samples[q];
    const double *time = plan->sample_time[q], gain = 1.0 + s->wrong[q], lag = s->slow[q];
    const int is_lagged_flow = quantity_is_flow[q] && lag > 0.0;
    int64_t hint = 0, a, b;
    if (lag > 0.0) {
        lag_rows(plan, quantity_is_flow[q], lag, elements, trace, rows);
    }
    const double *read = lag > 0.0 ? rows : trace;
    for (int64_t n = 0; n < samples; n++) {
        const double w = locate(plan, quantity_is_flow[q] && !is_lagged_flow, time[n] - s->late[q], &hint, &a, &b);
        const double *low = read + a * elements, *high = read + b * elements;
        double *restrict into = out + n * elements;
        if (is_lagged_flow) { /* a flow stands still within a step, so that what is behind it dies away exactly */
            const double *raw = trace + b * elements, left = network_exp(-w * (plan->time[b] - plan->time[a]) / lag);
            _Pragma("GCC ivdep") for (int64_t i = 0; i < elements; i++) into[i] =
                gain * (raw[i] + (low[i] - raw[i]) * left);
        } else {
            _Pragma("GCC ivdep") for (int64_t i = 0; i < elements; i++) into[i] =
                gain * (low[i] + w * (high[i] - low[i]));
        }
    }
}

static void sample(const Step *s, int q, double *const *traces, double *out, double *work)
{
    const Plan *plan = s->plan;
    const int64_t elements = quantity_elements(s, q), samples = plan->samples[q];
    const double *time = plan->sample_time[q], gain = 1.0 + s->wrong[q];
    if (!HAS_SENSOR(plan)) {
        sample_alike(s, q, traces[q], out, work);
        return;
    }
    double *column = work, *raw = work + plan->steps + 1, *value = raw + plan->steps + 1;
    double *current = READS_CURRENT(plan) && plan->strings && quantity_is_of_coils[q] ? value + samples : NULL;
    for (int64_t i = 0; i < elements; i++) {
        Sensor sensor = {.set = s->set, .channel = quantity_channel(s, q) + i, .samples = samples, .time = time,
                         .value = value, .current = current};
        sample_channel(s, q, traces, &sensor, column, raw);
        for (int64_t n = 0; n < samples; n++) {
            out[n * elements + i] = gain * value[n];
        }
    }
}

/* Rows of the trace up to `row` hold the state at the end of each step, and flows of the step that ends there. */
static void keep_start(Step *s, double *const *trace)
{
    for (int q = 0; q < QUANTITIES; q++) {
        const int64_t elements = quantity_elements(s, q);
        if (trace[q] && quantity_is_flow[q]) {
            memcpy(trace[q], trace[q] + elements, elements * sizeof(double));
        }
    }
}

static int is_all_finite(const double *values, int64_t count)
{
    double sum = 0.0;
    for (int64_t i = 0; i < count; i++) {
        sum += values[i] * 0.0; /* 0, or not a number */
    }
    return sum == 0.0;
}

/* Places the arrays of a step in memory; returns what is left of it. */
static double *place(Step *s, double *memory)
{
    for (double **a = &s->temperature; a <= &s->length; a++) {
        *a = memory;
        memory += s->width;
    }
    for (double **a = &s->string_resistance; a <= &s->supply_current; a++) {
        *a = memory;
        memory += s->strings + s->sources + 1;
    }
    s->state = memory;
    s->state_rate = memory + STATES * s->width;
    return memory + 2 * STATES * s->width;
}

/* Fills the traces. Returns RAN, or the step in which a temperature or an extension stopped being finite. */
static int64_t simulate(Step *s, double *const *trace)
{
    const Plan *plan = s->plan;
    begin(s);
    keep(s, trace, 0);
    for (int64_t k = 0; k < plan->steps; k++) {
        advance(s, k);
        if (!is_all_finite(s->temperature, s->coils) || !is_all_finite(s->length, s->coils)) {
            return k;
        }
        if (trace[QUANTITY_resistance]) {
            find_resistance(s, s->temperature);
        }
        keep(s, trace, k + 1);
    }
    keep_start(s, trace);
    return RAN;
}

/* Traces of another simulation, to be read as this one is. */
static void copy_traces(const Step *s, double *const *trace)
{
    for (int q = 0; q < QUANTITIES; q++) {
        if (trace[q]) {
            memcpy(trace[q], s->plan->traces[q], (s->plan->steps + 1) * quantity_elements(s, q) * sizeof(double));
        }
    }
}

/* Whether the currents are known that terms of the sensors ask for. */
static int has_current(const Plan *plan)
{
    const int is_known = plan->traces ? plan->traces[QUANTITY_current] != NULL : plan->has_circuit;
    return !READS_CURRENT(plan) || !plan->strings || is_known;
}

/* Simulates one set. Returns RAN, NO_CURRENT, or the step in which something stopped being finite. */
static int64_t run(const Plan *plan, const double *set, double *out, double *memory, Crossings *known)
{
    Step step = {.plan = plan, .width = plan->width, .coils = plan->coils, .strings = plan->strings,
                 .sources = plan->sources, .set = set, .coil = set, .known = known};
    Step *s = &step;
    s->string = set + COIL_FIELDS * plan->width;
    s->source = s->string + STRING_FIELDS * plan->strings;
    s->late = s->source + SOURCE_FIELDS * plan->sources;
    s->slow = s->late + QUANTITIES;
    s->wrong = s->slow + QUANTITIES;
    memory = place(s, memory);
    if (!has_current(plan)) {
        return NO_CURRENT;
    }
    double *trace[QUANTITIES];
    for (int q = 0; q < QUANTITIES; q++) {
        const int is_kept = plan->samples[q] || (q == QUANTITY_current && READS_CURRENT(plan));
        trace[q] = is_kept ? memory : NULL;
        memory += is_kept ? (plan->steps + 1) * quantity_elements(s, q) : 0;
    }
    if (plan->traces) {
        copy_traces(s, trace);
    } else {
        const int64_t step = simulate(s, trace);
        if (step != RAN) {
            return step;
        }
    }
    for (int q = 0; q < QUANTITIES; q++) {
        if (plan->samples[q]) {
            sample(s, q, trace, out + plan->out_offset[q], memory);
        }
    }
    return RAN;
}

/* Simulates `sets` parameter sets one after the other; the number of the first that failed and its step are reported.
 * Returns 0, 1: not finite, 2: no memory. Keeps nothing between calls, so that threads may call it at once. */
int network_simulate(const Plan *plan, int64_t sets, const double *values, int64_t stride, double *out, int64_t out_stride,
                  int64_t *failure)
{
    int64_t size = 64 * plan->width + 16 * (plan->strings + plan->sources + 1) + (2 * STATES + 9) * plan->width;
    int64_t most_samples = 0;
    for (int q = 0; q < QUANTITIES; q++) {
        size += (plan->steps + 1) * (plan->coils + plan->strings + 1);
        most_samples = plan->samples[q] > most_samples ? plan->samples[q] : most_samples;
    }
    size += 2 * (plan->steps + 1) + 2 * most_samples + (plan->steps + 1) * (plan->coils + plan->strings + 1);
    double *memory = malloc(size * sizeof(double));
    if (!memory) {
        return 2;
    }
    double *crossings = memory + size - 9 * plan->width;
    Crossings known = {.crossing = crossings, .shape = crossings + plan->width};
    memset(crossings, 0xff, 9 * plan->width * sizeof(double)); /* not a number: none is known */
    int result = 0;
    for (int64_t n = 0; n < sets && !result; n++) {
        const int64_t step = run(plan, values + n * stride, out + n * out_stride, memory, &known);
        if (step != RAN) {
            failure[0] = n;
            failure[1] = step;
            result = 1;
        }
    }
    free(memory);
    return result;
}

/* exp of `count` numbers, for its test. */
void network_exponentials(int64_t count, const double *x, double *y)
{
    for (int64_t i = 0; i < count; i++) {
        y[i] = network_exp(x[i]);
    }
}
