/* FMI 3.0: the functions of Model Exchange. */
#include <math.h>

#include "fmi3Functions.h"
#include "instance.h"

static fmi3Status as_fmi3(Status status)
{
    return status == STATUS_OK ? fmi3OK : fmi3Error;
}

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance)
{
    return as_fmi3(instance_accept(instance, __func__, MODE_EVENT, MODE_CONTINUOUS));
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance, fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi3Boolean *enterEventMode, fmi3Boolean *terminateSimulation)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    *enterEventMode = *terminateSimulation = false;
    return as_fmi3(instance_accept(instance, __func__, MODE_CONTINUOUS, MODE_CONTINUOUS));
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance)
{
    return as_fmi3(instance_require(instance, __func__, MODE_INITIALISATION | MODE_EVENT));
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean *discreteStatesNeedUpdate,
                                    fmi3Boolean *terminateSimulation, fmi3Boolean *nominalsOfContinuousStatesChanged,
                                    fmi3Boolean *valuesOfContinuousStatesChanged, fmi3Boolean *nextEventTimeDefined,
                                    fmi3Float64 *nextEventTime)
{
    *discreteStatesNeedUpdate = *terminateSimulation = *nominalsOfContinuousStatesChanged = false;
    *valuesOfContinuousStatesChanged = *nextEventTimeDefined = false;
    *nextEventTime = INFINITY;
    return as_fmi3(instance_require(instance, __func__, MODE_EVENT));
}

fmi3Status fmi3SetTime(fmi3Instance instance, fmi3Float64 time)
{
    return as_fmi3(instance_set_time(instance, __func__, time));
}

fmi3Status fmi3SetContinuousStates(fmi3Instance instance, const fmi3Float64 continuousStates[],
                                   size_t nContinuousStates)
{
    return as_fmi3(instance_set_states(instance, __func__, continuousStates, nContinuousStates));
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance, fmi3Float64 derivatives[],
                                             size_t nContinuousStates)
{
    return as_fmi3(instance_get_derivatives(instance, __func__, derivatives, nContinuousStates));
}

fmi3Status fmi3GetContinuousStates(fmi3Instance instance, fmi3Float64 continuousStates[], size_t nContinuousStates)
{
    return as_fmi3(instance_get_states(instance, __func__, continuousStates, nContinuousStates));
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance, fmi3Float64 nominals[], size_t nContinuousStates)
{
    return as_fmi3(instance_get_nominals(instance, __func__, nominals, nContinuousStates));
}

fmi3Status fmi3GetEventIndicators(fmi3Instance instance, fmi3Float64 eventIndicators[], size_t nEventIndicators)
{
    (void)eventIndicators;
    if (nEventIndicators != 0) {
        return as_fmi3(instance_refuse(instance, "%s: there are no event indicators", __func__));
    }
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance, size_t *nEventIndicators)
{
    (void)instance;
    *nEventIndicators = 0;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance, size_t *nContinuousStates)
{
    *nContinuousStates = instance_state_count(instance);
    return fmi3OK;
}
