/* Steps a system of FMUs over all its macro-steps, with laws that are added to derivatives, inputs and outputs.
 *
 * The order of what happens in a macro-step is that of the co-simulation (cosim/system.py, cosim/algorithms); a Model
 * Exchange FMU is integrated by the classical Runge-Kutta method with a fixed number of steps in each macro-step
 * (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, Springer 1993, section II.1). Inputs are held over a
 * macro-step. diagnosis/models/systems/layout.py declares the same structures for ctypes.
 */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef double (*Law)(const double *e, const double *p, const double *z, const double *d);
typedef int (*AccessFmi2)(void *, const uint32_t *, size_t, void *);
typedef int (*AccessFmi3)(void *, const uint32_t *, size_t, void *, size_t);
typedef int (*Plain)(void *);
typedef int (*SetTime)(void *, double);
typedef int (*Vector)(void *, double *, size_t);
typedef int (*CompletedFmi2)(void *, int, int *, int *);
typedef int (*CompletedFmi3)(void *, bool, bool *, bool *);
typedef int (*UpdateFmi2)(void *, void *);
typedef int (*UpdateFmi3)(void *, bool *, bool *, bool *, bool *, bool *, double *);
typedef int (*StepFmi2)(void *, double, double, int);
typedef int (*StepFmi3)(void *, double, double, bool, bool *, bool *, bool *, double *);

enum { WARNING = 1, MOST_SWEEPS = 100, MOST_EVENTS = 1000, MOST_OWN = 2, BISECTIONS = 50 };
enum { COPY, PUT, GET, STEP };
enum { RATE, INPUT, OUTPUT, SHARE, PARAMETER };
enum { DONE = 0, FAILED = 1 };

/* What is practically the same instant [s]: a tenth of the resolution of simulated time. */
static const double INSTANT = 1e-10;

/* cosim/fmu/moved_parameter.py says what these are. */
static const double REACH = 0.25, MOST_RATIO = 4.0, LEAST = 0.05;

typedef struct {
    void *call;
    const uint32_t *references;
    size_t reference_count;
    double *values;
    size_t count;
} Access;

typedef struct {
    double *to;
    const double *from;
    double factor, offset;
} Copy;

/* An input as it was some time ago; inputs are held over macro-steps, so that it jumps once in a macro-step at most. */
typedef struct {
    int64_t input;
    const double *by; /* delay [s] */
    double factor, offset; /* to SI base units */
    double *history;       /* the input in every macro-step, as it is set */
    double jump;           /* when it jumps in this macro-step [s] */
    double before, after;  /* its values then */
} Delay;

/* An instance of the FMU in which a parameter has another value. */
typedef struct {
    void *component;
    double *held;   /* inputs as it has them */
    double *values; /* derivatives or outputs there */
} Moved;

typedef struct {
    int64_t kind;   /* RATE, INPUT, OUTPUT, SHARE (of the FMU's own rate) or PARAMETER (a share of it) */
    int64_t target; /* number of the state or of the input */
    double scale;   /* from SI base units to those of the target */
    Law amount;
    const double *values; /* its parameters, SI base units */
    int64_t own;          /* states of its own */
    int64_t first;        /* number of the first of them in the unit's vector */
    Law rates[MOST_OWN], starts[MOST_OWN];
    double *output; /* the output, of the kind OUTPUT */
    int64_t delay_count;
    Delay *delays;
    double *delayed; /* what they are now, SI base units */
    Moved *moved;    /* of the kind PARAMETER: where it is smaller and larger by REACH of itself */
} Added;

