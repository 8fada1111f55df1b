/* NiTi coils with phase kinetics. Equations, sources and choices: README.md.
 *
 * The stored heat H is the state. Temperature and austenite fraction follow from it together:
 *     H = C (T - T0) + m L (z(T - shift) - z0),
 * whose right side rises strictly with T, so that there is one solution whatever the history is.
 */
#include <math.h>
#include <stdio.h>

#include "model.h"

#define PI 3.14159265358979323846
#define SOLVER_ITERATIONS 200
#define SOLVER_TOLERANCE 1e-13  /* of the temperature [1]: two units in the last place */
#define STEP_TOLERANCE 1e-12    /* local error of the stored heat [J]; 3e-11 K */
#define SHORTEST_SUBSTEP 1e-9   /* of the step [1] */

/* Rise from 0 at `start` to 1 at `finish` along a cosine (Liang and Rogers 1990), and its slope [1/K]. */
static double rise(double temperature, double start, double finish, double *slope)
{
    *slope = 0.0;
    if (temperature <= start) {
        return 0.0;
    }
    if (temperature >= finish) {
        return 1.0;
    }
    const double rate = PI / (finish - start), angle = rate * (temperature - start);
    *slope = 0.5 * rate * sin(angle);
    return 0.5 - 0.5 * cos(angle);
}

/* Austenite on the outermost loop, temperature rising. `reduced`: temperature less its shift by stress [K]. */
static double heating_branch(const Model *model, double reduced, double *slope)
{
    return rise(reduced, NUMBER(austenite_start), NUMBER(austenite_finish), slope);
}

/* The same, temperature falling. */
static double cooling_branch(const Model *model, double reduced, double *slope)
{
    return rise(reduced, NUMBER(martensite_finish), NUMBER(martensite_start), slope);
}

/* Austenite fraction of coil i at a reduced temperature, on the way from the last accepted one, and its slope [1/K].
 * Heating scales the martensite left, cooling the austenite left, by what the branch of the outermost loop does over
 * the same way: the cosine law restarted so that it is continuous at any turning point. */
static double austenite(const Model *model, size_t i, double reduced, double *slope)
{
    const double before = ARRAY(memory_temperature)[i], fraction = ARRAY(memory_fraction)[i];
    double low_slope, high_slope, unused;
    const double low = heating_branch(model, reduced, &low_slope), high = cooling_branch(model, reduced, &high_slope);
    double result = fraction;
    *slope = 0.0;
    if (reduced > before) {
        const double left = 1.0 - heating_branch(model, before, &unused);
        if (left > 0.0) {
            const double scale = (1.0 - fraction) / left;
            result = 1.0 - scale * (1.0 - low);
            *slope = scale * low_slope;
        }
    } else {
        const double left = cooling_branch(model, before, &unused);
        if (left > 0.0) {
            const double scale = fraction / left;
            result = scale * high;
            *slope = scale * high_slope;
        }
    }
    if (result < low) { /* never outside the outermost loop */
        *slope = low_slope;
        return low;
    }
    if (result > high) {
        *slope = high_slope;
        return high;
    }
    return result;
}

/* Shift of the transformation temperatures of coil i [K]: shear stress over slope. The stress of a closely wound
 * spring, 8 F D / (pi d^3) at the surface (Wahl 1963), is 2/3 of that in the mean over the section. */
static double stress_shift(const Model *model, size_t i)
{
    const double wire = NUMBER(wire_diameter);
    const double surface = 8.0 * fmax(ARRAY(tension)[i], 0.0) * NUMBER(coil_diameter) / (PI * wire * wire * wire);
    return 2.0 / 3.0 * surface / NUMBER(clausius_clapeyron_slope);
}

static double mass(const Model *model, size_t i)
{
    return NUMBER(density) * ARRAY(volume)[i];
}

/* Temperature [K] of coil i at which it stores `heat` [J]: Newton's method, or bisection where that leaves the bracket or
 * does not halve its step (it may run in circles between the ends of the transformation). Not a number: no solution. */
