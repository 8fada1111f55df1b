/* The least that a master can do: FMI 2.0 calls through function pointers, wires as flat tables, time as index times step.
 *
 * Usage: c_floor SPEC STEPS STEP. Lines of SPEC:
 *   fmu LIBRARY TOKEN | start FMU REFERENCE VALUE | wire FMU REFERENCE FMU REFERENCE | out FMU REFERENCE
 */
#define _POSIX_C_SOURCE 200809L
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "fmi2Functions.h"

enum { MOST = 64 };
typedef struct {
    fmi2Component component;
    fmi2GetRealTYPE *get;
    fmi2SetRealTYPE *set;
    fmi2DoStepTYPE *step;
    fmi2EnterInitializationModeTYPE *enter;
    fmi2ExitInitializationModeTYPE *leave;
} Fmu;
typedef struct {
    int source, target;
    fmi2ValueReference output, input;
} Wire;

static Fmu fmus[MOST];
static Wire wires[MOST];
static double values[MOST];
static int fmu_count, wire_count;
static int out_fmu[MOST], out_count;
static fmi2ValueReference out_reference[MOST];

static void quiet(fmi2ComponentEnvironment e, fmi2String n, fmi2Status s, fmi2String c, fmi2String m, ...)
{
    (void)e, (void)c;
    fprintf(stderr, "%s: status %d: %s\n", n, s, m);
}

static void check(fmi2Status status)
{
    if (status > fmi2Warning) {
        fprintf(stderr, "an FMU refused a call\n");
        exit(1);
    }
}

static void *function(void *library, const char *name)
{
    void *found = dlsym(library, name);
    if (!found) {
        fprintf(stderr, "%s: %s\n", name, dlerror());
        exit(1);
    }
    return found;
}

static void open_fmu(const char *path, const char *token)
{
    static fmi2CallbackFunctions callbacks = {quiet, calloc, free, NULL, NULL};
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        exit(1);
    }
    Fmu *fmu = &fmus[fmu_count++];
    *(void **)&fmu->get = function(library, "fmi2GetReal");
    *(void **)&fmu->set = function(library, "fmi2SetReal");
    *(void **)&fmu->step = function(library, "fmi2DoStep");
    *(void **)&fmu->enter = function(library, "fmi2EnterInitializationMode");
    *(void **)&fmu->leave = function(library, "fmi2ExitInitializationMode");
    fmi2InstantiateTYPE *instantiate;
    fmi2SetupExperimentTYPE *setup;
    *(void **)&instantiate = function(library, "fmi2Instantiate");
    *(void **)&setup = function(library, "fmi2SetupExperiment");
    fmu->component = instantiate("fmu", fmi2CoSimulation, token, "file:///", &callbacks, fmi2False, fmi2False);
    check(fmu->component ? setup(fmu->component, fmi2False, 0, 0, fmi2False, 0) : fmi2Error);
    check(fmu->enter(fmu->component));
}

static void exchange(void)
{
    for (int i = 0; i < wire_count; i++)
        check(fmus[wires[i].source].get(fmus[wires[i].source].component, &wires[i].output, 1, &values[i]));
    for (int i = 0; i < wire_count; i++)
        check(fmus[wires[i].target].set(fmus[wires[i].target].component, &wires[i].input, 1, &values[i]));
}

static void read_spec(const char *path)
{
    char line[4096], library[2048], token[256];
    int a, b;
    unsigned r, s;
    double value;
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file)) {
        if (sscanf(line, "fmu %2047s %255s", library, token) == 2) {
            open_fmu(library, token);
        } else if (sscanf(line, "start %d %u %lf", &a, &r, &value) == 3) {
            check(fmus[a].set(fmus[a].component, &r, 1, &value));
        } else if (sscanf(line, "wire %d %u %d %u", &a, &r, &b, &s) == 4) {
            wires[wire_count++] = (Wire){a, b, r, s};
        } else if (sscanf(line, "out %d %u", &a, &r) == 2) {
            out_fmu[out_count] = a;
            out_reference[out_count++] = r;
        }
    }
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

int main(int argc, char **argv)
{
    if (argc != 4)
        return 2;
    const long steps = atol(argv[2]);
    const double step = atof(argv[3]);
    read_spec(argv[1]);
    for (int pass = 0; pass < 3; pass++) /* chains of direct feedthrough settle */
        exchange();
    for (int i = 0; i < fmu_count; i++)
        check(fmus[i].leave(fmus[i].component));
    const double begin = now();
    for (long k = 0; k < steps; k++) {
        for (int i = 0; i < fmu_count; i++)
            check(fmus[i].step(fmus[i].component, k * step, step, fmi2True));
        exchange();
    }
    printf("%.9g", now() - begin);
    for (int i = 0; i < out_count; i++) {
        double value;
        check(fmus[out_fmu[i]].get(fmus[out_fmu[i]].component, &out_reference[i], 1, &value));
        printf(" %.17g", value);
    }
    printf("\n");
    return 0;
}
