/* What one call is given (mirrored field by field in plan.py) and what one step works on.
 *
 * Arrays over the coils are `width` long: the number of coils rounded up to whole vectors; the surplus repeats the last
 * coil and is never reported. FIELD numbers and QUANTITY numbers are generated from layout.py.
 */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    int64_t coils, width, strings, sources, steps, is_midpoint, pairs, contacts, has_circuit;
    const int64_t *first;        /* first coil of every string, then the number of coils */
    const int64_t *pair_a, *pair_b, *contact_a, *contact_b;
    const double *time;          /* steps + 1 */
    const int8_t *is_switch;     /* steps: an input jumps at the begin of this step */
    const double *voltage;       /* steps x sources */
    const double *ambient;       /* steps */
    const double *power;         /* steps x width, or NULL: from the circuit */
    const double *given;         /* temperature, steps + 1 x width, or NULL: from the heat balance */
    const int64_t *samples;      /* per quantity; 0: not recorded */
    const double *const *sample_time;
    const int64_t *out_offset;   /* of every quantity in a set's output */
    const int64_t *term_offset;  /* of every term's first array in a set's parameters; -1: switched off */
    const double *const *traces; /* per quantity: rows at the ends of steps, read in place of a simulation; or NULL */
} Plan;

/* Where the branches of each coil cross, and the 8 numbers of their shapes. */
typedef struct {
    double *crossing, *shape;
} Crossings;

typedef struct {
    const Plan *plan;
    int64_t width, coils, strings, sources, row; /* row: number of the step */
    double t, t_begin, t_end, dt, dt_middle; /* t: instant that a hook's values belong to; dt_middle: 0 or dt / 2 */
    const double *coil, *string, *source, *late, *slow, *wrong; /* parameters; the last three: clock offset, lag and gain error of every quantity */
    const double *set;                       /* parameters of the whole set */
    double *temperature, *before, *middle, *mean, *felt, *rate, *slope, *energy; /* rate: mean over the step; slope: at its end */
    double *resistance, *current, *voltage, *power, *heat, *conductance, *capacity, *ambient;
    double *shift, *scale, *fraction, *added, *heating, *cooling, *heating_before, *cooling_before, *crossing;
    double *remembered, *phase, *stiffness, *tension, *rest, *extension, *extension_before, *length;
    double *string_resistance, *string_current, *source_voltage, *supply_voltage, *supply_resistance, *current_limit, *limited;
    double *string_voltage, *terminal_voltage, *supply_power, *supply_current; /* of strings, but for the last two */
    double *state, *state_rate;
    Crossings *known; /* of the set before; NULL: none, as in an amended FMU, which has arrays for every double alone */
} Step;

/* Recorded values of one channel on their way through its sensor. */
typedef struct {
    const double *set;
    int64_t channel, samples, partner;
    double offset, lag, share;
    const double *time;
    double *value;
    double *current; /* in the coil that the channel reads; NULL: no term asks for it, or the channel is of no coil */
} Sensor;

#define COIL(name) (s->coil + (int64_t)FIELD_##name * s->width)
#define STRING(name) (s->string + (int64_t)FIELD_##name * s->strings)
#define SOURCE(name) (s->source + (int64_t)FIELD_##name * s->sources)
#define CELSIUS 273.15

static inline double least(double a, double b) { return a < b ? a : b; }
static inline double most(double a, double b) { return a > b ? a : b; }
static inline double clip(double x, double low, double high) { return least(most(x, low), high); }

/* Equation (2) of the paper: k = a exp(-b exp(-c T)) + d, T in degrees Celsius. */
static inline double gompertz(double a, double b, double c, double d, double celsius)
{
    return a * network_exp(-b * network_exp(-c * celsius)) + d;
}

/* Share of the step that lies after an instant: continuous, so that an instant can be fitted. */
static inline double share_after(double instant, double begin, double end)
{
    const double size = end - begin;
    return clip((end - instant) / (size > 0.0 ? size : 1e-12), 0.0, 1.0);
}

/* x / (1 + |x|): odd, slope 1 at 0, tends to +-1. */
static inline double saturate(double x) { return x / (1.0 + fabs(x)); }

/* How the heat of a step goes from coil to coil: half of it before the coils' own balance and half after it, the pairs
 * one after the other and then the other way round (G. Strang, SIAM J. Numer. Anal. 5 (1968) 506-517). Each pair's own
 * exchange is exact, so that it is stable at any strength and no heat is lost. */
enum { FORWARDS, BACKWARDS, AT_END };

static inline void exchange_heat(Step *s, int64_t a, int64_t b, double exchange, int turn)
{
    const double c_a = s->capacity[a], c_b = s->capacity[b], gap = s->temperature[a] - s->temperature[b];
    if (turn == AT_END) {
        s->slope[a] -= exchange * gap / c_a;
        s->slope[b] += exchange * gap / c_b;
        return;
    }
    const double half = 0.5 * s->dt * exchange, exponent = half / c_a + half / c_b;
    const double moved = half * gap * network_relaxation(exponent); /* [J] */
    s->temperature[a] -= moved / c_a;
    s->temperature[b] += moved / c_b;
}

/* Used by the generated hooks. */
#define COIL_LOOP _Pragma("GCC ivdep") for (int64_t i = 0; i < s->width; i++)
#define ON(term) (s->plan->term_offset[term] >= 0)
#define VALUES(term) (s->set + s->plan->term_offset[term])
#define CHANNELS quantity_channel(s, QUANTITIES)
