/* The paper's comparison without a heating model: stiffness follows the power at once, and so does the heat. */
#include "model.h"

bool model_start(Model *model, char *message, size_t size)
{
    (void)message;
    (void)size;
    for (size_t i = 0; i < model->coils; i++) {
        ARRAY(convected_energy)[i] = 0.0;
    }
    return true;
}

void model_outputs(Model *model)
{
    for (size_t i = 0; i < model->coils; i++) {
        const bool is_powered = ARRAY(power)[i] > NUMBER(off_power);
        ARRAY(temperature)[i] = NUMBER(ambient_temperature);
        ARRAY(stiffness)[i] = is_powered ? NUMBER(maximum_stiffness) : NUMBER(minimum_stiffness);
        ARRAY(rest_length)[i] = NUMBER(coil_rest_length);
        ARRAY(resistance)[i] = ARRAY(reference_resistance)[i];
        ARRAY(stored_energy)[i] = 0.0;
    }
}

void model_derivatives(Model *model)
{
    for (size_t i = 0; i < model->coils; i++) {
        ARRAY(der_convected_energy)[i] = ARRAY(power)[i];
    }
}

void model_step(Model *model, double step)
{
    for (size_t i = 0; i < model->coils; i++) {
        ARRAY(convected_energy)[i] += ARRAY(power)[i] * step;
    }
}

void model_accept(Model *model)
{
    (void)model; /* nothing remembers the past */
}
