/* Executes a plan for many macro-steps without a return to Python. */
#define _POSIX_C_SOURCE 199309L

#include <stdbool.h>
#include <string.h>
#include <time.h>

#include "convert.h"
#include "course.h"
#include "plan.h"
#include "values.h"

typedef int (*AccessFmi2)(void *component, const uint32_t references[], size_t count, void *values);
typedef int (*AccessFmi3)(void *instance, const uint32_t references[], size_t count, void *values, size_t value_count);
typedef int (*StepFmi2)(void *component, double time, double size, int no_restore_before);
typedef int (*StepFmi3)(void *instance, double time, double size, bool no_restore_before, bool *event, bool *terminate,
                        bool *early, double *reached);

enum { STATUS_WARNING = 1, LONGEST_STRIDE = 64 };

/* Wall time between two looks at the clock, where the macro-steps are short enough [s]. */
static const double LOOK = 1e-3;

/* What is practically the same instant, as in cosim/fmu/co_simulation.py [s]. */
static const double INSTANT = 0.1 / 1e9;

static double now(void)
{
    struct timespec moment;
    clock_gettime(CLOCK_MONOTONIC, &moment);
    return (double)moment.tv_sec + 1e-9 * (double)moment.tv_nsec;
}

static inline int access_fmi2(const Operation *o)
{
    return ((AccessFmi2)o->function)(o->component, o->references, o->reference_count, o->target);
}

static inline int access_fmi3(const Operation *o)
{
    return ((AccessFmi3)o->function)(o->component, o->references, o->reference_count, o->target, o->count);
}

static inline int write_checked(const Operation *o, Cursor *cursor, bool is_fmi2)
{
    if (are_equal(o->source, o->held, o->source_type, o->count, o->held_bytes)) {
        return REACHED;
    }
    cursor->element = first_not_finite(o->source, o->source_type, o->count);
    if (cursor->element >= 0) {
        return NOT_FINITE;
    }
    if (o->source != o->target) {
        convert(o);
    }
    cursor->status = is_fmi2 ? access_fmi2(o) : access_fmi3(o);
    if (cursor->status > STATUS_WARNING) {
        return REFUSED;
    }
    memcpy(o->held, o->source, o->held_bytes);
    return REACHED;
}

static inline int read_checked(const Operation *operation, Cursor *cursor, bool is_fmi2)
{
    cursor->status = is_fmi2 ? access_fmi2(operation) : access_fmi3(operation);
    if (cursor->status > STATUS_WARNING) {
        return REFUSED;
    }
    cursor->element = first_not_finite(operation->target, operation->target_type, operation->count);
    return cursor->element >= 0 ? NOT_FINITE : REACHED;
}

/* A macro-step in nanoseconds and in seconds, its ends and its length each rounded on their own, as in cosim/unit/protocol.py:
 * the FMU gets 0.001 for a millisecond, not end - begin. */
typedef struct {
    int64_t time, size;
    double begin, end, length;
} Step;

static Step step_at(const Plan *plan, int64_t index)
{
    const int64_t time = plan->start + index * plan->size;
    return (Step){time, plan->size, (double)time / 1e9, (double)(time + plan->size) / 1e9, (double)plan->size / 1e9};
}

static inline bool meets_event(const Operation *o, double end)
{
    return o->due && *o->due <= end + INSTANT;
}

static inline int step_fmi2(const Operation *o, Cursor *cursor, const Step *step)
{
    if (meets_event(o, step->end)) {
        return CALLED;
    }
    cursor->status = ((StepFmi2)o->function)(o->component, step->begin, step->length, 1);
    return cursor->status > STATUS_WARNING ? REFUSED : REACHED;
}

static inline int step_fmi3(const Operation *o, Cursor *cursor, const Step *step)
{
    if (meets_event(o, step->end)) {
        return CALLED;
    }
    bool *const event = o->flags[0], *const terminate = o->flags[1], *const early = o->flags[2];
    const StepFmi3 function = (StepFmi3)o->function;
    cursor->status = function(o->component, step->begin, step->length, true, event, terminate, early, o->reached);
    if (cursor->status > STATUS_WARNING) {
        return REFUSED;
    }
    return *event || *terminate || *early ? FLAGGED : REACHED;
}

