/* A model of ordinary differential equations as an FMU of FMI 2.0, Model Exchange and Co-Simulation.
 *
 * The generated part before this one defines NX, NU, NP, NY, INNER_STEP, GUID, start_values, start_states(p, x),
 * rates(t, p, x, u, d) and outputs(t, p, x, u, y). Value references: parameters, inputs, states, derivatives, outputs.
 * FMI 2.0.4, sections 2 to 4.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void *fmi2Component;
typedef unsigned fmi2ValueReference;
typedef int fmi2Status;
typedef int fmi2Boolean;
enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending };
#define API __attribute__((visibility("default")))

typedef struct {
    double p[NP + 1], u[NU + 1], x[NX + 1], d[NX + 1], y[NY + 1], time;
    int is_set[NX + 1];
} Model;

typedef struct {
    int newDiscreteStatesNeeded, terminateSimulation, nominalsChanged, valuesChanged, nextEventTimeDefined;
    double nextEventTime;
} EventInfo;

API const char *fmi2GetTypesPlatform(void) { return "default"; }
API const char *fmi2GetVersion(void) { return "2.0"; }
API fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const char *const k[])
{
    (void)c; (void)on; (void)n; (void)k;
    return fmi2OK;
}
static void reset(Model *m)
{
    memset(m, 0, sizeof *m);
    memcpy(m->p, start_values, NP * sizeof(double));
    memcpy(m->u, start_values + NP, NU * sizeof(double));
}
API fmi2Component fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const void *f,
                                  fmi2Boolean visible, fmi2Boolean logging)
{
    (void)name; (void)type; (void)resources; (void)f; (void)visible; (void)logging;
    if (strcmp(guid, GUID)) {
        return NULL;
    }
    Model *m = calloc(1, sizeof *m);
    reset(m);
    return m;
}
API void fmi2FreeInstance(fmi2Component c) { free(c); }
API fmi2Status fmi2Reset(fmi2Component c) { reset(c); return fmi2OK; }
API fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean td, double t, double start, fmi2Boolean sd, double stop)
{
    (void)td; (void)t; (void)sd; (void)stop;
    ((Model *)c)->time = start;
    return fmi2OK;
}
API fmi2Status fmi2EnterInitializationMode(fmi2Component c) { (void)c; return fmi2OK; }
API fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    Model *m = c;
    double x[NX + 1];
    start_states(m->p, x);
    for (int i = 0; i < NX; ++i) {
        if (!m->is_set[i]) {
            m->x[i] = x[i];
        }
    }
    return fmi2OK;
}
API fmi2Status fmi2Terminate(fmi2Component c) { (void)c; return fmi2OK; }

API fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, double v[])
{
    Model *m = c;
    int is_new = 0;
    for (size_t i = 0; i < n; ++i) {
        size_t k = r[i];
        if (k < NP) { v[i] = m->p[k]; continue; }
        k -= NP;
        if (k < NU) { v[i] = m->u[k]; continue; }
        k -= NU;
        if (k < NX) { v[i] = m->x[k]; continue; }
        k -= NX;
        if (k < NX) { rates(m->time, m->p, m->x, m->u, m->d); v[i] = m->d[k]; continue; }
        k -= NX;
        if (k >= NY) { return fmi2Error; }
        if (!is_new) { outputs(m->time, m->p, m->x, m->u, m->y); is_new = 1; }
        v[i] = m->y[k];
    }
    return fmi2OK;
}
API fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, const double v[])
{
    Model *m = c;
    for (size_t i = 0; i < n; ++i) {
        size_t k = r[i];
        if (k < NP) { m->p[k] = v[i]; continue; }
        k -= NP;
        if (k < NU) { m->u[k] = v[i]; continue; }
        k -= NU;
        if (k >= NX) { return fmi2Error; }
        m->x[k] = v[i];
        m->is_set[k] = 1;
    }
    return fmi2OK;
}
#define ABSENT(name, type) \
    API fmi2Status name(fmi2Component c, const fmi2ValueReference r[], size_t n, type v) \
    { (void)c; (void)r; (void)v; return n ? fmi2Error : fmi2OK; }
ABSENT(fmi2GetInteger, int *) ABSENT(fmi2SetInteger, const int *) ABSENT(fmi2GetBoolean, int *)
ABSENT(fmi2SetBoolean, const int *) ABSENT(fmi2GetString, const char **) ABSENT(fmi2SetString, const char *const *)

API fmi2Status fmi2GetFMUstate(fmi2Component c, void **s)
{
    if (!*s) { *s = malloc(sizeof(Model)); }
    memcpy(*s, c, sizeof(Model));
    return fmi2OK;
}
API fmi2Status fmi2SetFMUstate(fmi2Component c, void *s) { memcpy(c, s, sizeof(Model)); return fmi2OK; }
API fmi2Status fmi2FreeFMUstate(fmi2Component c, void **s) { (void)c; free(*s); *s = NULL; return fmi2OK; }
API fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, void *s, size_t *n)
{
    (void)c; (void)s;
    *n = sizeof(Model);
    return fmi2OK;
}
API fmi2Status fmi2SerializeFMUstate(fmi2Component c, void *s, char b[], size_t n)
{
    (void)c;
    memcpy(b, s, n);
    return fmi2OK;
}
API fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const char b[], size_t n, void **s)
{
    (void)c;
    *s = malloc(n);
    memcpy(*s, b, n);
    return fmi2OK;
}
API fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference a[], size_t n,
                                            const fmi2ValueReference b[], size_t k, const double x[], double y[])
{
    (void)c; (void)a; (void)n; (void)b; (void)k; (void)x; (void)y;
    return fmi2Error;
}
/* Model Exchange */
API fmi2Status fmi2EnterEventMode(fmi2Component c) { (void)c; return fmi2OK; }
API fmi2Status fmi2NewDiscreteStates(fmi2Component c, EventInfo *info)
{
    (void)c;
    memset(info, 0, sizeof *info);
    return fmi2OK;
}
API fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) { (void)c; return fmi2OK; }
API fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean n, fmi2Boolean *event, fmi2Boolean *end)
{
    (void)c; (void)n;
    *event = *end = 0;
    return fmi2OK;
}
API fmi2Status fmi2SetTime(fmi2Component c, double t) { ((Model *)c)->time = t; return fmi2OK; }
API fmi2Status fmi2SetContinuousStates(fmi2Component c, const double x[], size_t n)
{
    memcpy(((Model *)c)->x, x, n * sizeof(double));
    return fmi2OK;
}
API fmi2Status fmi2GetDerivatives(fmi2Component c, double d[], size_t n)
{
    Model *m = c;
    rates(m->time, m->p, m->x, m->u, m->d);
    memcpy(d, m->d, n * sizeof(double));
    return fmi2OK;
}
API fmi2Status fmi2GetEventIndicators(fmi2Component c, double z[], size_t n) { (void)c; (void)z; (void)n; return fmi2OK; }
API fmi2Status fmi2GetContinuousStates(fmi2Component c, double x[], size_t n)
{
    memcpy(x, ((Model *)c)->x, n * sizeof(double));
    return fmi2OK;
}
API fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, double x[], size_t n)
{
    (void)c;
    for (size_t i = 0; i < n; ++i) { x[i] = 1.0; }
    return fmi2OK;
}
/* Co-Simulation: classical Runge-Kutta with inputs held */
API fmi2Status fmi2DoStep(fmi2Component c, double time, double size, fmi2Boolean n)
{
    Model *m = c;
    (void)n;
    int steps = (int)(size / INNER_STEP + 0.999999);
    steps = steps < 1 ? 1 : steps;
    const double h = size / steps;
    for (int s = 0; s < steps; ++s) {
        double k[4][NX + 1], y[NX + 1], t = time + s * h;
        const double at[4] = {0.0, 0.5, 0.5, 1.0};
        for (int stage = 0; stage < 4; ++stage) {
            for (int i = 0; i < NX; ++i) { y[i] = m->x[i] + (stage ? at[stage] * h * k[stage - 1][i] : 0.0); }
            rates(t + at[stage] * h, m->p, y, m->u, k[stage]);
        }
        for (int i = 0; i < NX; ++i) { m->x[i] += h / 6.0 * (k[0][i] + 2.0 * (k[1][i] + k[2][i]) + k[3][i]); }
    }
    m->time = time + size;
    return fmi2OK;
}
API fmi2Status fmi2CancelStep(fmi2Component c) { (void)c; return fmi2Error; }
API fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t n, const int o[],
                                           const double v[])
{
    (void)c; (void)r; (void)n; (void)o; (void)v;
    return fmi2Error;
}
API fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t n, const int o[],
                                            double v[])
{
    (void)c; (void)r; (void)n; (void)o; (void)v;
    return fmi2Error;
}
#define STATUS(name, type) \
    API fmi2Status name(fmi2Component c, int k, type *v) { (void)c; (void)k; (void)v; return fmi2Discard; }
STATUS(fmi2GetStatus, int) STATUS(fmi2GetRealStatus, double) STATUS(fmi2GetIntegerStatus, int)
STATUS(fmi2GetBooleanStatus, int) STATUS(fmi2GetStringStatus, const char *)
