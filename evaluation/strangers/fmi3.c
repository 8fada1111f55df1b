/* A model of ordinary differential equations as an FMU of FMI 3.0, Model Exchange and Co-Simulation.
 *
 * The generated part before this one defines NX, NU, NP, NY, INNER_STEP, GUID, start_values, start_states(p, x),
 * rates(t, p, x, u, d) and outputs(t, p, x, u, y). Value references: 0 is time, then parameters, inputs, states,
 * derivatives, outputs. FMI 3.0, sections 2 to 4.
 */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { OK, WARNING, DISCARD, ERROR };
#define API __attribute__((visibility("default"))) int
#define API_OBJECT __attribute__((visibility("default"))) void *

typedef struct {
    double p[NP + 1], u[NU + 1], x[NX + 1], d[NX + 1], y[NY + 1], time;
    bool is_set[NX + 1], is_exchanged;
} Model;

__attribute__((visibility("default"))) const char *fmi3GetVersion(void) { return "3.0"; }
API fmi3SetDebugLogging(void *c, bool on, size_t n, const char *const k[])
{
    (void)c; (void)on; (void)n; (void)k;
    return OK;
}
static void set_all(Model *m)
{
    const bool kept = m->is_exchanged;
    memset(m, 0, sizeof *m);
    m->is_exchanged = kept;
    memcpy(m->p, start_values, NP * sizeof(double));
    memcpy(m->u, start_values + NP, NU * sizeof(double));
}
static void *made(const char *token, bool is_exchanged)
{
    if (!token || strcmp(token, GUID)) { return NULL; }
    Model *m = calloc(1, sizeof *m);
    m->is_exchanged = is_exchanged;
    set_all(m);
    return m;
}
API_OBJECT fmi3InstantiateModelExchange(const char *name, const char *token, const char *path, bool visible,
                                        bool logging, void *e, void *log)
{
    (void)name; (void)path; (void)visible; (void)logging; (void)e; (void)log;
    return made(token, true);
}
API_OBJECT fmi3InstantiateCoSimulation(const char *name, const char *token, const char *path, bool visible,
                                       bool logging, bool events, bool early, const uint32_t v[], size_t n, void *e,
                                       void *log, void *update)
{
    (void)name; (void)path; (void)visible; (void)logging; (void)events; (void)early; (void)v; (void)n;
    (void)e; (void)log; (void)update;
    return made(token, false);
}
API_OBJECT fmi3InstantiateScheduledExecution(void) { return NULL; }
__attribute__((visibility("default"))) void fmi3FreeInstance(void *c) { free(c); }
API fmi3Reset(void *c) { set_all(c); return OK; }
API fmi3EnterInitializationMode(void *c, bool td, double tolerance, double start, bool sd, double stop)
{
    (void)td; (void)tolerance; (void)sd; (void)stop;
    ((Model *)c)->time = start;
    return OK;
}
API fmi3ExitInitializationMode(void *c)
{
    Model *m = c;
    double x[NX + 1];
    start_states(m->p, x);
    for (int i = 0; i < NX; ++i) {
        if (!m->is_set[i]) { m->x[i] = x[i]; }
    }
    return OK;
}
API fmi3EnterEventMode(void *c) { (void)c; return OK; }
API fmi3EnterStepMode(void *c) { (void)c; return OK; }
API fmi3EnterConfigurationMode(void *c) { (void)c; return OK; }
API fmi3ExitConfigurationMode(void *c) { (void)c; return OK; }
API fmi3Terminate(void *c) { (void)c; return OK; }