typedef struct {
    void *component;
    int64_t is_fmi3, is_model_exchange, reports_steps, substeps;
    int64_t states, indicators, inputs, own;
    void *set_time, *set_states, *get_states, *get_derivatives, *get_indicators, *completed;
    void *enter_event_mode, *update, *enter_continuous_mode, *do_step;
    double *state; /* states of the FMU, then of the laws; and room for the same seven times over */
    double *signs; /* indicators before and now */
    double *outer, *inner, *held; /* inputs from outside (those for laws alone last), with what is added, as the FMU has them */
    const Access *writers;
    int64_t writer_count;
    const Access *readers;
    int64_t reader_count;
    double *environment;
    const Copy *known; /* what laws may use, to SI base units */
    int64_t known_count;
    double *seen; /* states at which the environment is evaluated */
    const Added *added;
    int64_t added_count;
    double next_event;
    int64_t has_inputs_added;
    const Copy *own_outputs; /* outputs as the FMU has them, to where laws see them */
    int64_t own_output_count;
    int64_t has_delays;
    int64_t step; /* number of the macro-step; -1 before the first */
    int64_t has_outputs_added;
    int64_t has_parameters_added;
} Unit;

typedef struct {
    int64_t code, first, last; /* COPY: copies [first, last); else the unit `first` */
} Operation;

typedef struct {
    double *to;
    const double *column; /* one value for every macro-step */
} Sampled;

typedef struct {
    Unit *units;
    int64_t unit_count;
    const Copy *copies;
    const Operation *settle;
    int64_t settle_count;
    const Operation *operations;
    int64_t operation_count;
    const Sampled *programmes;
    int64_t programme_count;
    const double *const *recorded;
    int64_t recorded_count;
    double *rows; /* (outputs + 1, recorded) */
    int64_t steps, per_output, start, size; /* times in ns */
} System;

static int access_of(const Unit *u, void *component, const Access *a)
{
    return u->is_fmi3 ? ((AccessFmi3)a->call)(component, a->references, a->reference_count, a->values, a->count)
                      : ((AccessFmi2)a->call)(component, a->references, a->reference_count, a->values);
}

static int access(const Unit *u, const Access *a)
{
    return access_of(u, u->component, a);
}

static void look_around(const Unit *u, double time)
{
    u->environment[0] = time;
    for (int64_t i = 0; i < u->known_count; ++i) {
        *u->known[i].to = u->known[i].factor * *u->known[i].from + u->known[i].offset;
    }
}

static bool take_delayed(const Added *a, int64_t i, double value)
{
    const double before = a->delayed[i];
    a->delayed[i] = a->delays[i].factor * value + a->delays[i].offset;
    return a->delayed[i] != before;
}

/* Where no time passes, a delayed input stays, unless it is late by nothing; before the first step it is the input. */
static void stay_delayed(const Unit *u)
{
    for (int64_t i = 0; u->has_delays && i < u->added_count; ++i) {
        const Added *a = u->added + i;
        for (int64_t k = 0; k < a->delay_count; ++k) {
            if (u->step < 0 || *a->delays[k].by <= INSTANT) {
                take_delayed(a, k, u->outer[a->delays[k].input]);
            }
        }
    }
}

static double held(const Delay *d, int64_t step)
{
    return d->history[step > 0 ? step : 0];
}

/* A macro-step begins: how its delayed inputs go through it. */
static void plan_delayed(const Unit *u, double begin, double length)
{
    for (int64_t i = 0; i < u->added_count; ++i) {
        const Added *a = u->added + i;
        for (int64_t k = 0; k < a->delay_count; ++k) {
            Delay *d = a->delays + k;
            /* Later than that is before the first step; a number that is none is late by nothing. */
            const double late = fmin(fmax(*d->by / length, 0.0), (double)u->step + 2.0);
            int64_t steps = (int64_t)late;
            double share = late - (double)steps;
            if (share * length < INSTANT) {
                share = 0.0;
            } else if ((1.0 - share) * length < INSTANT) {
                share = 0.0, ++steps;
            }
            d->history[u->step] = u->outer[d->input];
            d->after = held(d, u->step - steps);
            d->before = share > 0.0 ? held(d, u->step - steps - 1) : d->after;
            d->jump = begin + share * length;
        }
    }
}

/* Delayed inputs get their values from `time` on; whether one is another. */
static bool move_delayed(const Unit *u, double time)
{
    bool has_jumped = false;
    for (int64_t i = 0; u->has_delays && i < u->added_count; ++i) {
        const Added *a = u->added + i;
        for (int64_t k = 0; k < a->delay_count; ++k) {
            const Delay *d = a->delays + k;
            has_jumped |= take_delayed(a, k, time < d->jump - INSTANT ? d->before : d->after);
        }
    }
    return has_jumped;
}