static inline int carry_out(const Operation *o, Cursor *cursor, const Step *step)
{
    switch (o->code) {
    case COPY_DOUBLE: *(double *)o->target = *(const double *)o->source; return REACHED;
    case COPY_BYTES: memcpy(o->target, o->source, o->count); return REACHED;
    case CONVERT: convert(o); return REACHED;
    case WRITE_FMI2: return write_checked(o, cursor, true);
    case WRITE_FMI3: return write_checked(o, cursor, false);
    case READ_FMI2: return read_checked(o, cursor, true);
    case READ_FMI3: return read_checked(o, cursor, false);
    case STEP_FMI2: return step_fmi2(o, cursor, step);
    case STEP_FMI3: return step_fmi3(o, cursor, step);
    case COURSE_HELD: course_held(o, step->time); return REACHED;
    case COURSE_LINEAR: course_linear(o, (double)step->time + 0.5 * (double)step->size); return REACHED;
    default: return CALLED;
    }
}

/* Operations `cursor->operation` to `end` of one macro-step. */
static int finish_step(const Plan *plan, Cursor *cursor, size_t end)
{
    const Step step = step_at(plan, cursor->index);
    for (size_t i = (size_t)cursor->operation; i < end; ++i) {
        const int code = carry_out(plan->operations + i, cursor, &step);
        if (code != REACHED) {
            cursor->operation = (int64_t)i;
            return code;
        }
    }
    return REACHED;
}

/* The same, with the wall time of every operation added to its unit's sample. */
static int finish_step_timed(const Plan *plan, Cursor *cursor, size_t end)
{
    const Step step = step_at(plan, cursor->index);
    double begin = now();
    for (size_t i = (size_t)cursor->operation; i < end; ++i) {
        const Operation *o = plan->operations + i;
        const int code = carry_out(o, cursor, &step);
        if (code != REACHED || i + 1 == end || o[1].unit != o->unit) {
            const double then = now();
            plan->sample[o->unit] += then - begin;
            begin = then;
        }
        if (code != REACHED) {
            cursor->operation = (int64_t)i;
            return code;
        }
    }
    return REACHED;
}

static void record(const Plan *plan, int64_t row)
{
    for (size_t i = 0; i < plan->recording_count; ++i) {
        const Recording *r = plan->recordings + i;
        if (r->bytes == sizeof(double)) {
            ((double *)r->rows)[row] = *(const double *)r->source;
        } else {
            memcpy(r->rows + (size_t)row * r->bytes, r->source, r->bytes);
        }
    }
}

/* Spread the wall time of a call over the units as the timed steps found it. */
static void share_out(const Plan *plan, double elapsed)
{
    double sum = 0.0;
    for (size_t i = 0; i <= plan->units; ++i) {
        sum += plan->sample[i];
    }
    for (size_t i = 0; i <= plan->units; ++i) {
        plan->wall_time[i] += sum > 0.0 ? elapsed * plan->sample[i] / sum : 0.0;
        plan->sample[i] = 0.0;
    }
}

/* Macro-steps until the next look at the clock: one while a step takes longer than LOOK, at most LONGEST_STRIDE. */
static int64_t stride_for(double per_step)
{
    return per_step * LONGEST_STRIDE < LOOK ? LONGEST_STRIDE : per_step >= LOOK ? 1 : (int64_t)(LOOK / per_step);
}

EXPORT int32_t cosim_layout_version(void)
{
    return LAYOUT_VERSION;
}

/* Advance to the macro-step `stop`, or for about `budget` seconds of wall time.
 *
 * The cursor says where to begin, inside a step too, and where it ended. One step of every stride is timed.
 */
EXPORT int32_t cosim_advance(const Plan *plan, Cursor *cursor, int64_t stop, double budget)
{
    const double begin = now();
    int64_t until_timed = 0, stride = 1, until_record = 0;
    double last_look = begin;
    int code = REACHED;
    if (plan->per_record > 0) {
        until_record = plan->per_record - cursor->index % plan->per_record;
    }
    while (cursor->index < stop) {
        const size_t end = until_record == 1 ? plan->operation_count : plan->step_count;
        code = until_timed == 0 ? finish_step_timed(plan, cursor, end) : finish_step(plan, cursor, end);
        if (code != REACHED) {
            break;
        }
        cursor->operation = 0;
        cursor->index += 1;
        if (--until_record == 0) {
            record(plan, cursor->index / plan->per_record);
            until_record = plan->per_record;
        }
        if (until_timed-- == 0) {
            const double look = now();
            stride = stride_for((look - last_look) / (double)stride);
            last_look = look;
            until_timed = stride - 1;
            if (look - begin >= budget && cursor->index < stop) {
                code = PAUSED;
                break;
            }
        }
    }
    share_out(plan, now() - begin);
    return code;
}