static double solve_temperature(const Model *model, size_t i, double heat)
{
    const double capacity = mass(model, i) * NUMBER(specific_heat), latent = mass(model, i) * NUMBER(latent_heat);
    const double shift = stress_shift(model, i), start = ARRAY(initial_fraction)[i];
    double low = ARRAY(initial_temperature)[i] + (heat - latent * (1.0 - start)) / capacity;
    double high = ARRAY(initial_temperature)[i] + (heat + latent * start) / capacity;
    double temperature = fmin(fmax(ARRAY(memory_temperature)[i] + shift, low), high), last = high - low;
    for (int k = 0; k < SOLVER_ITERATIONS; k++) {
        double slope;
        const double fraction = austenite(model, i, temperature - shift, &slope);
        const double excess =
            capacity * (temperature - ARRAY(initial_temperature)[i]) + latent * (fraction - start) - heat;
        if (excess > 0.0) {
            high = temperature;
        } else {
            low = temperature;
        }
        double change = -excess / (capacity + latent * slope);
        const double tolerance = SOLVER_TOLERANCE * fabs(temperature);
        const bool is_outside = !(temperature + change >= low && temperature + change <= high);
        if (fabs(change) > tolerance && (is_outside || fabs(change) > 0.5 * last)) {
            change = 0.5 * (low + high) - temperature;
        }
        temperature += change;
        if (fabs(change) <= tolerance) {
            return temperature;
        }
        last = fabs(change);
    }
    return NAN;
}

/* Heat flow to the surroundings [W] while coil i stores `heat` [J]. */
static double outflow(const Model *model, size_t i, double heat)
{
    return ARRAY(heat_transfer_coefficient)[i] * NUMBER(area) *
           (solve_temperature(model, i, heat) - NUMBER(ambient_temperature));
}

bool model_start(Model *model, char *message, size_t size)
{
    const bool is_ordered = NUMBER(martensite_finish) < NUMBER(martensite_start) &&
                            NUMBER(austenite_start) < NUMBER(austenite_finish) &&
                            NUMBER(martensite_finish) <= NUMBER(austenite_start) &&
                            NUMBER(martensite_start) <= NUMBER(austenite_finish);
    if (!is_ordered) {
        snprintf(message, size, "the cooling branch must lie below the heating branch in temperature: martensite_finish "
                                "< martensite_start <= austenite_finish and martensite_finish <= austenite_start < "
                                "austenite_finish");
        return false;
    }
    for (size_t i = 0; i < model->coils; i++) {
        const double position = ARRAY(initial_loop_position)[i];
        if (position > 1.0) {
            snprintf(message, size, "initial_loop_position[%zu] = %g: it must lie between 0 (heating branch) and 1 "
                                    "(cooling branch)", i + 1, position);
            return false;
        }
        double unused;
        ARRAY(stored_energy)[i] = ARRAY(convected_energy)[i] = 0.0;
        const double reduced = ARRAY(initial_temperature)[i] - stress_shift(model, i);
        ARRAY(memory_temperature)[i] = reduced;
        const double low = heating_branch(model, reduced, &unused), high = cooling_branch(model, reduced, &unused);
        ARRAY(memory_fraction)[i] = ARRAY(initial_fraction)[i] = low + position * (high - low);
    }
    return true;
}

/* Length without load [m]: what the kept strain unwinds the coil by (Wahl 1963: deflection = pi D^2 n gamma / d), no
 * shorter than turns that touch and no longer than the wire. */
static double free_length(const Model *model, double martensite)
{
    const double around = PI * NUMBER(coil_diameter) * NUMBER(turns);
    const double unwound =
        around * NUMBER(coil_diameter) / NUMBER(wire_diameter) * NUMBER(transformation_strain) * martensite;
    return fmin(fmax(NUMBER(coil_rest_length) + unwound, NUMBER(turns) * NUMBER(wire_diameter)), around);
}

