/* Functions of FMI 2.0 that the model has no use for; each takes what the standard says and returns OK or Error. */
fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[])
{
    return (void)c, (void)on, (void)n, (void)categories, fmi2OK;
}
fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean t, fmi2Real tol, fmi2Real start, fmi2Boolean s, fmi2Real stop)
{
    return (void)c, (void)t, (void)tol, (void)start, (void)s, (void)stop, fmi2OK;
}
fmi2Status fmi2Reset(fmi2Component c) { return (void)c, fmi2Error; }
fmi2Status fmi2CancelStep(fmi2Component c) { return (void)c, fmi2Error; }

#define ACCESS(name, Type)                                                                          \
    fmi2Status name(fmi2Component c, const fmi2ValueReference vr[], size_t n, Type value[])         \
    {                                                                                               \
        return (void)c, (void)vr, (void)value, n ? fmi2Error : fmi2OK;                              \
    }
ACCESS(fmi2SetInteger, const fmi2Integer)
ACCESS(fmi2SetBoolean, const fmi2Boolean)
ACCESS(fmi2SetString, const fmi2String)
ACCESS(fmi2GetBoolean, fmi2Boolean)
ACCESS(fmi2GetString, fmi2String)

#define DERIVATIVES(name, Type)                                                                     \
    fmi2Status name(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Integer o[], \
                    Type value[])                                                                   \
    {                                                                                               \
        return (void)c, (void)vr, (void)n, (void)o, (void)value, fmi2Error;                         \
    }
DERIVATIVES(fmi2SetRealInputDerivatives, const fmi2Real)
DERIVATIVES(fmi2GetRealOutputDerivatives, fmi2Real)

#define STATUS(name, Type)                                                                          \
    fmi2Status name(fmi2Component c, const fmi2StatusKind kind, Type *value)                        \
    {                                                                                               \
        return (void)c, (void)kind, (void)value, fmi2Discard;                                       \
    }
STATUS(fmi2GetStatus, fmi2Status)
STATUS(fmi2GetRealStatus, fmi2Real)
STATUS(fmi2GetIntegerStatus, fmi2Integer)
STATUS(fmi2GetBooleanStatus, fmi2Boolean)
STATUS(fmi2GetStringStatus, fmi2String)

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference u[], size_t nu,
                                        const fmi2ValueReference k[], size_t nk, const fmi2Real du[], fmi2Real dz[])
{
    return (void)c, (void)u, (void)nu, (void)k, (void)nk, (void)du, (void)dz, fmi2Error;
}