/* A Co-Simulation FMU gets the mean of a delayed input over its step. */
static void average_delayed(const Unit *u, double begin, double length)
{
    for (int64_t i = 0; i < u->added_count; ++i) {
        const Added *a = u->added + i;
        for (int64_t k = 0; k < a->delay_count; ++k) {
            const Delay *d = a->delays + k;
            const double share = (d->jump - begin) / length;
            take_delayed(a, k, d->before == d->after ? d->after : share * d->before + (1.0 - share) * d->after);
        }
    }
}

/* When a delayed input jumps next. */
static double next_jump(const Unit *u, double time)
{
    double next = INFINITY;
    for (int64_t i = 0; u->has_delays && i < u->added_count; ++i) {
        for (int64_t k = 0; k < u->added[i].delay_count; ++k) {
            const Delay *d = u->added[i].delays + k;
            if (d->before != d->after && d->jump > time + INSTANT) {
                next = fmin(next, d->jump);
            }
        }
    }
    return next;
}

/* By how much equations change where a parameter changes by a share of itself: `change` of cosim/fmu/moved_parameter.py. */
static double change(double share, double below, double here, double above)
{
    const double fall = (here - below) / REACH, rise = (above - here) / REACH;
    const double bend = (fall - rise) / REACH, denominator = fall + rise + share * bend;
    if (!(share > -1.0)) {
        return NAN;
    }
    if (fall * rise > 0.0 && fmax(fabs(fall), fabs(rise)) <= MOST_RATIO * fmin(fabs(fall), fabs(rise))) {
        return denominator / (fall + rise) < LEAST ? NAN : 2.0 * rise * fall * share / denominator;
    }
    return 0.5 * share * (fall + rise - share * bend);
}

/* An instance with another parameter stands where the FMU does, with the same inputs. */
static int move_instance(const Unit *u, const Moved *m, double time, double *x)
{
    if (((SetTime)u->set_time)(m->component, time) > WARNING) {
        return FAILED;
    }
    if (u->states && ((Vector)u->set_states)(m->component, x, (size_t)u->states) > WARNING) {
        return FAILED;
    }
    if (!memcmp(u->inner, m->held, (size_t)u->inputs * sizeof(double))) {
        return DONE;
    }
    for (int64_t i = 0; i < u->writer_count; ++i) {
        if (access_of(u, m->component, u->writers + i) > WARNING) {
            return FAILED;
        }
    }
    memcpy(m->held, u->inner, (size_t)u->inputs * sizeof(double));
    return DONE;
}

/* What every instance gives, in `values`; then, in that of the first of each two, what their parameter changes. */
static void compare_instances(const Unit *u, const double *own, const double *here, int64_t first, int64_t count)
{
    for (int64_t i = 0; i < u->added_count; ++i) {
        const Added *a = u->added + i;
        if (a->kind == PARAMETER) {
            const double share = a->amount(u->environment, a->values, own + a->first, a->delayed);
            for (int64_t k = 0; k < count; ++k) {
                double *const below = a->moved[0].values + first + k;
                *below = change(share, *below, here[k], a->moved[1].values[first + k]);
            }
        }
    }
}

/* What the parameters change together. */
static void add_changes(const Unit *u, double *here, int64_t first, int64_t count)
{
    for (int64_t i = 0; i < u->added_count; ++i) {
        const Added *a = u->added + i;
        for (int64_t k = 0; a->kind == PARAMETER && k < count; ++k) {
            here[k] += a->moved[0].values[first + k];
        }
    }
}

