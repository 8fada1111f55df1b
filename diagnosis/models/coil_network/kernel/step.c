/* One step: circuit, heat, stiffness, load. The same equations as circuit/, fmus/thermal_stiffness and the hanging mass.
 *
 * Within a step all inputs are constant, so the heat balance has its exact exponential. What depends on the temperature
 * is taken at the begin of the step (as the co-simulation does) or, with is_midpoint, at the middle, extrapolated from
 * the step before: second order in the step.
 */
#define COILS_LOOP _Pragma("GCC ivdep") for (int64_t i = 0; i < width; i++)

static void find_resistance(Step *s, const double *temperature)
{
    const int64_t width = s->width;
    const double *r0 = COIL(reference_resistance), *slope = COIL(resistance_temperature_coefficient);
    const double *reference = COIL(reference_temperature);
    double *restrict resistance = s->resistance;
    s->felt = (double *)temperature;
    COILS_LOOP resistance[i] = r0[i] * (1.0 + slope[i] * (temperature[i] - reference[i]));
    HOOK_resistance(s);
}

/* Strings in parallel behind the supply's resistance; a limit of the current lowers the voltage at the terminals. */
static void solve_once(Step *s)
{
    const Plan *plan = s->plan;
    double conductance[s->strings], total = 0.0, power = 0.0; /* power: out of the terminals of all sources */
    for (int64_t n = 0; n < s->strings; n++) {
        s->string_resistance[n] = STRING(string_resistance)[n];
    }
    for (int64_t n = 0; n < s->sources; n++) {
        s->supply_resistance[n] = SOURCE(supply_resistance)[n];
        s->current_limit[n] = 1e300;
        s->limited[n] = 0.0;
    }
    HOOK_string(s);
    HOOK_supply(s);
    for (int64_t n = 0; n < s->strings; n++) {
        double sum = s->string_resistance[n];
        for (int64_t i = plan->first[n]; i < plan->first[n + 1]; i++) {
            sum += s->resistance[i];
        }
        conductance[n] = 1.0 / sum;
    }
    for (int64_t n = 0; n < s->sources; n++) {
        const int64_t begin = s->sources == 1 ? 0 : n, end = s->sources == 1 ? s->strings : n + 1;
        double sum = 0.0;
        for (int64_t m = begin; m < end; m++) {
            sum += conductance[m];
        }
        /* With an ideal supply the strings do not feel each other, not even in the last bit. */
        double terminal = s->supply_voltage[n] / (1.0 + s->supply_resistance[n] * sum);
        const double free = fabs(terminal * sum);
        if (free > s->current_limit[n]) {
            terminal *= 1.0 + s->limited[n] * (s->current_limit[n] / free - 1.0);
        }
        total += terminal * sum;
        power += terminal * terminal * sum;
        for (int64_t m = begin; m < end; m++) {
            s->string_current[m] = terminal * conductance[m];
            s->terminal_voltage[m] = terminal;
        }
    }
    s->supply_current[0] = total;
    s->supply_power[0] = power;
}

/* Where a string's resistance depends on its current the two are found in turn; each turn makes the error smaller by the
 * share that this resistance has in the string. */
static void solve_circuit(Step *s)
{
    const Plan *plan = s->plan;
    const int turns = HAS_CURRENT_FEEDBACK(plan) ? 12 : 1;
    memcpy(s->source_voltage, plan->voltage + s->row * s->sources, s->sources * sizeof(double));
    HOOK_source(s);
    for (int n = 0; n < turns; n++) {
        memcpy(s->supply_voltage, s->source_voltage, s->sources * sizeof(double));
        solve_once(s);
    }
    for (int64_t n = 0; n < s->strings; n++) {
        s->string_voltage[n] = 0.0;
        for (int64_t i = plan->first[n]; i < plan->first[n + 1]; i++) {
            s->current[i] = s->string_current[n];
            s->voltage[i] = s->string_current[n] * s->resistance[i];
            s->power[i] = s->string_current[n] * s->string_current[n] * s->resistance[i];
            s->string_voltage[n] += s->voltage[i];
        }
    }
}

static void find_power(Step *s, int64_t k)
{
    const Plan *plan = s->plan;
    const int64_t width = s->width;
    double *restrict power = s->power;
    if (plan->has_circuit) {
        solve_circuit(s);
    }
    if (plan->power) {
        const double *given = plan->power + k * width, *gain = COIL(power_gain);
        COILS_LOOP power[i] = given[i] * gain[i];
    }
}

