/* my_actuator: its equations. ARRAY(x)[i] is variable x of coil i, NUMBER(x) a scalar; names as in config.h. */
#include <math.h>
#include <stdio.h>

#include "model.h"

/* First values of the states and of HIDDEN variables, from the parameters. False, with a message: they contradict. */
bool model_start(Model *model, char *message, size_t size)
{
    if (NUMBER(stiff_temperature) <= NUMBER(soft_temperature)) {
        snprintf(message, size, "stiff_temperature must lie above soft_temperature");
        return false;
    }
    for (size_t i = 0; i < model->coils; i++) {
        ARRAY(temperature)[i] = NUMBER(initial_temperature);
        ARRAY(convected_energy)[i] = 0.0;
    }
    return true;
}

/* Outputs from states, inputs and parameters. */
void model_outputs(Model *model)
{
    const double span = NUMBER(stiff_temperature) - NUMBER(soft_temperature);
    for (size_t i = 0; i < model->coils; i++) {
        const double share = fmin(fmax((ARRAY(temperature)[i] - NUMBER(soft_temperature)) / span, 0.0), 1.0);
        ARRAY(stiffness)[i] = NUMBER(soft_stiffness) + share * (NUMBER(stiff_stiffness) - NUMBER(soft_stiffness));
        ARRAY(rest_length)[i] = NUMBER(coil_rest_length);
        ARRAY(resistance)[i] = ARRAY(reference_resistance)[i];
        ARRAY(stored_energy)[i] = NUMBER(heat_capacity) * (ARRAY(temperature)[i] - NUMBER(initial_temperature));
    }
}

/* Derivatives of the states, for Model Exchange: C dT/dt = P - G (T - T_a). */
void model_derivatives(Model *model)
{
    for (size_t i = 0; i < model->coils; i++) {
        const double outflow = NUMBER(conductance) * (ARRAY(temperature)[i] - NUMBER(ambient_temperature));
        ARRAY(der_temperature)[i] = (ARRAY(power)[i] - outflow) / NUMBER(heat_capacity);
        ARRAY(der_convected_energy)[i] = outflow;
    }
}

/* Co-Simulation: advance the states by `step` [s] with the inputs constant; here exactly. */
void model_step(Model *model, double step)
{
    for (size_t i = 0; i < model->coils; i++) {
        const double before = ARRAY(temperature)[i];
        const double final = NUMBER(ambient_temperature) + ARRAY(power)[i] / NUMBER(conductance);
        ARRAY(temperature)[i] = final + (before - final) * exp(-NUMBER(conductance) / NUMBER(heat_capacity) * step);
        ARRAY(convected_energy)[i] +=
            ARRAY(power)[i] * step - NUMBER(heat_capacity) * (ARRAY(temperature)[i] - before);
    }
    model_accept(model);
}

/* The states are those of an accepted step: update HIDDEN variables that remember the past (hysteresis). */
void model_accept(Model *model)
{
    (void)model;
}
