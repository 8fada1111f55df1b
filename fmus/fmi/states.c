/* What Model Exchange needs of an instance: continuous states, derivatives, accepted steps. */
#include <math.h>
#include <string.h>

#include "instance.h"

size_t instance_state_count(const Instance *instance)
{
    size_t count = 0;
    for (size_t i = 0; i < VARIABLE_COUNT; i++) {
        count += model_variables[i].role == ROLE_STATE ? variable_size(&model_variables[i], instance->model.coils) : 0;
    }
    return count;
}

static Status check_call(Instance *instance, const char *function, int modes, size_t count)
{
    if (instance->interface != MODEL_EXCHANGE) {
        return instance_refuse(instance, "%s must not be called for Co-Simulation", function);
    }
    if (instance_require(instance, function, modes) != STATUS_OK) {
        return STATUS_ERROR;
    }
    const size_t expected = instance_state_count(instance);
    if (count != expected) {
        return instance_refuse(instance, "%s: %zu values for %zu continuous states", function, count, expected);
    }
    return STATUS_OK;
}

/* Gather the variables of a role, which lie apart in the block, into one array. */
static Status gather(Instance *instance, Role role, double *values)
{
    for (size_t i = 0; i < VARIABLE_COUNT; i++) {
        if (model_variables[i].role == role) {
            const size_t count = variable_size(&model_variables[i], instance->model.coils);
            if (instance_get(instance, i, 0, count, values) != STATUS_OK) {
                return STATUS_ERROR;
            }
            values += count;
        }
    }
    return STATUS_OK;
}

Status instance_get_states(Instance *instance, const char *function, double *states, size_t count)
{
    if (check_call(instance, function, MODES_READABLE, count) != STATUS_OK) {
        return STATUS_ERROR;
    }
    return gather(instance, ROLE_STATE, states);
}

Status instance_get_derivatives(Instance *instance, const char *function, double *derivatives, size_t count)
{
    if (check_call(instance, function, MODES_READABLE, count) != STATUS_OK) {
        return STATUS_ERROR;
    }
    if (instance->mode == MODE_INITIALISATION) {
        return gather(instance, ROLE_DERIVATIVE, derivatives);
    }
    /* An integrator asks for these far more often than for outputs, so the outputs are left alone. */
    model_derivatives(&instance->model);
    for (size_t i = 0; i < VARIABLE_COUNT; i++) {
        if (model_variables[i].role == ROLE_DERIVATIVE) {
            const size_t size = variable_size(&model_variables[i], instance->model.coils);
            memcpy(derivatives, instance->model.values + instance->model.offset[i], size * sizeof *derivatives);
            derivatives += size;
        }
    }
    return STATUS_OK;
}

Status instance_set_states(Instance *instance, const char *function, const double *states, size_t count)
{
    if (check_call(instance, function, MODE_CONTINUOUS, count) != STATUS_OK) {
        return STATUS_ERROR;
    }
    const double *value = states;
    for (size_t i = 0; i < VARIABLE_COUNT; i++) {
        if (model_variables[i].role == ROLE_STATE) {
            const size_t size = variable_size(&model_variables[i], instance->model.coils);
            for (size_t j = 0; j < size; j++) {
                if (!isfinite(value[j])) {
                    return instance_refuse(instance, "%s: %s[%zu] = %g is not a finite number", function,
                                           model_variables[i].name, j + 1, value[j]);
                }
            }
            value += size;
        }
    }
    for (size_t i = 0; i < VARIABLE_COUNT; i++) {
        if (model_variables[i].role == ROLE_STATE) {
            const size_t size = variable_size(&model_variables[i], instance->model.coils);
            memcpy(instance->model.values + instance->model.offset[i], states, size * sizeof *states);
            states += size;
        }
    }
    instance->is_stale = true;
    return STATUS_OK;
}

Status instance_get_nominals(Instance *instance, const char *function, double *nominals, size_t count)
{
    if (check_call(instance, function, MODES_ALL & ~(MODE_INSTANTIATED | MODE_FAILED), count) != STATUS_OK) {
        return STATUS_ERROR;
    }
    for (size_t i = 0; i < VARIABLE_COUNT; i++) {
        if (model_variables[i].role == ROLE_STATE) {
            for (size_t j = variable_size(&model_variables[i], instance->model.coils); j > 0; j--) {
                *nominals++ = model_variables[i].nominal;
            }
        }
    }
    return STATUS_OK;
}

Status instance_set_time(Instance *instance, const char *function, double time)
{
    if (check_call(instance, function, MODE_EVENT | MODE_CONTINUOUS, instance_state_count(instance)) != STATUS_OK) {
        return STATUS_ERROR;
    }
    if (!isfinite(time)) {
        return instance_refuse(instance, "%s: time = %g is not a finite number", function, time);
    }
    instance->model.values[instance->model.offset[VAR_time]] = time;
    return STATUS_OK;
}

Status instance_accept(Instance *instance, const char *function, int modes, Mode next)
{
    if (check_call(instance, function, modes, instance_state_count(instance)) != STATUS_OK) {
        return STATUS_ERROR;
    }
    model_accept(&instance->model);
    instance->is_stale = true;
    instance->mode = next;
    return STATUS_OK;
}