static void balance_heat(Step *s, int64_t k)
{
    const int64_t width = s->width;
    const double ambient_now = s->plan->ambient[k], dt = s->dt;
    const double *ha = COIL(conductance), *c = COIL(capacity), *shift = COIL(ambient_offset);
    const double *cooling = COIL(cooling_rate), *off = COIL(off_power), *is_regressed = COIL(use_regressed_cooling_rate);
    double *restrict heat = s->heat, *restrict conductance = s->conductance, *restrict capacity = s->capacity;
    double *restrict ambient = s->ambient, *restrict temperature = s->temperature, *restrict energy = s->energy;
    double *restrict rate = s->rate, *restrict slope = s->slope;
    double *restrict mean = s->mean;
    const double *power = s->power;
    COILS_LOOP
    {
        heat[i] = 0.0;
        capacity[i] = c[i];
        ambient[i] = ambient_now + shift[i];
        /* alpha C of equation (5) once the power is cut, if that reading is chosen (docs/decisions/0001) */
        conductance[i] = is_regressed[i] != 0.0 && power[i] <= off[i] ? cooling[i] * c[i] : ha[i];
    }
    s->felt = s->middle;
    HOOK_heat(s);
    HOOK_pairs(s, FORWARDS);
    HOOK_contacts(s, FORWARDS);
    COILS_LOOP
    {
        const double net = power[i] + heat[i] - conductance[i] * (temperature[i] - ambient[i]);
        const double exponent = conductance[i] / capacity[i] * dt, free = net / capacity[i];
        const double approach = network_approach(exponent), relaxation = 1.0 - exponent * approach;
        mean[i] = temperature[i] + free * dt * approach; /* what a neighbour feels, so that heat is conserved */
        rate[i] = free * relaxation;
        temperature[i] += rate[i] * dt;
        slope[i] = (net - conductance[i] * rate[i] * dt) / capacity[i];
        energy[i] += power[i] * dt;
    }
    if (HAS_PAIRS(s->plan)) {
        HOOK_contacts(s, BACKWARDS);
        HOOK_pairs(s, BACKWARDS);
        HOOK_pairs(s, AT_END);
        HOOK_contacts(s, AT_END);
        COILS_LOOP rate[i] = (temperature[i] - s->before[i]) / dt;
    }
}

static void find_stiffness(Step *s)
{
    const int64_t width = s->width;
    const double *ha = COIL(heating_a), *hb = COIL(heating_b), *hc = COIL(heating_c), *hd = COIL(heating_d);
    const double *ca = COIL(cooling_a), *cb = COIL(cooling_b), *cc = COIL(cooling_c), *cd = COIL(cooling_d);
    double *restrict heating = s->heating, *restrict cooling = s->cooling, *restrict remembered = s->remembered;
    double *restrict shift = s->shift, *restrict scale = s->scale, *restrict fraction = s->fraction;
    double *restrict added = s->added, *restrict stiffness = s->stiffness, *restrict phase = s->phase;
    const double *temperature = s->temperature, *crossing = s->crossing;
    s->felt = s->temperature;
    COILS_LOOP
    {
        shift[i] = added[i] = 0.0;
        scale[i] = fraction[i] = 1.0;
        s->heating_before[i] = heating[i];
        s->cooling_before[i] = cooling[i];
    }
    HOOK_stiffness(s);
    COILS_LOOP
    {
        const double celsius = temperature[i] - CELSIUS - shift[i];
        const double up = gompertz(ha[i], hb[i], hc[i], hd[i], celsius);
        const double down = gompertz(ca[i], cb[i], cc[i], cd[i], celsius);
        heating[i] = up;
        cooling[i] = celsius >= crossing[i] ? up : down; /* one branch above the crossing (docs/decisions/0002) */
    }
    HOOK_play(s);
    COILS_LOOP
    {
        const double kept = clip(remembered[i], least(heating[i], cooling[i]), most(heating[i], cooling[i]));
        remembered[i] = kept;
        phase[i] = clip((kept - hd[i]) / ha[i], 0.0, 1.0);
        stiffness[i] = (hd[i] + (kept - hd[i]) * fraction[i]) * scale[i] + added[i];
    }
}

static void find_length(Step *s)
{
    const int64_t width = s->width;
    const double *load = COIL(load), *rest_length = COIL(rest_length);
    double *restrict tension = s->tension, *restrict rest = s->rest, *restrict extension = s->extension;
    double *restrict before = s->extension_before, *restrict length = s->length;
    const double *stiffness = s->stiffness;
    COILS_LOOP
    {
        tension[i] = load[i];
        rest[i] = rest_length[i];
        before[i] = extension[i];
    }
    HOOK_load(s);
    COILS_LOOP extension[i] = tension[i] / stiffness[i];
    if (s->dt == 0.0) {
        COILS_LOOP before[i] = extension[i];
    }
    HOOK_length(s);
    COILS_LOOP length[i] = rest[i] + extension[i];
}

static void advance(Step *s, int64_t k)
{
    const Plan *plan = s->plan;
    const int64_t width = s->width;
    s->row = k;
    s->t_begin = plan->time[k];
    s->t_end = plan->time[k + 1];
    s->dt = s->t_end - s->t_begin;
    s->dt_middle = plan->is_midpoint ? 0.5 * s->dt : 0.0;
    s->t = plan->is_midpoint ? s->t_begin + s->dt_middle : s->t_begin;
    const double reach = plan->is_switch[k] ? 0.0 : s->dt_middle; /* the old rate says nothing after a jump */
    double *restrict middle = s->middle, *restrict before = s->before;
    const double *temperature = s->temperature, *slope = s->slope;
    COILS_LOOP
    {
        before[i] = temperature[i];
        middle[i] = temperature[i] + reach * slope[i];
    }
    find_resistance(s, s->middle);
    find_power(s, k);
    balance_heat(s, k);
    if (plan->given) {
        memcpy(s->temperature, plan->given + (k + 1) * width, width * sizeof(double));
        COILS_LOOP
        {
            s->slope[i] = s->rate[i] = (s->temperature[i] - before[i]) / s->dt;
            s->mean[i] = 0.5 * (before[i] + s->temperature[i]);
        }
    }
    s->felt = s->mean;
    s->t = s->t_begin + 0.5 * s->dt;
    HOOK_state(s);
    HOOK_shared(s);
    s->t = s->t_end;
    find_stiffness(s);
    find_length(s);
    HOOK_accept(s);
}
