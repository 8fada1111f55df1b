/* An FMI 2.0 Co-Simulation FMU, dy/dt = u, that misbehaves as it is compiled to:
 *   -DDEED=<function below> -DPLACE=<enumerator below>, in steps from t = 0.05 s on.
 *   -DONCE: refuses a second instance in one process.  -DWITH_GAIN: dy/dt = gain() u, with gain() of a library beside it. */
#include <glob.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fmi2Functions.h"

enum { nowhere, load, instantiate, initialise, step, get, terminate, free_instance };
#ifndef PLACE
#define PLACE nowhere
#define DEED nothing
#endif
#define AT 0.05

typedef struct {
    double u, y;
    fmi2Integer steps;
    const fmi2CallbackFunctions *callbacks;
} Instance;

/* Not static: both FMUs of a test define them. */
int calls_in_this_process = 0;

static volatile double *no_address = (double *)8;
static void nothing(Instance *i) { (void)i; }
static void segfault(Instance *i) { (void)i, *no_address = 1.0; }
static void give_up(Instance *i) { (void)i, printf("state is inconsistent\n"), abort(); }
static void leave(Instance *i) { (void)i, exit(0); }
static void leave_with_code(Instance *i) { (void)i, exit(7); }
static volatile int zero = 0;
static void divide(Instance *i) { i->steps /= zero; }
static void turn_to_nan(Instance *i) { i->y = NAN; }
static void be_killed(Instance *i) { (void)i, kill(getpid(), SIGKILL); }

static void never_return(Instance *i)
{
    for (volatile int k = 0;; k = !k)
        (void)i;
}

/* Memory that is used, without end: the allocation that fails is not checked. */
/* Slow enough for whoever watches the memory to see the last of it on a busy machine. */
static void leak(Instance *i)
{
    for (;;) {
        memset(malloc(1 << 22), ++i->steps & 1 ? 1 : 2, 1 << 22);
        usleep(5000);
    }
}

/* 20 MB more in each step, never touched, and a refusal when there is no more. */
static int is_out_of_memory = 0;
static void hoard(Instance *i) { (void)i, is_out_of_memory = calloc(20 << 20, 1) == NULL; }

static void flood(Instance *i)
{
    (void)i;
    for (int k = 0; k < 20000; k++) {
        printf("line %d of the flood, long enough to fill a pipe soon\n", k);
        fprintf(stderr, "error %d of the flood\n", k);
    }
}

static void flood_and_crash(Instance *i) { flood(i), printf("\033[2Jthe \001last words\n"), segfault(i); }

static void wander(Instance *i) { (void)i, no_address = chdir("/") ? no_address : NULL; }
static void nap(Instance *i) { (void)i, usleep(1000); }

static int count_matches(const char *pattern)
{
    glob_t found;
    int count = glob(pattern, 0, NULL, &found) == 0 ? (int)found.gl_pathc : 0;
    globfree(&found);
    usleep(1000);
    return count;
}

/* Return only when `other` FMUs are in the same function: FAULTY_FOLDER is where they meet. */
static void meet(Instance *i)
{
    char path[4096];
    const char *folder = getenv("FAULTY_FOLDER");
    snprintf(path, sizeof path, "%s/%d_%d", folder, i->steps, (int)getpid());
    fclose(fopen(path, "w"));
    for (int there = 0; there < 2;) {
        snprintf(path, sizeof path, "%s/%d_*", folder, i->steps);
        there = count_matches(path);
    }
}

static void start_helper(Instance *i)
{
    if (fork() == 0) {
        for (;;)
            pause();
    }
    segfault(i);
}

static void at(int place, Instance *i)
{
    if (place == PLACE)
        DEED(i);
}

__attribute__((constructor)) static void when_loaded(void) { at(load, NULL); }

#ifdef WITH_GAIN
extern double gain(void);
#else
static double gain(void) { return 1.0; }
#endif

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *callbacks, fmi2Boolean visible, fmi2Boolean logging)
{
    (void)name, (void)type, (void)guid, (void)resources, (void)visible, (void)logging;
    Instance *i = calloc(1, sizeof *i);
    i->callbacks = callbacks;
    i->u = 1.0;
    at(instantiate, i);
#ifdef ONCE
    if (getenv("FAULTY_IS_LOADED"))
        return free(i), NULL;
    setenv("FAULTY_IS_LOADED", "1", 1);
#endif
    return i;
}

void fmi2FreeInstance(fmi2Component c) { at(free_instance, c), free(c); }
fmi2Status fmi2Terminate(fmi2Component c) { return at(terminate, c), fmi2OK; }
fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return at(initialise, c), fmi2OK; }
fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return (void)c, fmi2OK; }

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real size, fmi2Boolean is_final)
{
    Instance *i = c;
    (void)is_final;
    i->y += gain() * i->u * size;
    i->steps++;
    calls_in_this_process++;
    if (time + size > AT + 1e-9)
        at(step, i);
    if (is_out_of_memory)
        return i->callbacks->logger(i->callbacks->componentEnvironment, "faulty", fmi2Error, "", "no more memory"),
               fmi2Error;
    return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Real value[])
{
    (void)vr;
    if (n)
        ((Instance *)c)->u = value[n - 1];
    return fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Real value[])
{
    Instance *i = c;
    at(get, i);
    for (size_t k = 0; k < n; k++)
        value[k] = vr[k] == 0 ? i->u : i->y;
    return fmi2OK;
}

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Integer value[])
{
    for (size_t k = 0; k < n; k++)
        value[k] = vr[k] == 2 ? ((Instance *)c)->steps : calls_in_this_process;
    return fmi2OK;
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    *state = memcpy(malloc(sizeof(Instance)), c, sizeof(Instance));
    return fmi2OK;
}
fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state)
{
    Instance kept = *(Instance *)c;
    memcpy(c, state, sizeof(Instance));
    ((Instance *)c)->callbacks = kept.callbacks;
    return fmi2OK;
}
fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) { return (void)c, free(*state), *state = NULL, fmi2OK; }
fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate s, size_t *size)
{
    return (void)c, (void)s, *size = sizeof(Instance), fmi2OK;
}
fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate s, fmi2Byte bytes[], size_t size)
{
    return (void)c, memcpy(bytes, s, size), fmi2OK;
}
fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *s)
{
    return (void)c, *s = memcpy(malloc(size), bytes, size), fmi2OK;
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char *fmi2GetVersion(void) { return fmi2Version; }

#include "absent.h"
