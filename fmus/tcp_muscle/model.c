/* Bundles of twisted-and-coiled polymer muscles. Equations, sources and choices: README.md. */
#include <math.h>

#include "model.h"

/* Heat capacity of a bundle [J/K]. */
static double capacity(const Model *model)
{
    return NUMBER(muscles) * NUMBER(muscle_heat_capacity);
}

/* Heat flow per kelvin from bundle i to the surroundings [W/K]. */
static double conductance(const Model *model, size_t i)
{
    return NUMBER(muscles) * ARRAY(muscle_conductance)[i];
}

bool model_start(Model *model, char *message, size_t size)
{
    (void)message;
    (void)size;
    for (size_t i = 0; i < model->coils; i++) {
        ARRAY(temperature)[i] = ARRAY(initial_temperature)[i];
        ARRAY(convected_energy)[i] = 0.0;
    }
    return true;
}

void model_outputs(Model *model)
{
    for (size_t i = 0; i < model->coils; i++) {
        const double temperature = ARRAY(temperature)[i];
        const double contraction =
            NUMBER(contraction_coefficient) * (temperature - NUMBER(reference_temperature));
        ARRAY(stiffness)[i] = NUMBER(muscles) * NUMBER(muscle_stiffness);
        ARRAY(rest_length)[i] = NUMBER(coil_rest_length) * (1.0 - fmin(contraction, NUMBER(contraction_limit)));
        ARRAY(resistance)[i] = ARRAY(reference_resistance)[i];
        ARRAY(stored_energy)[i] = capacity(model) * (temperature - ARRAY(initial_temperature)[i]);
    }
}

void model_derivatives(Model *model)
{
    for (size_t i = 0; i < model->coils; i++) {
        const double outflow = conductance(model, i) * (ARRAY(temperature)[i] - NUMBER(ambient_temperature));
        ARRAY(der_temperature)[i] = (ARRAY(power)[i] - outflow) / capacity(model);
        ARRAY(der_convected_energy)[i] = outflow;
    }
}

/* With constant inputs C dT/dt = P - G (T - Ta) has the exact solution below, for G = 0 too; the heat that left is
 * what came in and was not stored. */
void model_step(Model *model, double step)
{
    for (size_t i = 0; i < model->coils; i++) {
        const double heat_capacity = capacity(model), flow_per_kelvin = conductance(model, i);
        const double exponent = flow_per_kelvin / heat_capacity * step;
        const double relaxation = exponent > 0.0 ? -expm1(-exponent) / exponent : 1.0;
        const double net = ARRAY(power)[i] - flow_per_kelvin * (ARRAY(temperature)[i] - NUMBER(ambient_temperature));
        const double change = net / heat_capacity * relaxation * step;
        ARRAY(temperature)[i] += change;
        ARRAY(convected_energy)[i] += ARRAY(power)[i] * step - heat_capacity * change;
    }
}

void model_accept(Model *model)
{
    (void)model; /* nothing remembers the past */
}
