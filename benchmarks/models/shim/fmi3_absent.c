/* FMI 3.0: what every FMU must export although these models have none of it. An empty list of values is no error. */
#include "fmi3Functions.h"

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

#define TYPE(Name) \
    fmi3Status fmi3Get##Name(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3##Name v[], size_t m) \
    { \
        return n ? fmi3Error : fmi3OK; \
    } \
    fmi3Status fmi3Set##Name(fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3##Name v[], size_t m) \
    { \
        return n ? fmi3Error : fmi3OK; \
    }
TYPE(Float32)
TYPE(Int8)
TYPE(UInt8)
TYPE(Int16)
TYPE(UInt16)
TYPE(Int32)
TYPE(UInt32)
TYPE(Int64)
TYPE(Boolean)
TYPE(String)

#define REFUSED(Name, ...) \
    fmi3Status fmi3##Name(fmi3Instance c, __VA_ARGS__) { return fmi3Error; }
#define REFERENCES const fmi3ValueReference r[], size_t n

REFUSED(GetBinary, REFERENCES, size_t s[], fmi3Binary v[], size_t m)
REFUSED(SetBinary, REFERENCES, const size_t s[], const fmi3Binary v[], size_t m)
REFUSED(GetClock, REFERENCES, fmi3Clock v[])
REFUSED(SetClock, REFERENCES, const fmi3Clock v[])
REFUSED(GetNumberOfVariableDependencies, fmi3ValueReference r, size_t *n)
REFUSED(GetVariableDependencies, fmi3ValueReference r, size_t e[], fmi3ValueReference i[], size_t f[],
        fmi3DependencyKind k[], size_t n)
REFUSED(GetDirectionalDerivative, REFERENCES, const fmi3ValueReference k[], size_t m, const fmi3Float64 s[], size_t p,
        fmi3Float64 v[], size_t q)
REFUSED(GetAdjointDerivative, REFERENCES, const fmi3ValueReference k[], size_t m, const fmi3Float64 s[], size_t p,
        fmi3Float64 v[], size_t q)
REFUSED(GetOutputDerivatives, REFERENCES, const fmi3Int32 o[], fmi3Float64 v[], size_t m)
REFUSED(GetIntervalDecimal, REFERENCES, fmi3Float64 v[], fmi3IntervalQualifier q[])
REFUSED(GetIntervalFraction, REFERENCES, fmi3UInt64 a[], fmi3UInt64 b[], fmi3IntervalQualifier q[])
REFUSED(GetShiftDecimal, REFERENCES, fmi3Float64 v[])
REFUSED(GetShiftFraction, REFERENCES, fmi3UInt64 a[], fmi3UInt64 b[])
REFUSED(SetIntervalDecimal, REFERENCES, const fmi3Float64 v[])
REFUSED(SetIntervalFraction, REFERENCES, const fmi3UInt64 a[], const fmi3UInt64 b[])
REFUSED(SetShiftDecimal, REFERENCES, const fmi3Float64 v[])
REFUSED(SetShiftFraction, REFERENCES, const fmi3UInt64 a[], const fmi3UInt64 b[])
REFUSED(SetTime, fmi3Float64 time)
REFUSED(SetContinuousStates, const fmi3Float64 x[], size_t n)
REFUSED(GetContinuousStates, fmi3Float64 x[], size_t n)
REFUSED(GetContinuousStateDerivatives, fmi3Float64 x[], size_t n)
REFUSED(GetNominalsOfContinuousStates, fmi3Float64 x[], size_t n)
REFUSED(GetEventIndicators, fmi3Float64 z[], size_t n)
REFUSED(GetNumberOfEventIndicators, size_t *n)
REFUSED(GetNumberOfContinuousStates, size_t *n)
REFUSED(CompletedIntegratorStep, fmi3Boolean f, fmi3Boolean *e, fmi3Boolean *t)
REFUSED(ActivateModelPartition, fmi3ValueReference r, fmi3Float64 time)
fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c) { return fmi3Error; }

fmi3Instance fmi3InstantiateModelExchange(fmi3String a, fmi3String b, fmi3String r, fmi3Boolean v, fmi3Boolean l,
                                          fmi3InstanceEnvironment e, fmi3LogMessageCallback m)
{
    return NULL;
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String a, fmi3String b, fmi3String r, fmi3Boolean v, fmi3Boolean l,
                                               fmi3InstanceEnvironment e, fmi3LogMessageCallback m,
                                               fmi3ClockUpdateCallback u, fmi3LockPreemptionCallback k,
                                               fmi3UnlockPreemptionCallback o)
{
    return NULL;
}
