/* A Co-Simulation FMU of every kind of number that fails on command: FMI_VERSION 2 or 3.
 *
 * Value references: u 1, ua 2..4, uf 5, ui 6, ub 7; y 11, ya 12..14, yf 15, yi 16, yb 17, z 18; rate 21, moment 22,
 * kind 23, gain 24, fixed_step 25 [s] (0: any). From `moment` [s] on it does what `kind` says (see enum). An FMI 3.0 array has the first number of
 * its elements.
 */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#if FMI_VERSION == 3
#include "fmi3Functions.h"
typedef fmi3Instance Handle;
#else
#include "fmi2Functions.h"
typedef fmi2Component Handle;
#endif

enum { U = 1, UA, UF = 5, UI, UB, Y = 11, YA, YF = 15, YI, YB, Z, RATE = 21, MOMENT, KIND, GAIN, FIXED_STEP, COUNT };
enum { WELL, STEP_ERROR, STEP_DISCARD, NAN_ELEMENT, GET_ERROR, SET_ERROR, EARLY, TERMINATE, WARNING, INFINITE, FATAL };
enum { OK, WARNED, DISCARDED, FAILED, DEAD };

typedef struct {
    double v[COUNT];
    double time;
    bool is_running, had_event;
    void *environment;
#if FMI_VERSION == 3
    fmi3LogMessageCallback log;
#else
    const fmi2CallbackFunctions *callbacks;
#endif
} Model;

static bool is_due(const Model *m, int kind)
{
    return m->is_running && (int)m->v[KIND] == kind && m->time >= m->v[MOMENT];
}

static int say(Model *m, int status, const char *text)
{
#if FMI_VERSION == 3
    m->log(m->environment, (fmi3Status)status, "logStatus", text);
#else
    m->callbacks->logger(m->environment, "scripted", (fmi2Status)status, "logStatus", text);
#endif
    return status;
}

static void follow(Model *m)
{
    m->v[Z] = m->v[GAIN] * m->v[U] + m->v[Y];
}

static int advance(Model *m, double time, double size)
{
    if (is_due(m, STEP_ERROR)) {
        return say(m, FAILED, "the step fails on command");
    }
    if (is_due(m, STEP_DISCARD)) {
        return DISCARDED;
    }
    if (is_due(m, FATAL)) {
        return say(m, DEAD, "fatal on command");
    }
    if (m->v[FIXED_STEP] != 0.0 && size != m->v[FIXED_STEP]) {
        return say(m, FAILED, "the step is not the fixed one");
    }
    const double part = -expm1(-m->v[RATE] * size);
    m->v[Y] += (m->v[U] - m->v[Y]) * part;
    for (int i = 0; i < 3; ++i) {
        m->v[YA + i] += (m->v[UA + i] - m->v[YA + i]) * part + 0.01 * sin(time + i);
    }
    m->v[YF] = (float)(0.5 * m->v[YF] + m->v[UF] + 0.1);
    m->v[YI] = (double)(((int)m->v[YI] + (int)m->v[UI] + 7) % 1000);
    m->v[YB] = (m->v[UB] != 0.0) != (m->v[Y] > 0.5);
    m->time = time + size;
    if (is_due(m, NAN_ELEMENT)) {
        m->v[YA + 1] = NAN;
    }
    if (is_due(m, INFINITE)) {
        m->v[Y] = INFINITY;
    }
    return is_due(m, WARNING) ? say(m, WARNED, "a warning on command") : OK;
}

/* One list of references; `width` elements each where they are FMI 3.0 arrays. */
#define GET(TYPE)                                                                                                      \
    Model *m = handle;                                                                                                 \
    if (is_due(m, GET_ERROR)) return say(m, FAILED, "no value on command");                                            \
    follow(m);                                                                                                         \
    for (size_t i = 0, k = 0; i < n; ++i)                                                                              \
        for (int j = 0; j < width(r[i]); ++j) values[k++] = (TYPE)m->v[r[i] + (unsigned)j];                            \
    return OK

#define SET                                                                                                            \
    Model *m = handle;                                                                                                 \
    if (is_due(m, SET_ERROR) && r[0] == UA) return say(m, FAILED, "refused on command");                               \
    for (size_t i = 0, k = 0; i < n; ++i)                                                                              \
        for (int j = 0; j < width(r[i]); ++j) m->v[r[i] + (unsigned)j] = (double)values[k++];                          \
    return OK

#if FMI_VERSION == 3
#pragma GCC diagnostic ignored "-Wunused-parameter"
static int width(unsigned reference) { return reference == UA || reference == YA ? 3 : 1; }

