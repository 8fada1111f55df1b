/* Temperature and stiffness of independent NiTi coils; see docs/decisions/0001 and 0002. */
#include <math.h>
#include <stdio.h>

#include "model.h"

#define CELSIUS 273.15  /* [K]; equation (2) was fitted in degrees Celsius */
#define ABSOLUTE_ZERO (-CELSIUS)
#define SCAN_POINTS 8192

/* Equation (2): k = a exp(-b exp(-c T)) + d. The parameters a, b, c, d lie one after the other in the table. */
static double gompertz(const double *abcd, double celsius)
{
    return abcd[0] * exp(-abcd[1] * exp(-abcd[2] * celsius)) + abcd[3];
}

/* Height of the cooling branch above the heating branch [N/m]. */
static double gap(const Model *model, double celsius)
{
    return gompertz(ARRAY(cooling_a), celsius) - gompertz(ARRAY(heating_a), celsius);
}

/* Temperature [degC] above which exp(-b exp(-c T)) is 1 to double precision. */
static double saturation(const double *abcd)
{
    return (log(abcd[1]) + 40.0) / abcd[2];
}

/* The highest temperature [degC] at which the cooling branch passes below the heating branch; infinite if it stays
 * above it, not a number if it is below everywhere. */
static double find_crossing(const Model *model)
{
    double high = fmax(saturation(ARRAY(heating_a)), saturation(ARRAY(cooling_a)));
    if (gap(model, high) >= 0.0) {
        return INFINITY;
    }
    const double width = (high - ABSOLUTE_ZERO) / SCAN_POINTS;
    double low = high;
    for (int i = 0; gap(model, low) < 0.0; i++) {
        if (i == SCAN_POINTS) {
            return NAN;
        }
        high = low;
        low = high - width;
    }
    for (double middle = 0.5 * (low + high); middle > low && middle < high; middle = 0.5 * (low + high)) {
        if (gap(model, middle) < 0.0) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return high;
}

/* Play operator: the remembered stiffness, moved only as far as the branches at this temperature demand. From the
 * crossing on, the two bounds are one: the heating branch. */
static double play(const Model *model, double remembered, double kelvin)
{
    const double celsius = kelvin - CELSIUS;
    const double heating = gompertz(ARRAY(heating_a), celsius);
    if (celsius >= NUMBER(crossing)) {
        return heating;
    }
    const double cooling = gompertz(ARRAY(cooling_a), celsius);
    return fmin(fmax(remembered, fmin(heating, cooling)), fmax(heating, cooling));
}

/* Heat capacity of coil i [J/K]: rho V c_p. */
static double capacity(const Model *model, size_t i)
{
    return NUMBER(density) * ARRAY(volume)[i] * NUMBER(specific_heat);
}

/* Heat flow per kelvin to the surroundings [W/K]: hA, or alpha C of equation (5) once the power is cut. */
static double conductance(const Model *model, size_t i)
{
    if (NUMBER(use_regressed_cooling_rate) != 0.0 && ARRAY(power)[i] <= NUMBER(off_power)) {
        return NUMBER(cooling_rate) * capacity(model, i);
    }
    return ARRAY(heat_transfer_coefficient)[i] * NUMBER(area);
}

bool model_start(Model *model, char *message, size_t size)
{
    NUMBER(crossing) = find_crossing(model);
    if (isnan(NUMBER(crossing))) {
        snprintf(message, size, "the cooling branch (cooling_a to cooling_d) lies below the heating branch (heating_a "
                                "to heating_d) at every temperature: exchange them");
        return false;
    }
    for (size_t i = 0; i < model->coils; i++) {
        const double initial = ARRAY(initial_temperature)[i], position = ARRAY(initial_loop_position)[i];
        if (position > 1.0) {
            snprintf(message, size, "initial_loop_position[%zu] = %g: it must lie between 0 (heating branch) and 1 "
                                    "(cooling branch)", i + 1, position);
            return false;
        }
        ARRAY(temperature)[i] = initial;
        ARRAY(convected_energy)[i] = 0.0;
        const double heating = gompertz(ARRAY(heating_a), initial - CELSIUS);
        const double cooling = gompertz(ARRAY(cooling_a), initial - CELSIUS);
        ARRAY(memory)[i] = heating + position * (cooling - heating);
    }
    return true;
}

void model_outputs(Model *model)
{
    for (size_t i = 0; i < model->coils; i++) {
        const double temperature = ARRAY(temperature)[i];
        ARRAY(stiffness)[i] = play(model, ARRAY(memory)[i], temperature);
        ARRAY(rest_length)[i] = NUMBER(coil_rest_length);
        ARRAY(resistance)[i] =
            ARRAY(reference_resistance)[i] *
            (1.0 + NUMBER(resistance_temperature_coefficient) * (temperature - NUMBER(reference_temperature)));
        ARRAY(stored_energy)[i] = capacity(model, i) * (temperature - ARRAY(initial_temperature)[i]);
    }
}

void model_derivatives(Model *model)
{
    for (size_t i = 0; i < model->coils; i++) {
        const double outflow = conductance(model, i) * (ARRAY(temperature)[i] - NUMBER(ambient_temperature));
        ARRAY(der_temperature)[i] = (ARRAY(power)[i] - outflow) / capacity(model, i);
        ARRAY(der_convected_energy)[i] = outflow;
    }
}

/* With constant inputs C dT/dt = P - G (T - Ta) has the exact solution below, for G = 0 too; the heat that left is
 * what came in and was not stored. T moves one way within the step, so the play operator sees its end only. */
void model_step(Model *model, double step)
{
    for (size_t i = 0; i < model->coils; i++) {
        const double heat_capacity = capacity(model, i), flow_per_kelvin = conductance(model, i);
        const double exponent = flow_per_kelvin / heat_capacity * step;
        const double relaxation = exponent > 0.0 ? -expm1(-exponent) / exponent : 1.0;
        const double net = ARRAY(power)[i] - flow_per_kelvin * (ARRAY(temperature)[i] - NUMBER(ambient_temperature));
        const double change = net / heat_capacity * relaxation * step;
        ARRAY(temperature)[i] += change;
        ARRAY(convected_energy)[i] += ARRAY(power)[i] * step - heat_capacity * change;
    }
    model_accept(model);
}

void model_accept(Model *model)
{
    for (size_t i = 0; i < model->coils; i++) {
        ARRAY(memory)[i] = play(model, ARRAY(memory)[i], ARRAY(temperature)[i]);
    }
}
