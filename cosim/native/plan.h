/* A plan: what one macro-step does, as a flat list of operations on the buffers of the units.
 *
 * cosim/native/layout.py declares the same structures for ctypes; LAYOUT_VERSION changes with them,
 * and with what is done.
 */
#ifndef COSIM_NATIVE_PLAN_H
#define COSIM_NATIVE_PLAN_H

#include <stddef.h>
#include <stdint.h>

#define LAYOUT_VERSION 4

#if defined(_WIN32)
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

/* What an operation does. */
enum {
    COPY_DOUBLE,   /* one Float64, as it is */
    COPY_BYTES,    /* `count` bytes */
    CONVERT,       /* `count` elements: from source_type to target_type, times factor plus offset */
    WRITE_FMI2,    /* fmi2SetReal and its kin, where a value differs from the one held, after the check of the values */
    WRITE_FMI3,    /* fmi3SetFloat64 and its kin */
    READ_FMI2,     /* fmi2GetReal and its kin, before the check of the values */
    READ_FMI3,     /* fmi3GetFloat64 and its kin */
    STEP_FMI2,     /* fmi2DoStep */
    STEP_FMI3,     /* fmi3DoStep */
    COURSE_HELD,   /* a programme whose values hold from each point to the next */
    COURSE_LINEAR, /* a programme interpolated between its points, at the middle of the step */
    PYTHON         /* what only Python can do: the call returns, and is made again for what follows */
};

/* Element types, in the order of cosim/native/layout.py. */
enum { FLOAT64, FLOAT32, INT8, UINT8, INT16, UINT16, INT32, UINT32, INT64, UINT64, BOOLEAN };

/* Why cosim_advance came back. */
enum {
    REACHED,    /* the index asked for */
    PAUSED,     /* its share of wall time is used up: signals and progress have their turn */
    REFUSED,    /* a call returned Discard, Error or worse; see Cursor.status */
    NOT_FINITE, /* a value is NaN or infinite; see Cursor.element */
    FLAGGED,    /* fmi3DoStep returned early, or wants event handling or the end of the simulation */
    CALLED      /* a PYTHON operation is next, or a step that meets an event */
};

typedef struct {
    int32_t code;
    int32_t unit;       /* whose wall time it counts for; `units` of the plan for none */
    int32_t source_type;
    int32_t target_type; /* for READ too: floating-point values are checked */
    void (*function)(void);
    void *component;
    const uint32_t *references;
    size_t reference_count;
    void *target; /* what the FMU sees of READ and WRITE */
    const void *source; /* WRITE: new values; converted to `target` where their type differs from C's */
    void *held;         /* WRITE: the values that the FMU has */
    size_t held_bytes;
    size_t count;       /* elements (COPY_BYTES: bytes) */
    size_t source_step; /* 0: one source element fills the target */
    double factor;
    double offset;
    const int64_t *points; /* times of a course [ns] */
    size_t point_count;
    void *flags[3]; /* fmi3DoStep: event handling needed, terminate simulation, early return */
    double *reached;
    const double *due; /* DoStep: time of the FMU's next time event [s]; a step that meets it belongs to Python */
} Operation;

/* One recorded variable: `source` is copied to row after row of `rows`. */
typedef struct {
    const void *source;
    char *rows;
    size_t bytes;
} Recording;

typedef struct {
    const Operation *operations;
    size_t step_count;      /* operations of every macro-step; those after them come before a recording only */
    size_t operation_count;
    const Recording *recordings;
    size_t recording_count;
    int64_t per_record; /* macro-steps from one recorded row to the next; 0: none */
    int64_t start;      /* [ns] */
    int64_t size;       /* [ns] */
    double *wall_time; /* [s] of every unit, and of everything else, shape (units + 1,) */
    double *sample;    /* working memory of the same shape */
    size_t units;
} Plan;

typedef struct {
    int64_t index;     /* macro-steps completed */
    int64_t operation; /* next operation of the step `index`; on REFUSED, NOT_FINITE, FLAGGED, CALLED that one */
    int64_t element;
    int32_t status;
    int32_t reserved;
} Cursor;

#endif
