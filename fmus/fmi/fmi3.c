/* FMI 3.0: a variable is an array, its value reference is its place in the table. */
#include "fmi3Functions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "instance.h"

typedef struct {
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log_message;
} Importer;

static void log_error(void *data, const char *message)
{
    const Importer *importer = data;
    if (importer->log_message != NULL) {
        importer->log_message(importer->environment, fmi3Error, "logStatusError", message);
    }
}

static fmi3Status as_fmi3(Status status)
{
    return status == STATUS_OK ? fmi3OK : fmi3Error;
}

static fmi3Instance create(Interface interface, fmi3String token, fmi3InstanceEnvironment environment,
                           fmi3LogMessageCallback log_message)
{
    Importer *importer = malloc(sizeof *importer);
    if (importer == NULL) {
        return NULL;
    }
    importer->environment = environment;
    importer->log_message = log_message;
    return instance_create(3, interface, token, log_error, importer);
}

const char *fmi3GetVersion(void)
{
    return fmi3Version;
}

fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean loggingOn, size_t nCategories,
                               const fmi3String categories[])
{
    (void)loggingOn; /* errors, the only messages, are always logged */
    for (size_t i = 0; i < nCategories; i++) {
        if (categories == NULL || strcmp(categories[i], "logStatusError") != 0) {
            return as_fmi3(instance_refuse(instance, "fmi3SetDebugLogging: the only category is logStatusError"));
        }
    }
    return fmi3OK;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String instanceName, fmi3String instantiationToken,
                                          fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                          fmi3InstanceEnvironment instanceEnvironment,
                                          fmi3LogMessageCallback logMessage)
{
    (void)instanceName, (void)resourcePath, (void)visible, (void)loggingOn;
    return create(MODEL_EXCHANGE, instantiationToken, instanceEnvironment, logMessage);
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String instanceName, fmi3String instantiationToken,
                                         fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                         fmi3Boolean eventModeUsed, fmi3Boolean earlyReturnAllowed,
                                         const fmi3ValueReference requiredIntermediateVariables[],
                                         size_t nRequiredIntermediateVariables,
                                         fmi3InstanceEnvironment instanceEnvironment,
                                         fmi3LogMessageCallback logMessage,
                                         fmi3IntermediateUpdateCallback intermediateUpdate)
{
    (void)instanceName, (void)resourcePath, (void)visible, (void)loggingOn, (void)earlyReturnAllowed;
    (void)requiredIntermediateVariables, (void)intermediateUpdate;
    if (eventModeUsed || nRequiredIntermediateVariables > 0) {
        if (logMessage != NULL) {
            logMessage(instanceEnvironment, fmi3Error, "logStatusError",
                       "Event Mode and intermediate variables are not supported in Co-Simulation");
        }
        return NULL;
    }
    return create(CO_SIMULATION, instantiationToken, instanceEnvironment, logMessage);
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String instanceName, fmi3String instantiationToken,
                                               fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn,
                                               fmi3InstanceEnvironment instanceEnvironment,
                                               fmi3LogMessageCallback logMessage, fmi3ClockUpdateCallback clockUpdate,
                                               fmi3LockPreemptionCallback lockPreemption,
                                               fmi3UnlockPreemptionCallback unlockPreemption)
{
    (void)instanceName, (void)instantiationToken, (void)resourcePath, (void)visible, (void)loggingOn;
    (void)clockUpdate, (void)lockPreemption, (void)unlockPreemption;
    if (logMessage != NULL) {
        logMessage(instanceEnvironment, fmi3Error, "logStatusError", "Scheduled Execution is not supported");
    }
    return NULL;
}

void fmi3FreeInstance(fmi3Instance instance)
{
    instance_free(instance);
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean toleranceDefined, fmi3Float64 tolerance,
                                       fmi3Float64 startTime, fmi3Boolean stopTimeDefined, fmi3Float64 stopTime)
{
    (void)toleranceDefined, (void)tolerance; /* the step is exact */
    if (instance_set_experiment(instance, __func__, startTime, stopTimeDefined ? stopTime : INFINITY) != STATUS_OK) {
        return fmi3Error;
    }
    return as_fmi3(instance_enter_initialisation(instance, __func__));
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance)
{
    return as_fmi3(instance_exit_initialisation(instance, __func__));
}

/* Move from one of `modes` to `next`. */
static fmi3Status change_mode(Instance *instance, const char *function, int modes, Mode next)
{
    if (instance_require(instance, function, modes) != STATUS_OK) {
        return fmi3Error;
    }
    instance->mode = next;
    return fmi3OK;
}

fmi3Status fmi3EnterEventMode(fmi3Instance instance)
{
    return as_fmi3(instance_accept(instance, __func__, MODE_CONTINUOUS, MODE_EVENT));
}

fmi3Status fmi3Terminate(fmi3Instance instance)
{
    return change_mode(instance, __func__, MODES_RUNNING, MODE_TERMINATED);
}

