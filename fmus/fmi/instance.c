#include "instance.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MESSAGE_SIZE 512

/* Two times are the same if they differ by less than this part of their size (or of one second) [1]. */
#define TIME_TOLERANCE 1e-9

static const struct {
    Mode mode;
    const char *name;
} mode_names[] = {
    {MODE_INSTANTIATED, "Instantiated"},     {MODE_CONFIGURATION, "Configuration Mode"},
    {MODE_INITIALISATION, "Initialization Mode"}, {MODE_EVENT, "Event Mode"},
    {MODE_CONTINUOUS, "Continuous-Time Mode"},    {MODE_STEP, "Step Mode"},
    {MODE_TERMINATED, "Terminated"},         {MODE_FAILED, "Failed (a step failed: reset, or restore a saved state)"},
};

static const char *mode_name(Mode mode)
{
    for (size_t i = 0; i < sizeof mode_names / sizeof *mode_names; i++) {
        if (mode_names[i].mode == mode) {
            return mode_names[i].name;
        }
    }
    return "unknown";
}

Status instance_refuse(Instance *instance, const char *format, ...)
{
    char message[MESSAGE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    instance->log(instance->importer, message);
    return STATUS_ERROR;
}

Status instance_require(Instance *instance, const char *function, int modes)
{
    if (instance->mode & modes) {
        return STATUS_OK;
    }
    return instance_refuse(instance, "%s must not be called in the state %s", function, mode_name(instance->mode));
}

/* Name of an element as FMI 2.0 has it: `power[3]` is the third. */
static const char *element_name(const Variable *variable, size_t element, char *text, size_t size)
{
    if (variable->extent == SCALAR) {
        return variable->name;
    }
    snprintf(text, size, "%s[%zu]", variable->name, element + 1);
    return text;
}

/* Refuse values that are not finite or break the limit of the table. */
static Status check_values(Instance *instance, const Variable *variable, size_t first, size_t count,
                           const double *values)
{
    for (size_t i = 0; i < count; i++) {
        const bool is_finite = isfinite(values[i]) != 0;
        const bool is_allowed = variable->limit == ANY || values[i] > 0.0 ||
                                (variable->limit == NON_NEGATIVE && values[i] == 0.0);
        if (!is_finite || !is_allowed) {
            char text[96];
            const char *reason = !is_finite                          ? "a finite number"
                                 : variable->limit == NON_NEGATIVE   ? "zero or positive"
                                                                     : "positive";
            const bool has_unit = strcmp(variable->unit, "1") != 0;
            return instance_refuse(instance, "%s = %g%s%s: it must be %s",
                                   element_name(variable, first + i, text, sizeof text), values[i],
                                   has_unit ? " " : "", has_unit ? variable->unit : "", reason);
        }
    }
    return STATUS_OK;
}

static bool lay_out(Model *model, size_t coils)
{
    size_t length = 0;
    for (size_t i = 0; i < VARIABLE_COUNT; i++) {
        model->offset[i] = length;
        length += variable_size(&model_variables[i], coils);
    }
    double *values = realloc(model->values, length * sizeof *values);
    if (values == NULL) {
        return false;
    }
    model->values = values;
    model->length = length;
    model->coils = coils;
    for (size_t i = 0; i < VARIABLE_COUNT; i++) {
        const size_t count = variable_size(&model_variables[i], coils);
        for (size_t j = 0; j < count; j++) {
            values[model->offset[i] + j] = model_variables[i].start;
        }
    }
    values[model->offset[VAR_coils]] = (double)coils;
    return true;
}

Instance *instance_create(int fmi_version, Interface interface, const char *token, LogFunction log, void *importer)
{
    char expected[TOKEN_SIZE];
    instantiation_token(fmi_version, expected);
    if (token == NULL || strcmp(token, expected) != 0) {
        char message[MESSAGE_SIZE];
        snprintf(message, sizeof message, "the description is another model's: its token is %.200s, the binary's is %s",
                 token == NULL ? "missing" : token, expected);
        log(importer, message);
        free(importer);
        return NULL;
    }
#ifdef MODEL_CO_SIMULATION_ONLY
    if (interface != CO_SIMULATION) {
        log(importer, "this model is made for Co-Simulation alone");
        free(importer);
        return NULL;
    }
#endif
    Instance *instance = calloc(1, sizeof *instance);
    if (instance == NULL || !lay_out(&instance->model, COILS)) {
        log(importer, "out of memory");
        free(instance);
        free(importer);
        return NULL;
    }
    instance->interface = interface;
    instance->mode = MODE_INSTANTIATED;
    instance->stop_time = INFINITY;
    instance->fmi_version = fmi_version;
    instance->log = log;
    instance->importer = importer;
    return instance;
}

void instance_free(Instance *instance)
{
    if (instance != NULL) {
        free(instance->model.values);
        free(instance->importer);
        free(instance);
    }
}

Status instance_resize(Instance *instance, double coils)
{
    if (!(coils >= MINIMUM_COILS && coils <= MAXIMUM_COILS)) {
        return instance_refuse(instance, "coils = %.0f: it must be from %d to %d", coils, MINIMUM_COILS, MAXIMUM_COILS);
    }
    return lay_out(&instance->model, (size_t)coils) ? STATUS_OK : instance_refuse(instance, "out of memory");
}

Status instance_reset(Instance *instance)
{
    instance->mode = MODE_INSTANTIATED;
    instance->stop_time = INFINITY;
    instance->is_stale = false;
    return instance_resize(instance, COILS);
}

/* Check all values of the variables of a role. */
static Status check_role(Instance *instance, Role role)
{
    for (size_t i = 0; i < VARIABLE_COUNT; i++) {
        if (model_variables[i].role == role) {
            const size_t count = variable_size(&model_variables[i], instance->model.coils);
            const double *values = instance->model.values + instance->model.offset[i];
            if (check_values(instance, &model_variables[i], 0, count, values) != STATUS_OK) {
                return STATUS_ERROR;
            }
        }
    }
    return STATUS_OK;
}

static Status update_outputs(Instance *instance)
{
    if (!instance->is_stale) {
        return STATUS_OK;
    }
    if (instance->mode == MODE_INITIALISATION) {
        char message[MESSAGE_SIZE] = "";
        if (!model_start(&instance->model, message, sizeof message)) {
            return instance_refuse(instance, "%s", message);
        }
    }
    model_outputs(&instance->model);
    model_derivatives(&instance->model);
    if (check_role(instance, ROLE_STATE) != STATUS_OK || check_role(instance, ROLE_OUTPUT) != STATUS_OK) {
        return STATUS_ERROR;
    }
    instance->is_stale = false;
    return STATUS_OK;
}

Status instance_get(Instance *instance, size_t index, size_t first, size_t count, double *values)
{
    const Variable *variable = &model_variables[index];
    const bool is_computed =
        variable->role == ROLE_STATE || variable->role == ROLE_OUTPUT || variable->role == ROLE_DERIVATIVE;
    if (is_computed && (!(instance->mode & MODES_READABLE) || update_outputs(instance) != STATUS_OK)) {
        return instance_refuse(instance, "%s has no value in the state %s", variable->name, mode_name(instance->mode));
    }
    memcpy(values, instance->model.values + instance->model.offset[index] + first, count * sizeof *values);
    return STATUS_OK;
}

static int modes_to_set(Role role)
{
    switch (role) {
    case ROLE_INPUT: return MODE_INSTANTIATED | MODE_INITIALISATION | MODES_RUNNING;
    case ROLE_PARAMETER:
    case ROLE_FLAG: return MODE_INSTANTIATED | MODE_INITIALISATION;
    case ROLE_STRUCTURE: return MODE_CONFIGURATION;
    default: return 0;
    }
}

Status instance_set(Instance *instance, size_t index, size_t first, size_t count, const double *values)
{
    const Variable *variable = &model_variables[index];
    if (!(instance->mode & modes_to_set(variable->role))) {
        return instance_refuse(instance, "%s must not be set in the state %s", variable->name,
                               mode_name(instance->mode));
    }
    if (check_values(instance, variable, first, count, values) != STATUS_OK) {
        return STATUS_ERROR;
    }
    if (variable->role == ROLE_STRUCTURE) {
        return instance_resize(instance, values[0]);
    }
    memcpy(instance->model.values + instance->model.offset[index] + first, values, count * sizeof *values);
    instance->is_stale = true;
    return STATUS_OK;
}

Status instance_set_experiment(Instance *instance, const char *function, double start_time, double stop_time)
{
    if (instance_require(instance, function, MODE_INSTANTIATED) != STATUS_OK) {
        return STATUS_ERROR;
    }
    if (!isfinite(start_time) || !(stop_time >= start_time)) {
        return instance_refuse(instance, "%s: start time %g s and stop time %g s", function, start_time, stop_time);
    }
    instance->model.values[instance->model.offset[VAR_time]] = start_time;
    instance->stop_time = stop_time;
    return STATUS_OK;
}

Status instance_enter_initialisation(Instance *instance, const char *function)
{
    if (instance_require(instance, function, MODE_INSTANTIATED) != STATUS_OK) {
        return STATUS_ERROR;
    }
    instance->mode = MODE_INITIALISATION;
    instance->is_stale = true;
    return STATUS_OK;
}

Status instance_exit_initialisation(Instance *instance, const char *function)
{
    if (instance_require(instance, function, MODE_INITIALISATION) != STATUS_OK ||
        update_outputs(instance) != STATUS_OK) {
        return STATUS_ERROR;
    }
    instance->mode = instance->interface == CO_SIMULATION ? MODE_STEP : MODE_EVENT;
    return STATUS_OK;
}

Status instance_step(Instance *instance, const char *function, double time, double step)
{
    if (instance_require(instance, function, MODE_STEP) != STATUS_OK) {
        return STATUS_ERROR;
    }
    double *now = &instance->model.values[instance->model.offset[VAR_time]];
    const double tolerance = TIME_TOLERANCE * fmax(1.0, fabs(*now));
    if (!(fabs(time - *now) <= tolerance)) {
        return instance_refuse(instance, "%s: the step begins at %.12g s but the last one ended at %.12g s", function,
                               time, *now);
    }
    if (!(step > 0.0) || !isfinite(step)) {
        return instance_refuse(instance, "%s: the step size %g s is not positive", function, step);
    }
    if (time + step > instance->stop_time + tolerance) {
        return instance_refuse(instance, "%s: the step ends at %.12g s, after the stop time %.12g s", function,
                               time + step, instance->stop_time);
    }
    model_step(&instance->model, step);
    *now = time + step;
    instance->is_stale = true;
    if (update_outputs(instance) != STATUS_OK) {
        instance->mode = MODE_FAILED;
        return instance_refuse(instance, "%s: the step from %.12g s by %g s failed", function, time, step);
    }
    return STATUS_OK;
}
