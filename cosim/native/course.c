#include "course.h"

#include <string.h>

/* Index of the last point whose time is not after `time`; -1 before the first. */
static ptrdiff_t last_point(const Operation *course, double time)
{
    size_t low = 0, high = course->point_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if ((double)course->points[middle] <= time) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return (ptrdiff_t)low - 1;
}

void course_held(const Operation *course, int64_t time)
{
    const ptrdiff_t point = last_point(course, (double)time);
    const double *values = (const double *)course->source + (point < 0 ? 0 : (size_t)point * course->count);
    memcpy(course->target, values, course->count * sizeof *values);
}

/* The formula of numpy.interp, in its order of operations, since both loops must give the same bits. */
void course_linear(const Operation *course, double time)
{
    const ptrdiff_t point = last_point(course, time);
    const size_t count = course->count, last = course->point_count - 1;
    const double *left = (const double *)course->source + (point < 0 ? 0 : (size_t)point * count);
    double *target = course->target;
    const double begin = (double)course->points[point < 0 ? 0 : point];
    if (point < 0 || (size_t)point == last || begin == time) {
        memcpy(target, left, count * sizeof *left);
        return;
    }
    const double *right = left + count;
    const double width = (double)course->points[point + 1] - begin;
    for (size_t i = 0; i < count; ++i) {
        const double slope = (right[i] - left[i]) / width;
        target[i] = slope * (time - begin) + left[i];
    }
}