fmi3Status fmi3Reset(fmi3Instance instance)
{
    return as_fmi3(instance_reset(instance));
}

fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance)
{
    return change_mode(instance, __func__, MODE_INSTANTIATED, MODE_CONFIGURATION);
}

fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance)
{
    return change_mode(instance, __func__, MODE_CONFIGURATION, MODE_INSTANTIATED);
}

/* FMI type of a role. */
typedef enum { FLOAT64, BOOLEAN, UINT64 } Type;

static Type type_of(Role role)
{
    return role == ROLE_FLAG ? BOOLEAN : role == ROLE_STRUCTURE ? UINT64 : FLOAT64;
}

/* Refuse value references of another type, and a number of values that does not match them. */
static Status check_references(Instance *instance, const char *function, Type type,
                               const fmi3ValueReference references[], size_t count, size_t value_count)
{
    size_t expected = 0;
    for (size_t i = 0; i < count; i++) {
        if (references[i] >= VARIABLE_COUNT || model_variables[references[i]].role == ROLE_HIDDEN ||
            type_of(model_variables[references[i]].role) != type) {
            return instance_refuse(instance, "%s: value reference %u is no variable of this type", function,
                                   (unsigned)references[i]);
        }
        expected += variable_size(&model_variables[references[i]], instance->model.coils);
    }
    if (expected != value_count) {
        return instance_refuse(instance, "%s: %zu values for variables of %zu values", function, value_count, expected);
    }
    return STATUS_OK;
}

fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                          fmi3Float64 values[], size_t nValues)
{
    Status status = check_references(instance, __func__, FLOAT64, valueReferences, nValueReferences, nValues);
    for (size_t i = 0; i < nValueReferences && status == STATUS_OK; i++) {
        const size_t size = variable_size(&model_variables[valueReferences[i]], ((Instance *)instance)->model.coils);
        status = instance_get(instance, valueReferences[i], 0, size, values);
        values += size;
    }
    return as_fmi3(status);
}

fmi3Status fmi3SetFloat64(fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                          const fmi3Float64 values[], size_t nValues)
{
    Status status = check_references(instance, __func__, FLOAT64, valueReferences, nValueReferences, nValues);
    for (size_t i = 0; i < nValueReferences && status == STATUS_OK; i++) {
        const size_t size = variable_size(&model_variables[valueReferences[i]], ((Instance *)instance)->model.coils);
        status = instance_set(instance, valueReferences[i], 0, size, values);
        values += size;
    }
    return as_fmi3(status);
}

fmi3Status fmi3GetBoolean(fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                          fmi3Boolean values[], size_t nValues)
{
    Status status = check_references(instance, __func__, BOOLEAN, valueReferences, nValueReferences, nValues);
    for (size_t i = 0; i < nValueReferences && status == STATUS_OK; i++) {
        double value = 0.0;
        status = instance_get(instance, valueReferences[i], 0, 1, &value);
        values[i] = value != 0.0;
    }
    return as_fmi3(status);
}

fmi3Status fmi3SetBoolean(fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                          const fmi3Boolean values[], size_t nValues)
{
    Status status = check_references(instance, __func__, BOOLEAN, valueReferences, nValueReferences, nValues);
    for (size_t i = 0; i < nValueReferences && status == STATUS_OK; i++) {
        const double value = values[i] ? 1.0 : 0.0;
        status = instance_set(instance, valueReferences[i], 0, 1, &value);
    }
    return as_fmi3(status);
}

fmi3Status fmi3GetUInt64(fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                         fmi3UInt64 values[], size_t nValues)
{
    Status status = check_references(instance, __func__, UINT64, valueReferences, nValueReferences, nValues);
    for (size_t i = 0; i < nValueReferences && status == STATUS_OK; i++) {
        values[i] = ((Instance *)instance)->model.coils;
    }
    return as_fmi3(status);
}

fmi3Status fmi3SetUInt64(fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
                         const fmi3UInt64 values[], size_t nValues)
{
    Status status = check_references(instance, __func__, UINT64, valueReferences, nValueReferences, nValues);
    for (size_t i = 0; i < nValueReferences && status == STATUS_OK; i++) {
        const double value = (double)values[i];
        status = instance_set(instance, valueReferences[i], 0, 1, &value);
    }
    return as_fmi3(status);
}

fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 currentCommunicationPoint, fmi3Float64 communicationStepSize,
                      fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean *eventHandlingNeeded,
                      fmi3Boolean *terminateSimulation, fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    *eventHandlingNeeded = *terminateSimulation = *earlyReturn = false;
    *lastSuccessfulTime = currentCommunicationPoint;
    const Status status = instance_step(instance, __func__, currentCommunicationPoint, communicationStepSize);
    if (status == STATUS_OK) {
        *lastSuccessfulTime = currentCommunicationPoint + communicationStepSize;
    }
    return as_fmi3(status);
}