void model_outputs(Model *model)
{
    const double wire = NUMBER(wire_diameter), coil = NUMBER(coil_diameter);
    const double shape = wire * wire * wire * wire / (8.0 * coil * coil * coil * NUMBER(turns));
    const double soft = NUMBER(martensite_shear_modulus), stiff = NUMBER(austenite_shear_modulus);
    const double ratio = NUMBER(austenite_resistivity) / NUMBER(martensite_resistivity);
    for (size_t i = 0; i < model->coils; i++) {
        double unused;
        const double temperature = solve_temperature(model, i, ARRAY(stored_energy)[i]);
        const double fraction = austenite(model, i, temperature - stress_shift(model, i), &unused);
        ARRAY(temperature)[i] = temperature;
        ARRAY(martensite_fraction)[i] = 1.0 - fraction;
        ARRAY(stiffness)[i] = shape * (soft + (stiff - soft) * fraction);
        ARRAY(rest_length)[i] = free_length(model, 1.0 - fraction);
        ARRAY(resistance)[i] = ARRAY(reference_resistance)[i] * (1.0 + (ratio - 1.0) * fraction);
        ARRAY(latent_energy)[i] = mass(model, i) * NUMBER(latent_heat) * (fraction - ARRAY(initial_fraction)[i]);
    }
}

void model_derivatives(Model *model)
{
    for (size_t i = 0; i < model->coils; i++) {
        const double out = outflow(model, i, ARRAY(stored_energy)[i]);
        ARRAY(der_stored_energy)[i] = ARRAY(power)[i] - out;
        ARRAY(der_convected_energy)[i] = out;
    }
}

/* Weights of the method of Dormand and Prince (1980), order 5 with an error estimate of order 4. */
enum { STAGES = 7 };
static const double weights[STAGES - 1][STAGES - 1] = {
    {1.0 / 5.0},
    {3.0 / 40.0, 9.0 / 40.0},
    {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0},
    {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0},
    {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0},
    {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0},
};
static const double error_weights[STAGES] = {
    71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0};

/* Heat [J] stored `step` [s] later than `heat`, and the error of that. The first and last rates are kept in `rates`. */
static double advance_heat(const Model *model, size_t i, double heat, double step, double *rates, double *error)
{
    double result = heat;
    for (int stage = 1; stage < STAGES; stage++) {
        double sum = 0.0;
        for (int k = 0; k < stage; k++) {
            sum += weights[stage - 1][k] * rates[k];
        }
        result = heat + step * sum;
        rates[stage] = ARRAY(power)[i] - outflow(model, i, result);
    }
    double sum = 0.0;
    for (int k = 0; k < STAGES; k++) {
        sum += error_weights[k] * rates[k];
    }
    *error = fabs(step * sum);
    return result;
}

/* Heat stored by coil i a whole step [s] later, in sub-steps as the error demands; not a number if they get too short.
 * Inputs are constant, so the temperature moves one way and the memory need not follow before the end. */
static double integrate_heat(const Model *model, size_t i, double step)
{
    double heat = ARRAY(stored_energy)[i], done = 0.0, substep = step, rates[STAGES];
    rates[0] = ARRAY(power)[i] - outflow(model, i, heat);
    while (done < step) {
        double error;
        const bool is_last = substep >= step - done;
        const double size = is_last ? step - done : substep;
        const double next = advance_heat(model, i, heat, size, rates, &error);
        if (error <= STEP_TOLERANCE) {
            heat = next;
            rates[0] = rates[STAGES - 1];
            done = is_last ? step : done + size;
        } else if (!(size > SHORTEST_SUBSTEP * step)) {
            return NAN;
        }
        substep = size * fmin(fmax(0.9 * pow(STEP_TOLERANCE / fmax(error, 1e-300), 0.2), 0.2), 5.0);
        if (!isfinite(error)) {
            return NAN;
        }
    }
    return heat;
}

/* What came in and was not stored has left: the balance of energy holds to rounding, whatever the error of H is. */
void model_step(Model *model, double step)
{
    model_accept(model); /* a new tension has moved the coil already; from there on it goes one way */
    for (size_t i = 0; i < model->coils; i++) {
        const double heat = integrate_heat(model, i, step);
        ARRAY(convected_energy)[i] += ARRAY(power)[i] * step - (heat - ARRAY(stored_energy)[i]);
        ARRAY(stored_energy)[i] = heat;
    }
    model_accept(model);
}

void model_accept(Model *model)
{
    for (size_t i = 0; i < model->coils; i++) {
        double unused;
        const double reduced = solve_temperature(model, i, ARRAY(stored_energy)[i]) - stress_shift(model, i);
        ARRAY(memory_fraction)[i] = austenite(model, i, reduced, &unused);
        ARRAY(memory_temperature)[i] = reduced;
    }
}