API fmi3GetFloat64(void *c, const uint32_t r[], size_t n, double v[], size_t k)
{
    Model *m = c;
    if (n != k) { return ERROR; }
    for (size_t i = 0; i < n; ++i) {
        size_t j = r[i];
        if (j == 0) { v[i] = m->time; continue; }
        j -= 1;
        if (j < NP) { v[i] = m->p[j]; continue; }
        j -= NP;
        if (j < NU) { v[i] = m->u[j]; continue; }
        j -= NU;
        if (j < NX) { v[i] = m->x[j]; continue; }
        j -= NX;
        if (j < NX) { rates(m->time, m->p, m->x, m->u, m->d); v[i] = m->d[j]; continue; }
        j -= NX;
        if (j >= NY) { return ERROR; }
        outputs(m->time, m->p, m->x, m->u, m->y);
        v[i] = m->y[j];
    }
    return OK;
}
API fmi3SetFloat64(void *c, const uint32_t r[], size_t n, const double v[], size_t k)
{
    Model *m = c;
    if (n != k) { return ERROR; }
    for (size_t i = 0; i < n; ++i) {
        size_t j = r[i];
        if (j == 0) { return ERROR; }
        j -= 1;
        if (j < NP) { m->p[j] = v[i]; continue; }
        j -= NP;
        if (j < NU) { m->u[j] = v[i]; continue; }
        j -= NU;
        if (j >= NX) { return ERROR; }
        m->x[j] = v[i];
        m->is_set[j] = true;
    }
    return OK;
}
#define ABSENT(name) API name(void *c) { (void)c; return ERROR; }
ABSENT(fmi3GetFloat32) ABSENT(fmi3GetInt8) ABSENT(fmi3GetUInt8) ABSENT(fmi3GetInt16) ABSENT(fmi3GetUInt16)
ABSENT(fmi3GetInt32) ABSENT(fmi3GetUInt32) ABSENT(fmi3GetInt64) ABSENT(fmi3GetUInt64) ABSENT(fmi3GetBoolean)
ABSENT(fmi3GetString) ABSENT(fmi3GetBinary) ABSENT(fmi3GetClock) ABSENT(fmi3SetFloat32) ABSENT(fmi3SetInt8)
ABSENT(fmi3SetUInt8) ABSENT(fmi3SetInt16) ABSENT(fmi3SetUInt16) ABSENT(fmi3SetInt32) ABSENT(fmi3SetUInt32)
ABSENT(fmi3SetInt64) ABSENT(fmi3SetUInt64) ABSENT(fmi3SetBoolean) ABSENT(fmi3SetString) ABSENT(fmi3SetBinary)
ABSENT(fmi3SetClock) ABSENT(fmi3GetNumberOfVariableDependencies) ABSENT(fmi3GetVariableDependencies)
ABSENT(fmi3GetFMUState) ABSENT(fmi3SetFMUState) ABSENT(fmi3FreeFMUState) ABSENT(fmi3SerializedFMUStateSize)
ABSENT(fmi3SerializeFMUState) ABSENT(fmi3DeserializeFMUState) ABSENT(fmi3GetDirectionalDerivative)
ABSENT(fmi3GetAdjointDerivative) ABSENT(fmi3GetIntervalDecimal) ABSENT(fmi3GetIntervalFraction)
ABSENT(fmi3GetShiftDecimal) ABSENT(fmi3GetShiftFraction) ABSENT(fmi3SetIntervalDecimal)
ABSENT(fmi3SetIntervalFraction) ABSENT(fmi3SetShiftDecimal) ABSENT(fmi3SetShiftFraction)
ABSENT(fmi3EvaluateDiscreteStates) ABSENT(fmi3GetOutputDerivatives) ABSENT(fmi3ActivateModelPartition)

API fmi3UpdateDiscreteStates(void *c, bool *again, bool *terminate, bool *nominals, bool *values, bool *is_timed,
                             double *next)
{
    (void)c; (void)next;
    *again = *terminate = *nominals = *values = *is_timed = false;
    return OK;
}
/* Model Exchange */
API fmi3EnterContinuousTimeMode(void *c) { (void)c; return OK; }
API fmi3CompletedIntegratorStep(void *c, bool no_set, bool *event, bool *terminate)
{
    (void)c; (void)no_set;
    *event = *terminate = false;
    return OK;
}
API fmi3SetTime(void *c, double t) { ((Model *)c)->time = t; return OK; }
API fmi3SetContinuousStates(void *c, const double x[], size_t n)
{
    memcpy(((Model *)c)->x, x, n * sizeof(double));
    return OK;
}
API fmi3GetContinuousStates(void *c, double x[], size_t n)
{
    memcpy(x, ((Model *)c)->x, n * sizeof(double));
    return OK;
}
API fmi3GetContinuousStateDerivatives(void *c, double d[], size_t n)
{
    Model *m = c;
    rates(m->time, m->p, m->x, m->u, m->d);
    memcpy(d, m->d, n * sizeof(double));
    return OK;
}
API fmi3GetNominalsOfContinuousStates(void *c, double x[], size_t n)
{
    (void)c;
    for (size_t i = 0; i < n; ++i) { x[i] = 1.0; }
    return OK;
}
API fmi3GetEventIndicators(void *c, double z[], size_t n) { (void)c; (void)z; (void)n; return OK; }
API fmi3GetNumberOfEventIndicators(void *c, size_t *n) { (void)c; *n = 0; return OK; }
API fmi3GetNumberOfContinuousStates(void *c, size_t *n) { (void)c; *n = NX; return OK; }
/* Co-Simulation: Heun's method with inputs held */
API fmi3DoStep(void *c, double time, double size, bool no_set, bool *event, bool *terminate, bool *early, double *last)
{
    Model *m = c;
    (void)no_set;
    int steps = (int)(size / INNER_STEP + 0.999999);
    steps = steps < 1 ? 1 : steps;
    const double h = size / steps;
    for (int s = 0; s < steps; ++s) {
        double a[NX + 1], b[NX + 1], y[NX + 1];
        rates(time + s * h, m->p, m->x, m->u, a);
        for (int i = 0; i < NX; ++i) { y[i] = m->x[i] + h * a[i]; }
        rates(time + (s + 1) * h, m->p, y, m->u, b);
        for (int i = 0; i < NX; ++i) { m->x[i] += 0.5 * h * (a[i] + b[i]); }
    }
    m->time = time + size;
    *event = *terminate = *early = false;
    *last = m->time;
    return OK;
}