/* What parameters that change do to derivatives, before anything else is added; the environment is that of the point. */
static int change_rates(const Unit *u, double time, double *x, double *rates)
{
    for (int64_t i = 0; i < u->added_count; ++i) {
        for (int64_t side = 0; u->added[i].kind == PARAMETER && side < 2; ++side) {
            const Moved *m = u->added[i].moved + side;
            if (move_instance(u, m, time, x) != DONE ||
                ((Vector)u->get_derivatives)(m->component, m->values, (size_t)u->states) > WARNING) {
                return FAILED;
            }
        }
    }
    compare_instances(u, x + u->states, rates, 0, u->states);
    add_changes(u, rates, 0, u->states);
    return DONE;
}

/* Outputs of every instance, in `values`; all of them are read into the places of the FMU's own. */
static int read_instances(const Unit *u, double time)
{
    for (int64_t i = 0; i < u->added_count; ++i) {
        for (int64_t side = 0; u->added[i].kind == PARAMETER && side < 2; ++side) {
            const Moved *m = u->added[i].moved + side;
            double *to = m->values;
            if (move_instance(u, m, time, u->state) != DONE) {
                return FAILED;
            }
            for (int64_t k = 0; k < u->reader_count; to += u->readers[k++].count) {
                if (access_of(u, m->component, u->readers + k) > WARNING) {
                    return FAILED;
                }
                memcpy(to, u->readers[k].values, u->readers[k].count * sizeof(double));
            }
        }
    }
    return DONE;
}

/* What parameters that change do to outputs that were just read. */
static void change_outputs(const Unit *u, double time)
{
    int64_t first = 0;
    if (u->states) {
        memcpy(u->seen, u->state, (size_t)u->states * sizeof(double));
    }
    look_around(u, time);
    for (int64_t k = 0; k < u->reader_count; first += (int64_t)u->readers[k++].count) {
        compare_instances(u, u->state + u->states, u->readers[k].values, first, (int64_t)u->readers[k].count);
        add_changes(u, u->readers[k].values, first, (int64_t)u->readers[k].count);
    }
}

/* Outputs as the FMU has them; laws see these. */
static int read_own_outputs(const Unit *u, double time)
{
    if (u->has_parameters_added && read_instances(u, time) != DONE) {
        return FAILED;
    }
    for (int64_t i = 0; i < u->reader_count; ++i) {
        if (access(u, u->readers + i) > WARNING) {
            return FAILED;
        }
    }
    if (u->has_parameters_added) {
        change_outputs(u, time);
    }
    for (int64_t i = 0; i < u->own_output_count; ++i) {
        *u->own_outputs[i].to = *u->own_outputs[i].from;
    }
    return DONE;
}

/* What laws add to outputs that were just read. */
static void add_to_outputs(const Unit *u, double time)
{
    if (!u->own_output_count && !u->has_outputs_added) {
        return;
    }
    if (u->states) { /* the last point of the integration is none that it has reached */
        memcpy(u->seen, u->state, (size_t)u->states * sizeof(double));
    }
    look_around(u, time);
    for (int64_t i = 0; i < u->added_count; ++i) {
        const Added *a = u->added + i;
        if (a->kind == OUTPUT) {
            *a->output += a->scale * a->amount(u->environment, a->values, u->state + u->states + a->first, a->delayed);
        }
    }
}

static int read_outputs(const Unit *u, double time)
{
    if (read_own_outputs(u, time) != DONE) {
        return FAILED;
    }
    add_to_outputs(u, time);
    return DONE;
}

/* Hand the inputs to the FMU, with what laws add to them; the environment is that of `time`. */
static int write_inputs(const Unit *u, const double *own)
{
    memcpy(u->inner, u->outer, (size_t)u->inputs * sizeof(double));
    for (int64_t i = 0; i < u->added_count; ++i) {
        const Added *a = u->added + i;
        if (a->kind == INPUT) {
            u->inner[a->target] += a->scale * a->amount(u->environment, a->values, own + a->first, a->delayed);
        }
    }
    if (!memcmp(u->inner, u->held, (size_t)u->inputs * sizeof(double))) {
        return DONE;
    }
    for (int64_t i = 0; i < u->writer_count; ++i) {
        if (access(u, u->writers + i) > WARNING) {
            return FAILED;
        }
    }
    memcpy(u->held, u->inner, (size_t)u->inputs * sizeof(double));
    return DONE;
}

