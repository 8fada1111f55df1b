/* FMI 2.0: a variable is a number, its value reference is its place in the block of values. */
#include "fmi2Functions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "instance.h"

typedef struct {
    const fmi2CallbackFunctions *callbacks;
    char name[]; /* of the instance */
} Importer;

static void log_error(void *data, const char *message)
{
    const Importer *importer = data;
    if (importer->callbacks != NULL && importer->callbacks->logger != NULL) {
        /* The text is the format itself (it holds no `%`), because importers in other languages see no varargs. */
        importer->callbacks->logger(importer->callbacks->componentEnvironment, importer->name, fmi2Error,
                                    "logStatusError", message);
    }
}

static fmi2Status as_fmi2(Status status)
{
    return status == STATUS_OK ? fmi2OK : fmi2Error;
}

const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void)
{
    return fmi2Version;
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn, size_t nCategories,
                               const fmi2String categories[])
{
    (void)loggingOn; /* errors, the only messages, are always logged */
    for (size_t i = 0; i < nCategories; i++) {
        if (categories == NULL || strcmp(categories[i], "logStatusError") != 0) {
            return as_fmi2(instance_refuse(c, "fmi2SetDebugLogging: the only category is logStatusError"));
        }
    }
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID,
                              fmi2String fmuResourceLocation, const fmi2CallbackFunctions *functions,
                              fmi2Boolean visible, fmi2Boolean loggingOn)
{
    (void)fmuResourceLocation, (void)visible, (void)loggingOn;
    const size_t length = instanceName == NULL ? 0 : strlen(instanceName);
    Importer *importer = malloc(sizeof *importer + length + 1);
    if (importer == NULL) {
        return NULL;
    }
    importer->callbacks = functions;
    memcpy(importer->name, instanceName == NULL ? "" : instanceName, length + 1);
    return instance_create(2, fmuType == fmi2CoSimulation ? CO_SIMULATION : MODEL_EXCHANGE, fmuGUID, log_error,
                           importer);
}

void fmi2FreeInstance(fmi2Component c)
{
    instance_free(c);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance, fmi2Real startTime,
                               fmi2Boolean stopTimeDefined, fmi2Real stopTime)
{
    (void)toleranceDefined, (void)tolerance; /* the step is exact */
    return as_fmi2(instance_set_experiment(c, __func__, startTime, stopTimeDefined ? stopTime : INFINITY));
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    return as_fmi2(instance_enter_initialisation(c, __func__));
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    return as_fmi2(instance_exit_initialisation(c, __func__));
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    Instance *instance = c;
    if (instance_require(instance, __func__, MODES_RUNNING) != STATUS_OK) {
        return fmi2Error;
    }
    instance->mode = MODE_TERMINATED;
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c)
{
    return as_fmi2(instance_reset(c));
}

/* Find the variable and element of a value reference; refuse what is no variable of the type asked for. */
static Status locate(Instance *instance, const char *function, bool is_boolean, fmi2ValueReference reference,
                     size_t *index, size_t *element)
{
    const Model *model = &instance->model;
    size_t low = 0, high = VARIABLE_COUNT; /* the offsets rise */
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        if (model->offset[middle] <= reference) {
            low = middle;
        } else {
            high = middle;
        }
    }
    const Role role = model_variables[low].role;
    if (reference >= model->length || role == ROLE_HIDDEN || role == ROLE_STRUCTURE ||
        (role == ROLE_FLAG) != is_boolean) {
        return instance_refuse(instance, "%s: value reference %u is no variable of this type", function, reference);
    }
    *index = low;
    *element = reference - model->offset[low];
    return STATUS_OK;
}

/* How many references from `i` on are the elements of one variable in order; these are copied at once. */
static size_t run_length(const Instance *instance, const fmi2ValueReference references[], size_t i, size_t count,
                         size_t index, size_t element)
{
    const size_t left = variable_size(&model_variables[index], instance->model.coils) - element;
    size_t length = 1;
    while (length < left && i + length < count && references[i + length] == references[i] + length) {
        length++;
    }
    return length;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Real value[])
{
    for (size_t i = 0, index, element, length; i < nvr; i += length) {
        if (locate(c, __func__, false, vr[i], &index, &element) != STATUS_OK) {
            return fmi2Error;
        }
        length = run_length(c, vr, i, nvr, index, element);
        if (instance_get(c, index, element, length, value + i) != STATUS_OK) {
            return fmi2Error;
        }
    }
    return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Real value[])
{
    for (size_t i = 0, index, element, length; i < nvr; i += length) {
        if (locate(c, __func__, false, vr[i], &index, &element) != STATUS_OK) {
            return fmi2Error;
        }
        length = run_length(c, vr, i, nvr, index, element);
        if (instance_set(c, index, element, length, value + i) != STATUS_OK) {
            return fmi2Error;
        }
    }
    return fmi2OK;
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Boolean value[])
{
    for (size_t i = 0; i < nvr; i++) {
        size_t index, element;
        double number;
        if (locate(c, __func__, true, vr[i], &index, &element) != STATUS_OK ||
            instance_get(c, index, element, 1, &number) != STATUS_OK) {
            return fmi2Error;
        }
        value[i] = number != 0.0 ? fmi2True : fmi2False;
    }
    return fmi2OK;
}

fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Boolean value[])
{
    for (size_t i = 0; i < nvr; i++) {
        size_t index, element;
        const double number = value[i] ? 1.0 : 0.0;
        if (locate(c, __func__, true, vr[i], &index, &element) != STATUS_OK ||
            instance_set(c, index, element, 1, &number) != STATUS_OK) {
            return fmi2Error;
        }
    }
    return fmi2OK;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real currentCommunicationPoint, fmi2Real communicationStepSize,
                      fmi2Boolean noSetFMUStatePriorToCurrentPoint)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    return as_fmi2(instance_step(c, __func__, currentCommunicationPoint, communicationStepSize));
}