#define ACCESS(Name)                                                                                                   \
    fmi3Status fmi3Get##Name(Handle handle, const fmi3ValueReference r[], size_t n, fmi3##Name values[], size_t count) \
    { GET(fmi3##Name); }                                                                                               \
    fmi3Status fmi3Set##Name(Handle handle, const fmi3ValueReference r[], size_t n, const fmi3##Name values[],         \
                             size_t count)                                                                             \
    { SET; }
ACCESS(Float64)
ACCESS(Float32)
ACCESS(Int32)
ACCESS(Boolean)

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                         fmi3Boolean logging, fmi3Boolean event_mode, fmi3Boolean early_allowed,
                                         const fmi3ValueReference required[], size_t n, fmi3InstanceEnvironment e,
                                         fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update)
{
    Model *m = calloc(1, sizeof *m);
    m->log = log;
    m->environment = e;
    m->v[RATE] = m->v[GAIN] = 1.0;
    return m;
}
void fmi3FreeInstance(fmi3Instance handle) { free(handle); }
fmi3Status fmi3EnterInitializationMode(fmi3Instance handle, fmi3Boolean has_tolerance, fmi3Float64 tolerance,
                                       fmi3Float64 start, fmi3Boolean has_stop, fmi3Float64 stop)
{
    ((Model *)handle)->time = start;
    return fmi3OK;
}
fmi3Status fmi3ExitInitializationMode(fmi3Instance handle)
{
    ((Model *)handle)->is_running = true;
    return fmi3OK;
}
fmi3Status fmi3DoStep(fmi3Instance handle, fmi3Float64 time, fmi3Float64 size, fmi3Boolean no_return,
                      fmi3Boolean *event, fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *reached)
{
    Model *m = handle;
    *event = false;
    *terminate = is_due(m, TERMINATE);
    *early = is_due(m, EARLY);
    const double done = *early ? 0.5 * size : size;
    *reached = time + done;
    return (fmi3Status)advance(m, time, done);
}
fmi3Status fmi3Terminate(fmi3Instance handle) { return fmi3OK; }

/* With Event Mode: a time event at `moment`, which adds 100 to yi and of which fmi3DoStep says nothing. */
fmi3Status fmi3EnterEventMode(fmi3Instance handle) { return fmi3OK; }
fmi3Status fmi3EnterStepMode(fmi3Instance handle) { return fmi3OK; }
fmi3Status fmi3UpdateDiscreteStates(fmi3Instance handle, fmi3Boolean *again, fmi3Boolean *terminate,
                                    fmi3Boolean *nominals, fmi3Boolean *states, fmi3Boolean *is_defined,
                                    fmi3Float64 *next)
{
    Model *m = handle;
    *again = *terminate = *nominals = *states = false;
    if (!m->had_event && m->time >= m->v[MOMENT]) {
        m->had_event = true;
        m->v[YI] += 100.0;
    }
    *is_defined = !m->had_event;
    *next = m->v[MOMENT];
    return fmi3OK;
}
#else
static int width(unsigned reference) { return reference ? 1 : 0; }

#define ACCESS(Name)                                                                                                   \
    fmi2Status fmi2Get##Name(Handle handle, const fmi2ValueReference r[], size_t n, fmi2##Name values[])               \
    { GET(fmi2##Name); }                                                                                               \
    fmi2Status fmi2Set##Name(Handle handle, const fmi2ValueReference r[], size_t n, const fmi2##Name values[])         \
    { SET; }
ACCESS(Real)
ACCESS(Integer)
ACCESS(Boolean)

#pragma GCC diagnostic ignored "-Wunused-parameter"
fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging)
{
    Model *m = calloc(1, sizeof *m);
    m->callbacks = functions;
    m->environment = functions->componentEnvironment;
    m->v[RATE] = m->v[GAIN] = 1.0;
    return m;
}
void fmi2FreeInstance(fmi2Component handle) { free(handle); }
fmi2Status fmi2SetupExperiment(fmi2Component handle, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean has_stop, fmi2Real stop)
{
    ((Model *)handle)->time = start;
    return fmi2OK;
}
fmi2Status fmi2EnterInitializationMode(fmi2Component handle) { return fmi2OK; }
fmi2Status fmi2ExitInitializationMode(fmi2Component handle)
{
    ((Model *)handle)->is_running = true;
    return fmi2OK;
}
fmi2Status fmi2DoStep(fmi2Component handle, fmi2Real time, fmi2Real size, fmi2Boolean no_return)
{
    if (is_due(handle, TERMINATE)) {
        return fmi2Discard;
    }
    return (fmi2Status)advance(handle, time, size);
}
fmi2Status fmi2GetBooleanStatus(fmi2Component handle, const fmi2StatusKind kind, fmi2Boolean *value)
{
    *value = is_due(handle, TERMINATE);
    return fmi2OK;
}
fmi2Status fmi2GetRealStatus(fmi2Component handle, const fmi2StatusKind kind, fmi2Real *value)
{
    *value = ((Model *)handle)->time;
    return fmi2OK;
}
fmi2Status fmi2Terminate(fmi2Component handle) { return fmi2OK; }
#endif