/* The FMU stands at a point of the integration. */
static int move_to(Unit *u, double time, double *x)
{
    if (((SetTime)u->set_time)(u->component, time) > WARNING) {
        return FAILED;
    }
    if (u->states && ((Vector)u->set_states)(u->component, x, (size_t)u->states) > WARNING) {
        return FAILED;
    }
    if (u->added_count) {
        memcpy(u->seen, x, (size_t)u->states * sizeof(double));
        look_around(u, time);
        if (u->has_inputs_added) {
            return write_inputs(u, x + u->states);
        }
    }
    return DONE;
}

/* Derivatives of the FMU's states and of those of laws. */
static int derivatives(Unit *u, double time, double *x, double *rates)
{
    if (move_to(u, time, x) != DONE) {
        return FAILED;
    }
    if (u->states && ((Vector)u->get_derivatives)(u->component, rates, (size_t)u->states) > WARNING) {
        return FAILED;
    }
    if (u->has_parameters_added && change_rates(u, time, x, rates) != DONE) {
        return FAILED;
    }
    for (int64_t i = 0; i < u->added_count; ++i) { /* before anything is added to what the FMU has */
        const Added *a = u->added + i;
        if (a->kind == SHARE) {
            const double *own = x + u->states + a->first;
            rates[a->target] *= 1.0 + a->amount(u->environment, a->values, own, a->delayed);
        }
    }
    for (int64_t i = 0; i < u->added_count; ++i) {
        const Added *a = u->added + i;
        const double *own = x + u->states + a->first;
        if (a->kind == RATE) {
            rates[a->target] += a->scale * a->amount(u->environment, a->values, own, a->delayed);
        }
        for (int64_t k = 0; k < a->own; ++k) {
            rates[u->states + a->first + k] = a->rates[k](u->environment, a->values, own, a->delayed);
        }
    }
    return DONE;
}

static int runge_kutta(Unit *u, double time, double step, double *x)
{
    const int64_t n = u->states + u->own;
    double *const k1 = u->state + n, *const k2 = k1 + n, *const k3 = k2 + n, *const k4 = k3 + n, *const y = k4 + n;
    if (derivatives(u, time, x, k1) != DONE) {
        return FAILED;
    }
    for (int64_t i = 0; i < n; ++i) {
        y[i] = x[i] + 0.5 * step * k1[i];
    }
    if (derivatives(u, time + 0.5 * step, y, k2) != DONE) {
        return FAILED;
    }
    for (int64_t i = 0; i < n; ++i) {
        y[i] = x[i] + 0.5 * step * k2[i];
    }
    if (derivatives(u, time + 0.5 * step, y, k3) != DONE) {
        return FAILED;
    }
    for (int64_t i = 0; i < n; ++i) {
        y[i] = x[i] + step * k3[i];
    }
    if (derivatives(u, time + step, y, k4) != DONE) {
        return FAILED;
    }
    double sum = 0.0;
    for (int64_t i = 0; i < n; ++i) {
        x[i] += step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        sum += x[i];
    }
    return isfinite(sum) ? DONE : FAILED;
}

/* From Event Mode back to Continuous-Time Mode; the states may be new. */
static int leave_event_mode(Unit *u)
{
    bool again = true;
    for (int sweep = 0; again; ++sweep) {
        bool ends;
        if (sweep == MOST_SWEEPS) {
            return FAILED;
        }
        if (u->is_fmi3) {
            bool nominals, values, has_event;
            double event = 0.0;
            if (((UpdateFmi3)u->update)(u->component, &again, &ends, &nominals, &values, &has_event, &event) > WARNING) {
                return FAILED;
            }
            u->next_event = has_event ? event : INFINITY;
        } else {
            struct {
                int again, ends, nominals, values, has_event;
                double event;
            } info = {0};
            if (((UpdateFmi2)u->update)(u->component, &info) > WARNING) {
                return FAILED;
            }
            again = info.again, ends = info.ends;
            u->next_event = info.has_event ? info.event : INFINITY;
        }
        if (ends) {
            return FAILED;
        }
    }
    if (((Plain)u->enter_continuous_mode)(u->component) > WARNING) {
        return FAILED;
    }
    return u->states && ((Vector)u->get_states)(u->component, u->state, (size_t)u->states) > WARNING ? FAILED : DONE;
}

