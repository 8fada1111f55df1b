/* Derivatives of the network's outputs to those of residuals, in one pass over memory. */

#include <stdint.h>

/* out[into[r]] += factor[r] * (w - share sum(w)) for every row r and series, where w = -weight * slopes[r][pick].
 * Samples of weight 0 stay 0. slopes: (rows, stride); out: (any, begin[series]). */
void whiten_slopes(int64_t rows, int64_t stride, const double *slopes, int64_t series, const int64_t *begin,
                   const int64_t *pick, const double *weight, const double *share, const int64_t *into,
                   const double *factor, double *work, float *out)
{
    const int64_t samples = begin[series];
    for (int64_t r = 0; r < rows; r++) {
        const double *row = slopes + r * stride;
        float *target = out + into[r] * samples;
        for (int64_t n = 0; n < series; n++) {
            double sum = 0.0, size = 0.0;
            for (int64_t k = begin[n]; k < begin[n + 1]; k++) {
                work[k] = -factor[r] * weight[k] * row[pick[k]];
                sum += work[k];
                size += work[k] * work[k];
            }
            if (size == 0.0) { /* most coils do not feel what is varied at another */
                continue;
            }
            const double mean = share[n] * sum;
            for (int64_t k = begin[n]; k < begin[n + 1]; k++) {
                target[k] += (float)(weight[k] > 0.0 ? work[k] - mean : work[k]);
            }
        }
    }
}
