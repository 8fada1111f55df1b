/* Laws of a controller and its supervisor; the same as cosim/control/laws.py and cosim/control/supervisor.py, for one
 * string. See docs/control.md. */
#include <math.h>
#include <stdio.h>

#include "model.h"

enum { NO_ALARM, LIMITED, OUT_OF_RANGE, FROZEN, NO_RESPONSE };
enum { MEAN, LARGEST, SMALLEST };
enum { ON_OFF, PI };

#define WAITING_ARRAY ARRAY(waiting_0_0)

/* Samples that a delay lasts. */
static int waiting_count(const Model *model)
{
    return (int)ceil(NUMBER(delay) / NUMBER(sample) - 1e-9);
}

static double power_of(const Model *model, double command)
{
    return NUMBER(drive_squared) != 0.0 ? command * command : command;
}

bool model_start(Model *model, char *message, size_t size)
{
    if (!(NUMBER(lowest) < NUMBER(highest))) {
        snprintf(message, size, "lowest = %g V is not below highest = %g V", NUMBER(lowest), NUMBER(highest));
        return false;
    }
    if (NUMBER(use_hold) != 0.0 && !(NUMBER(reheat_below) < NUMBER(hold_at))) {
        snprintf(message, size, "reheat_below = %g K is not below hold_at = %g K", NUMBER(reheat_below),
                 NUMBER(hold_at));
        return false;
    }
    if ((NUMBER(law) != ON_OFF && NUMBER(law) != PI) || fmod(NUMBER(combine), 1.0) != 0.0 ||
        NUMBER(combine) > SMALLEST) {
        snprintf(message, size, "law = %g, combine = %g: law is 0 or 1, combine is 0, 1 or 2", NUMBER(law),
                 NUMBER(combine));
        return false;
    }
    if (NUMBER(slowest_rise) > NUMBER(fastest_rise)) {
        snprintf(message, size, "slowest_rise = %g K/s is above fastest_rise = %g K/s", NUMBER(slowest_rise),
                 NUMBER(fastest_rise));
        return false;
    }
    if (NUMBER(delay) / NUMBER(sample) > HISTORY) {
        snprintf(message, size, "delay = %g s lasts more than %d samples of %g s", NUMBER(delay), HISTORY,
                 NUMBER(sample));
        return false;
    }
    NUMBER(begin) = NUMBER(time);
    NUMBER(held_command) = NUMBER(lowest);
    NUMBER(held_demand) = NUMBER(held_alarm) = 0.0;
    NUMBER(on) = NUMBER(integral) = NUMBER(holding) = NUMBER(lagging) = 0.0;
    NUMBER(coldest) = NUMBER(lowest_ambient);
    for (size_t i = 0; i < model->coils; i++) {
        ARRAY(last)[i] = NAN;
        ARRAY(unchanged)[i] = ARRAY(failed)[i] = 0.0;
    }
    for (int i = 0; i < HISTORY; i++) {
        WAITING_ARRAY[i] = 0.0;
    }
    for (int i = 0; i <= HISTORY; i++) {
        ARRAY(seen)[i] = NUMBER(lowest_ambient);
    }
    return true;
}

/* One value of all readings. */
static double combined(const Model *model)
{
    double result = ARRAY(measured)[0];
    for (size_t i = 1; i < model->coils; i++) {
        const double reading = ARRAY(measured)[i];
        result = NUMBER(combine) == MEAN      ? result + reading
                 : NUMBER(combine) == LARGEST ? fmax(result, reading)
                                              : fmin(result, reading);
    }
    return NUMBER(combine) == MEAN ? result / (double)model->coils : result;
}

/* Full drive below the band, none above it, and what was there within it. */
static double on_off(Model *model, double error, double low, double high)
{
    if (fabs(error) > 0.5 * NUMBER(band)) {
        NUMBER(on) = error > 0.0;
    }
    return NUMBER(on) != 0.0 ? high : low;
}

/* u = f (r - a) + K e + I, I' = K e / T_i by forward Euler; I stands still while u is at a limit and e would drive it
 * further (Astrom and Hagglund, Advanced PID Control, ISA 2006, section 3.5). */
static double proportional_integral(Model *model, double setpoint, double error, double low, double high)
{
    const double wanted =
        NUMBER(feedforward) * (setpoint - NUMBER(ambient)) + NUMBER(gain) * error + NUMBER(integral);
    const bool winds_up = (wanted >= high && error > 0.0) || (wanted <= low && error < 0.0);
    if (!winds_up) {
        NUMBER(integral) += NUMBER(gain) * error * NUMBER(sample) / NUMBER(integral_time);
    }
    return wanted;
}

static double demand_of(Model *model, double low, double high)
{
    const double reading = combined(model);
    double setpoint = NUMBER(setpoint);
    if (NUMBER(use_hold) != 0.0) {
        const bool has_reached = NUMBER(holding) != 0.0 ? reading >= NUMBER(reheat_below) : reading >= setpoint;
        NUMBER(holding) = has_reached && setpoint > NUMBER(hold_at);
        setpoint = NUMBER(holding) != 0.0 ? NUMBER(hold_at) : setpoint;
    }
    const double error = setpoint - reading;
    return NUMBER(law) == ON_OFF ? on_off(model, error, low, high)
                                 : proportional_integral(model, setpoint, error, low, high);
}