static int handle_event(Unit *u)
{
    if (u->has_parameters_added) { /* the other instances might have events at other times */
        return FAILED;
    }
    return ((Plain)u->enter_event_mode)(u->component) > WARNING ? FAILED : leave_event_mode(u);
}

static int look_at_signs(Unit *u, double time, double *x, double *signs)
{
    if (move_to(u, time, x) != DONE) {
        return FAILED;
    }
    return ((Vector)u->get_indicators)(u->component, signs, (size_t)u->indicators) > WARNING ? FAILED : DONE;
}

static bool has_crossed(const Unit *u, const double *before, const double *now)
{
    for (int64_t i = 0; i < u->indicators; ++i) {
        if ((before[i] > 0.0) != (now[i] > 0.0)) {
            return true;
        }
    }
    return false;
}

/* One step of the integration, cut at the first event in it; the time reached, or NaN. */
static double advance(Unit *u, double time, double end)
{
    const int64_t n = u->states + u->own;
    double *const x = u->state, *const begin = x + 6 * n, *const before = u->signs, *const now = before + u->indicators;
    if (!u->indicators) {
        return runge_kutta(u, time, end - time, x) == DONE ? end : NAN;
    }
    memcpy(begin, x, (size_t)n * sizeof(double));
    if (look_at_signs(u, time, x, before) != DONE || runge_kutta(u, time, end - time, x) != DONE ||
        look_at_signs(u, end, x, now) != DONE) {
        return NAN;
    }
    if (!has_crossed(u, before, now)) {
        return end;
    }
    double low = time, high = end;
    for (int i = 0; i < BISECTIONS && high - low > 1e-12 * fmax(1.0, fabs(end)); ++i) {
        const double middle = 0.5 * (low + high);
        memcpy(x, begin, (size_t)n * sizeof(double));
        if (runge_kutta(u, time, middle - time, x) != DONE || look_at_signs(u, middle, x, now) != DONE) {
            return NAN;
        }
        if (has_crossed(u, before, now)) {
            high = middle;
        } else {
            low = middle;
        }
    }
    memcpy(x, begin, (size_t)n * sizeof(double));
    if (runge_kutta(u, time, high - time, x) != DONE || move_to(u, high, x) != DONE || handle_event(u) != DONE) {
        return NAN;
    }
    return high;
}

static int complete(const Unit *u, void *component, bool *wants_event, bool *ends)
{
    int event = 0, end = 0;
    if (u->is_fmi3) {
        return ((CompletedFmi3)u->completed)(component, true, wants_event, ends) > WARNING ? FAILED : DONE;
    }
    if (((CompletedFmi2)u->completed)(component, 1, &event, &end) > WARNING) {
        return FAILED;
    }
    *wants_event = event, *ends = end;
    return DONE;
}

static int report_step(Unit *u, double time)
{
    bool wants_event, ends;
    for (int64_t i = 0; u->has_parameters_added && i < u->added_count; ++i) {
        for (int64_t side = 0; u->added[i].kind == PARAMETER && side < 2; ++side) {
            const Moved *m = u->added[i].moved + side;
            if (move_instance(u, m, time, u->state) != DONE || complete(u, m->component, &wants_event, &ends) != DONE) {
                return FAILED;
            }
        }
    }
    if (complete(u, u->component, &wants_event, &ends) != DONE) {
        return FAILED;
    }
    return ends ? FAILED : wants_event ? handle_event(u) : DONE;
}

/* Inputs at an instant, to which the FMU has been moved; one that jumps is an event. */
static int hand_over(Unit *u, double time)
{
    if (u->added_count) {
        memcpy(u->seen, u->state, (size_t)u->states * sizeof(double));
        look_around(u, time);
    }
    const bool is_event = u->is_model_exchange && (u->indicators > 0 || isfinite(u->next_event));
    if (is_event && ((Plain)u->enter_event_mode)(u->component) > WARNING) {
        return FAILED;
    }
    if (write_inputs(u, u->state + u->states) != DONE) {
        return FAILED;
    }
    return is_event ? leave_event_mode(u) : DONE;
}

