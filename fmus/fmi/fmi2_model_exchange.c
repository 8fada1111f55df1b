/* FMI 2.0: the functions of Model Exchange. */
#include <math.h>

#include "fmi2Functions.h"
#include "instance.h"

static fmi2Status as_fmi2(Status status)
{
    return status == STATUS_OK ? fmi2OK : fmi2Error;
}

fmi2Status fmi2EnterEventMode(fmi2Component c)
{
    return as_fmi2(instance_accept(c, __func__, MODE_EVENT | MODE_CONTINUOUS, MODE_EVENT));
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *eventInfo)
{
    eventInfo->newDiscreteStatesNeeded = fmi2False;
    eventInfo->terminateSimulation = fmi2False;
    eventInfo->nominalsOfContinuousStatesChanged = fmi2False;
    eventInfo->valuesOfContinuousStatesChanged = fmi2False;
    eventInfo->nextEventTimeDefined = fmi2False;
    eventInfo->nextEventTime = INFINITY;
    return as_fmi2(instance_require(c, __func__, MODE_EVENT));
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c)
{
    return as_fmi2(instance_accept(c, __func__, MODE_EVENT, MODE_CONTINUOUS));
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi2Boolean *enterEventMode, fmi2Boolean *terminateSimulation)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    *enterEventMode = *terminateSimulation = fmi2False;
    return as_fmi2(instance_accept(c, __func__, MODE_CONTINUOUS, MODE_CONTINUOUS));
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time)
{
    return as_fmi2(instance_set_time(c, __func__, time));
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t nx)
{
    return as_fmi2(instance_set_states(c, __func__, x, nx));
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real derivatives[], size_t nx)
{
    return as_fmi2(instance_get_derivatives(c, __func__, derivatives, nx));
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t nx)
{
    return as_fmi2(instance_get_states(c, __func__, x, nx));
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x_nominal[], size_t nx)
{
    return as_fmi2(instance_get_nominals(c, __func__, x_nominal, nx));
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real eventIndicators[], size_t ni)
{
    (void)eventIndicators;
    if (ni != 0) {
        return as_fmi2(instance_refuse(c, "%s: there are no event indicators", __func__));
    }
    return fmi2OK;
}
