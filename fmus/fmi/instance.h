/* One instance of a model and its life cycle, in terms common to FMI 2.0 and FMI 3.0.
 *
 * Every function that can be refused returns a Status; its numbers are those of fmi2Status and fmi3Status. A call that
 * is refused changes nothing, so that the importer may go on; only a step that fails leaves the instance in
 * MODE_FAILED.
 */
#ifndef INSTANCE_H
#define INSTANCE_H

#include <stdint.h>

#include "variables.h"

typedef enum { STATUS_OK = 0, STATUS_ERROR = 3 } Status;

/* Bits, so that a function can name all the modes that allow it. */
typedef enum {
    MODE_INSTANTIATED = 1,
    MODE_CONFIGURATION = 2,
    MODE_INITIALISATION = 4,
    MODE_EVENT = 8,       /* Model Exchange */
    MODE_CONTINUOUS = 16, /* Model Exchange */
    MODE_STEP = 32,       /* Co-Simulation */
    MODE_TERMINATED = 64,
    MODE_FAILED = 128
} Mode;

#define MODES_RUNNING (MODE_EVENT | MODE_CONTINUOUS | MODE_STEP)
#define MODES_READABLE (MODE_INITIALISATION | MODES_RUNNING | MODE_TERMINATED)
#define MODES_ALL 255

typedef enum { CO_SIMULATION = 1, MODEL_EXCHANGE = 2 } Interface;

/* Hands an error message to the importer; `importer` is what the version's own layer keeps of it. */
typedef void (*LogFunction)(void *importer, const char *message);

typedef struct {
    Model model;
    Interface interface;
    Mode mode;
    double stop_time;   /* infinite if not given */
    bool is_stale;      /* outputs are older than what they depend on */
    int fmi_version;
    LogFunction log;
    void *importer;     /* freed with the instance */
} Instance;

typedef struct Snapshot Snapshot;

/* Takes ownership of `importer` (from malloc), also when it fails. NULL: out of memory, or the token is another's. */
Instance *instance_create(int fmi_version, Interface interface, const char *token, LogFunction log, void *importer);
void instance_free(Instance *instance);

/* Log a message and return STATUS_ERROR. */
Status instance_refuse(Instance *instance, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 2, 3)))
#endif
    ;

/* Refuse `function` unless the mode is one of `modes`. */
Status instance_require(Instance *instance, const char *function, int modes);

/* Back to the state after instantiation. */
Status instance_reset(Instance *instance);

/* Change the number of coils; every value returns to its start value. */
Status instance_resize(Instance *instance, double coils);

/* Copy all values of variable `index` from or to element `first`, `count` values. */
Status instance_get(Instance *instance, size_t index, size_t first, size_t count, double *values);
Status instance_set(Instance *instance, size_t index, size_t first, size_t count, const double *values);

Status instance_set_experiment(Instance *instance, const char *function, double start_time, double stop_time);
Status instance_enter_initialisation(Instance *instance, const char *function);
Status instance_exit_initialisation(Instance *instance, const char *function);
Status instance_step(Instance *instance, const char *function, double time, double step);

/* Continuous states and derivatives, in the order of the table. */
size_t instance_state_count(const Instance *instance);
Status instance_get_states(Instance *instance, const char *function, double *states, size_t count);
Status instance_set_states(Instance *instance, const char *function, const double *states, size_t count);
Status instance_get_derivatives(Instance *instance, const char *function, double *derivatives, size_t count);
Status instance_get_nominals(Instance *instance, const char *function, double *nominals, size_t count);
Status instance_set_time(Instance *instance, const char *function, double time);

/* The memory of the model follows the accepted states. */
Status instance_accept(Instance *instance, const char *function, int modes, Mode next);

/* Saved states are self-contained blocks of bytes. */
Status snapshot_take(Instance *instance, Snapshot **snapshot);
Status snapshot_restore(Instance *instance, const Snapshot *snapshot);
size_t snapshot_size(const Snapshot *snapshot);
Status snapshot_read(Instance *instance, const void *bytes, size_t size, Snapshot **snapshot);

#endif
