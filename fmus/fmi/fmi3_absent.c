/* FMI 3.0: functions that every FMU exports, for features that these models do not have. Each is refused. */
#include "fmi3Functions.h"
#include "instance.h"

#define REFUSE(instance) (instance_refuse(instance, "%s: this FMU has nothing of the kind", __func__), fmi3Error)

#define ABSENT_TYPE(Name) \
    fmi3Status fmi3Get##Name(fmi3Instance instance, const fmi3ValueReference references[], size_t count, \
                             fmi3##Name values[], size_t value_count) \
    { \
        (void)references, (void)values; \
        return count == 0 && value_count == 0 ? fmi3OK : REFUSE(instance); \
    } \
    fmi3Status fmi3Set##Name(fmi3Instance instance, const fmi3ValueReference references[], size_t count, \
                             const fmi3##Name values[], size_t value_count) \
    { \
        (void)references, (void)values; \
        return count == 0 && value_count == 0 ? fmi3OK : REFUSE(instance); \
    }

ABSENT_TYPE(Float32)
ABSENT_TYPE(Int8)
ABSENT_TYPE(UInt8)
ABSENT_TYPE(Int16)
ABSENT_TYPE(UInt16)
ABSENT_TYPE(Int32)
ABSENT_TYPE(UInt32)
ABSENT_TYPE(Int64)
ABSENT_TYPE(String)

#define ABSENT(Name, ...) \
    fmi3Status fmi3##Name(fmi3Instance instance, __VA_ARGS__) \
    { \
        return REFUSE(instance); \
    }

#if defined(__GNUC__) /* the arguments of what is absent are not looked at */
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

ABSENT(GetBinary, const fmi3ValueReference r[], size_t n, size_t s[], fmi3Binary v[], size_t m)
ABSENT(SetBinary, const fmi3ValueReference r[], size_t n, const size_t s[], const fmi3Binary v[], size_t m)
ABSENT(GetClock, const fmi3ValueReference r[], size_t n, fmi3Clock v[])
ABSENT(SetClock, const fmi3ValueReference r[], size_t n, const fmi3Clock v[])
ABSENT(GetNumberOfVariableDependencies, fmi3ValueReference r, size_t *n)
ABSENT(GetVariableDependencies, fmi3ValueReference r, size_t e[], fmi3ValueReference i[], size_t f[],
       fmi3DependencyKind k[], size_t n)
ABSENT(GetDirectionalDerivative, const fmi3ValueReference u[], size_t n, const fmi3ValueReference k[], size_t m,
       const fmi3Float64 s[], size_t p, fmi3Float64 v[], size_t q)
ABSENT(GetAdjointDerivative, const fmi3ValueReference u[], size_t n, const fmi3ValueReference k[], size_t m,
       const fmi3Float64 s[], size_t p, fmi3Float64 v[], size_t q)
ABSENT(GetIntervalDecimal, const fmi3ValueReference r[], size_t n, fmi3Float64 v[], fmi3IntervalQualifier q[])
ABSENT(GetIntervalFraction, const fmi3ValueReference r[], size_t n, fmi3UInt64 c[], fmi3UInt64 s[],
       fmi3IntervalQualifier q[])
ABSENT(GetShiftDecimal, const fmi3ValueReference r[], size_t n, fmi3Float64 v[])
ABSENT(GetShiftFraction, const fmi3ValueReference r[], size_t n, fmi3UInt64 c[], fmi3UInt64 s[])
ABSENT(SetIntervalDecimal, const fmi3ValueReference r[], size_t n, const fmi3Float64 v[])
ABSENT(SetIntervalFraction, const fmi3ValueReference r[], size_t n, const fmi3UInt64 c[], const fmi3UInt64 s[])
ABSENT(SetShiftDecimal, const fmi3ValueReference r[], size_t n, const fmi3Float64 v[])
ABSENT(SetShiftFraction, const fmi3ValueReference r[], size_t n, const fmi3UInt64 c[], const fmi3UInt64 s[])
ABSENT(GetOutputDerivatives, const fmi3ValueReference r[], size_t n, const fmi3Int32 o[], fmi3Float64 v[], size_t m)
ABSENT(ActivateModelPartition, fmi3ValueReference r, fmi3Float64 t)

fmi3Status fmi3EnterStepMode(fmi3Instance instance)
{
    return REFUSE(instance);
}
