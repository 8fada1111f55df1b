#include <float.h>
#include <math.h>
#include <string.h>

#include "model.h"

enum { LARGEST = 8 };

static double largest_row_sum(int n, const double A[])
{
    double largest = 0.0;
    for (int i = 0; i < n; i++) {
        double sum = 0.0;
        for (int j = 0; j < n; j++)
            sum += fabs(A[i * n + j]);
        largest = fmax(largest, sum);
    }
    return largest;
}

void linear_step(int n, const double A[], double size, double x[])
{
    /* Pieces with |A| size <= 1: the series then needs at most 20 terms and loses no digits to cancellation. */
    const double pieces = ceil(fmax(1.0, largest_row_sum(n, A) * size));
    const double h = size / pieces;
    for (double piece = 0; piece < pieces; piece++) {
        double term[LARGEST], next[LARGEST];
        memcpy(term, x, (size_t)n * sizeof *x);
        for (int k = 1; k <= 20; k++) {
            double change = 0.0, whole = 0.0;
            for (int i = 0; i < n; i++) {
                next[i] = 0.0;
                for (int j = 0; j < n; j++)
                    next[i] += A[i * n + j] * term[j];
                next[i] *= h / k;
                x[i] += next[i];
                change += fabs(next[i]);
                whole += fabs(x[i]);
            }
            memcpy(term, next, (size_t)n * sizeof *term);
            if (change <= 1e-2 * DBL_EPSILON * whole)
                break;
        }
    }
}