/* Thermometers that fail by now; a failure stays. The worst of them. */
static double check(Model *model)
{
    double worst = NO_ALARM;
    for (size_t i = 0; i < model->coils; i++) {
        const double reading = ARRAY(measured)[i];
        double *failed = &ARRAY(failed)[i], *unchanged = &ARRAY(unchanged)[i];
        *unchanged = reading == ARRAY(last)[i] ? *unchanged + NUMBER(sample) : 0.0;
        ARRAY(last)[i] = reading;
        if (*failed == NO_ALARM && NUMBER(slowest_rise) > 0.0 && reading < NUMBER(seen) - NUMBER(tolerance)) {
            *failed = NO_RESPONSE;
        }
        if (*failed == NO_ALARM && NUMBER(frozen_after) > 0.0 && *unchanged >= NUMBER(frozen_after) - 1e-9) {
            *failed = FROZEN;
        }
        if (*failed == NO_ALARM && !(reading > NUMBER(lowest_reading) && reading < NUMBER(highest_reading))) {
            *failed = OUT_OF_RANGE;
        }
        worst = fmax(worst, *failed);
    }
    return worst;
}

/* Share of full heat, 0 to 1, that keeps every coil below the limit until the next sample. */
static double allowed(const Model *model)
{
    double hidden = NUMBER(lagging), hottest = -INFINITY;
    for (int i = 0; i < waiting_count(model); i++) {
        hidden += WAITING_ARRAY[i];
    }
    for (size_t i = 0; i < model->coils; i++) {
        hottest = fmax(hottest, ARRAY(measured)[i]);
    }
    const double room = NUMBER(limit) - (hottest + NUMBER(margin) + hidden);
    return fmin(fmax(room / (NUMBER(fastest_rise) * NUMBER(sample)), 0.0), 1.0);
}

/* Exact step of C T' = P - G (T - ambient) of the slowest coil. */
static void cool(Model *model, double share, double decay, int waiting)
{
    const double before = NUMBER(coldest);
    const double end = NUMBER(lowest_ambient) + NUMBER(slowest_rise) * share * NUMBER(cooling_time);
    NUMBER(coldest) = end + (before - end) * exp(-NUMBER(sample) / NUMBER(cooling_time));
    /* The lower end of the step, so that what is seen stays below what a right thermometer reads. */
    const double shown = NUMBER(lag) > 0.0 ? fmin(before, NUMBER(coldest)) : NUMBER(coldest);
    double *seen = ARRAY(seen);
    const double next = decay * seen[waiting] + (1.0 - decay) * shown;
    for (int i = 0; i < waiting; i++) {
        seen[i] = seen[i + 1];
    }
    seen[waiting] = next;
}

/* A share of full heat is given until the next sample. */
static void heated(Model *model, double share)
{
    const double rise = NUMBER(fastest_rise) * share * NUMBER(sample);
    const double decay = NUMBER(lag) > 0.0 ? exp(-NUMBER(sample) / NUMBER(lag)) : 0.0;
    const int waiting = waiting_count(model);
    double entering = rise; /* what leaves the delay has still to come through the lag */
    if (waiting > 0) {
        entering = WAITING_ARRAY[0];
        for (int i = 0; i + 1 < waiting; i++) {
            WAITING_ARRAY[i] = WAITING_ARRAY[i + 1];
        }
        WAITING_ARRAY[waiting - 1] = rise;
    }
    NUMBER(lagging) = NUMBER(lag) > 0.0 ? NUMBER(lagging) * decay + entering : 0.0;
    if (NUMBER(slowest_rise) > 0.0) {
        cool(model, share, decay, waiting);
    }
}

static void act(Model *model)
{
    const double low = power_of(model, NUMBER(lowest)), high = power_of(model, NUMBER(highest));
    NUMBER(held_demand) = demand_of(model, low, high);
    double given = fmin(fmax(NUMBER(held_demand), low), high);
    NUMBER(held_alarm) = NO_ALARM;
    if (NUMBER(use_supervisor) != 0.0) {
        const double worst = check(model);
        const double most = worst != NO_ALARM ? low : fmax(low, allowed(model) * high);
        NUMBER(held_alarm) = worst != NO_ALARM ? worst : given > most ? LIMITED : NO_ALARM;
        given = fmin(given, most);
        heated(model, given / high);
    }
    NUMBER(held_command) = NUMBER(drive_squared) != 0.0 ? sqrt(given) : given;
}

void model_outputs(Model *model)
{
    NUMBER(command) = NUMBER(held_command);
    NUMBER(demand) = NUMBER(held_demand);
    NUMBER(alarm) = NUMBER(held_alarm);
}

void model_derivatives(Model *model)
{
    (void)model; /* no continuous state */
}

/* Samples are due at whole multiples of `sample` since the start; time in whole nanoseconds, so that none is missed. */
void model_step(Model *model, double step)
{
    (void)step;
    const long long since = llround((NUMBER(time) - NUMBER(begin)) * 1e9);
    if (since % llround(NUMBER(sample) * 1e9) == 0) {
        act(model);
    }
}

void model_accept(Model *model)
{
    (void)model;
}