static int integrate(Unit *u, double begin, double end, double length)
{
    const double step = (end - begin) / (double)u->substeps, instant = INSTANT;
    double time = begin;
    int events = 0;
    if (u->has_parameters_added && isfinite(u->next_event)) {
        return FAILED;
    }
    if (u->has_delays) {
        plan_delayed(u, begin, length);
        if (move_delayed(u, begin) && hand_over(u, begin) != DONE) {
            return FAILED;
        }
    }
    for (int64_t i = 1; i <= u->substeps; ++i) {
        const double stop = i == u->substeps ? end : begin + (double)i * step;
        while (time < stop - instant) {
            double aim = stop;
            if (u->next_event <= time + instant) {
                if (++events > MOST_EVENTS || move_to(u, time, u->state) != DONE || handle_event(u) != DONE) {
                    return FAILED;
                }
                continue;
            }
            if (u->next_event < stop) {
                aim = u->next_event;
            }
            const double due = next_jump(u, time);
            aim = fmin(aim, due);
            const double reached = advance(u, time, aim);
            if (!isfinite(reached) || (reached < aim && ++events > MOST_EVENTS)) {
                return FAILED;
            }
            time = reached;
            if (time >= due - instant && time < end - instant) {
                if (move_to(u, time, u->state) != DONE) {
                    return FAILED;
                }
                move_delayed(u, time);
                if (hand_over(u, time) != DONE) {
                    return FAILED;
                }
            }
            if (u->reports_steps && (move_to(u, time, u->state) != DONE || report_step(u, time) != DONE)) {
                return FAILED;
            }
        }
    }
    return move_to(u, end, u->state);
}

/* States of laws beside a Co-Simulation FMU: its inputs and outputs are held. */
static int step_beside(Unit *u, double begin, double end)
{
    const int64_t n = u->own;
    double *const x = u->state, *const k = x + n, *const y = k + 4 * n;
    const double step = end - begin, share[4] = {0.0, 0.5, 0.5, 1.0};
    if (!n) {
        return DONE;
    }
    for (int stage = 0; stage < 4; ++stage) {
        for (int64_t i = 0; i < n; ++i) {
            y[i] = x[i] + (stage ? share[stage] * step * k[(stage - 1) * n + i] : 0.0);
        }
        for (int64_t i = 0; i < u->added_count; ++i) {
            const Added *a = u->added + i;
            for (int64_t j = 0; j < a->own; ++j) {
                k[stage * n + a->first + j] = a->rates[j](u->environment, a->values, y + a->first, a->delayed);
            }
        }
    }
    double sum = 0.0;
    for (int64_t i = 0; i < n; ++i) {
        x[i] += step / 6.0 * (k[i] + 2.0 * (k[n + i] + k[2 * n + i]) + k[3 * n + i]);
        sum += x[i];
    }
    return isfinite(sum) ? DONE : FAILED;
}

static int do_step(Unit *u, double begin, double end, double length)
{
    int status;
    if (u->has_delays) {
        plan_delayed(u, begin, length);
        average_delayed(u, begin, length);
    }
    if (u->added_count) {
        look_around(u, begin);
    }
    if (write_inputs(u, u->state) != DONE || step_beside(u, begin, end) != DONE) {
        return FAILED;
    }
    if (u->is_fmi3) {
        bool event = false, ends = false, early = false;
        double reached = end;
        status = ((StepFmi3)u->do_step)(u->component, begin, length, true, &event, &ends, &early, &reached);
        if (event || ends || early) {
            return FAILED;
        }
    } else {
        status = ((StepFmi2)u->do_step)(u->component, begin, length, 1);
    }
    return status > WARNING ? FAILED : DONE;
}

