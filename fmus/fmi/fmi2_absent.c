/* FMI 2.0: functions that every FMU exports, for features that these models do not have. Each is refused. */
#include "fmi2Functions.h"
#include "instance.h"

#define REFUSE(c) (instance_refuse(c, "%s: this FMU has nothing of the kind", __func__), fmi2Error)

#define ABSENT(Name, ...) \
    fmi2Status fmi2##Name(fmi2Component c, __VA_ARGS__) \
    { \
        return REFUSE(c); \
    }

#define ABSENT_TYPE(Name) \
    fmi2Status fmi2Get##Name(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2##Name v[]) \
    { \
        return n == 0 ? fmi2OK : REFUSE(c); \
    } \
    fmi2Status fmi2Set##Name(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2##Name v[]) \
    { \
        return n == 0 ? fmi2OK : REFUSE(c); \
    }

#if defined(__GNUC__) /* the arguments of what is absent are not looked at */
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

ABSENT_TYPE(Integer)
ABSENT_TYPE(String)
ABSENT(GetDirectionalDerivative, const fmi2ValueReference u[], size_t n, const fmi2ValueReference k[], size_t m,
       const fmi2Real s[], fmi2Real v[])
ABSENT(SetRealInputDerivatives, const fmi2ValueReference r[], size_t n, const fmi2Integer o[], const fmi2Real v[])
ABSENT(GetRealOutputDerivatives, const fmi2ValueReference r[], size_t n, const fmi2Integer o[], fmi2Real v[])
ABSENT(GetStatus, const fmi2StatusKind k, fmi2Status *v)
ABSENT(GetRealStatus, const fmi2StatusKind k, fmi2Real *v)
ABSENT(GetIntegerStatus, const fmi2StatusKind k, fmi2Integer *v)
ABSENT(GetBooleanStatus, const fmi2StatusKind k, fmi2Boolean *v)
ABSENT(GetStringStatus, const fmi2StatusKind k, fmi2String *v)

fmi2Status fmi2CancelStep(fmi2Component c)
{
    return REFUSE(c);
}