/* Inputs at an instant; one that jumps is an event. */
static int put(Unit *u, double time)
{
    if (!memcmp(u->outer, u->inner, (size_t)u->inputs * sizeof(double)) && !u->has_inputs_added) {
        return DONE;
    }
    stay_delayed(u);
    return hand_over(u, time);
}

static int carry_out(const System *s, const Operation *operations, int64_t count, double begin, double end, double length,
                     double now)
{
    for (int64_t i = 0; i < count; ++i) {
        const Operation *o = operations + i;
        if (o->code == COPY) {
            for (int64_t c = o->first; c < o->last; ++c) {
                *s->copies[c].to = s->copies[c].factor * *s->copies[c].from + s->copies[c].offset;
            }
            continue;
        }
        Unit *u = s->units + o->first;
        int status = DONE;
        if (o->code == PUT) {
            status = put(u, now);
        } else if (o->code == GET) {
            status = read_outputs(u, now);
        } else {
            status = u->is_model_exchange ? integrate(u, begin, end, length) : do_step(u, begin, end, length);
            status = status == DONE ? read_outputs(u, end) : status;
        }
        if (status != DONE) {
            return FAILED;
        }
    }
    return DONE;
}

static void record(const System *s, int64_t row)
{
    double *const to = s->rows + row * s->recorded_count;
    for (int64_t i = 0; i < s->recorded_count; ++i) {
        to[i] = *s->recorded[i];
    }
}

/* States of laws at the start, and outputs with what laws add to them there. */
static int begin_laws(Unit *u, double time)
{
    if (!u->added_count) {
        return DONE;
    }
    if ((u->own_output_count || u->has_outputs_added) && read_own_outputs(u, time) != DONE) {
        return FAILED;
    }
    if (u->states) {
        memcpy(u->seen, u->state, (size_t)u->states * sizeof(double));
    }
    look_around(u, time);
    u->step = -1;
    stay_delayed(u);
    for (int64_t i = 0; i < u->added_count; ++i) {
        const Added *a = u->added + i;
        double *own = u->state + u->states + a->first;
        for (int64_t k = 0; k < a->own; ++k) {
            own[k] = a->starts[k](u->environment, a->values, own, a->delayed);
        }
    }
    add_to_outputs(u, time);
    return DONE;
}

/* All macro-steps; the number of those that were completed. */
__attribute__((visibility("default"))) int64_t system_run(System *s)
{
    const double start = (double)s->start / 1e9, length = (double)s->size / 1e9;
    for (int64_t i = 0; i < s->unit_count; ++i) {
        Unit *u = s->units + i;
        memcpy(u->inner, u->outer, (size_t)u->inputs * sizeof(double));
        memcpy(u->held, u->outer, (size_t)u->inputs * sizeof(double));
        if (begin_laws(u, start) != DONE) {
            return 0;
        }
    }
    if (carry_out(s, s->settle, s->settle_count, start, start, length, start) != DONE) {
        return 0;
    }
    record(s, 0);
    for (int64_t step = 0; step < s->steps; ++step) {
        const double begin = (double)(s->start + step * s->size) / 1e9, end = (double)(s->start + (step + 1) * s->size) / 1e9;
        for (int64_t i = 0; i < s->programme_count; ++i) {
            *s->programmes[i].to = s->programmes[i].column[step];
        }
        for (int64_t i = 0; i < s->unit_count; ++i) {
            s->units[i].step = step;
        }
        if (carry_out(s, s->operations, s->operation_count, begin, end, length, begin) != DONE) {
            return step;
        }
        if ((step + 1) % s->per_output == 0) {
            if (carry_out(s, s->settle, s->settle_count, end, end, length, end) != DONE) {
                return step;
            }
            record(s, (step + 1) / s->per_output);
        }
    }
    return s->steps;
}

/* Derivatives of one unit's states at any point, for questions about its equations. */
__attribute__((visibility("default"))) int system_rates(Unit *u, double time, double *x, double *rates)
{
    const int64_t count = u->added_count;
    u->added_count = 0;
    const int status = derivatives(u, time, x, rates);
    u->added_count = count;
    return status;
}
