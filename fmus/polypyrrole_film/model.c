/* Polypyrrole film actuators. Equations, sources and choices: README.md.
 *
 * A film of thickness 2 l takes up ions from both faces. Half of it is cut into LAYERS slabs, each a capacitor; the ions
 * diffuse from slab to slab as a current would through resistors:
 *
 *     voltage -- series resistance -- r/2 -- [1] -- r -- [2] -- r -- [3] -- r -- [4] -- r -- [5]
 */
#include <math.h>

#include "model.h"

enum { LAYERS = 5 };

#define LARGEST_EXPONENT 0.5    /* of a sub-step of the series [1] */
#define SERIES_TERMS 16         /* 0.5^16 / 16! = 7e-19 is below rounding */

/* Capacitance of one layer of all films of an actuator [F]. */
static double layer_capacitance(const Model *model)
{
    return NUMBER(volumetric_capacitance) * NUMBER(film_section) * NUMBER(film_length) / LAYERS;
}

/* What diffusion from layer to layer is as a resistance [ohm]: r c = (l / LAYERS)^2 / D. */
static double layer_resistance(const Model *model)
{
    const double layer = 0.5 * NUMBER(film_thickness) / LAYERS;
    return layer * layer / (NUMBER(diffusion_coefficient) * layer_capacitance(model));
}

/* Resistance [ohm] between the terminals of actuator i and the middle of its first layer. */
static double entry_resistance(const Model *model, size_t i)
{
    return ARRAY(reference_resistance)[i] + 0.5 * layer_resistance(model);
}

/* The first layer of actuator i is `charge[0]`, the next one `charge[stride]`, and so on: they follow each other in the
 * table. */
static double *layers(Model *model, size_t i)
{
    return ARRAY(charge_1) + i;
}

/* Rates of change [1/s] of `charge` (the values) where `charge` is counted from equilibrium at zero voltage. */
static void flow(const double *charge, double entry_rate, double layer_rate, double *rate)
{
    double in = -entry_rate * charge[0];
    for (int j = 0; j < LAYERS; j++) {
        const double on = j + 1 < LAYERS ? layer_rate * (charge[j] - charge[j + 1]) : 0.0;
        rate[j] = in - on;
        in = on;
    }
}

bool model_start(Model *model, char *message, size_t size)
{
    (void)message;
    (void)size;
    const double capacitance = layer_capacitance(model);
    for (size_t i = 0; i < model->coils; i++) {
        for (int j = 0; j < LAYERS; j++) {
            layers(model, i)[j * model->coils] = capacitance * ARRAY(initial_voltage)[i];
        }
        ARRAY(convected_energy)[i] = 0.0;
    }
    return true;
}

/* Electrical energy stored by actuator i [J], beyond that of the start: its layers then had all one charge. */
static double stored(Model *model, size_t i)
{
    const double first = layer_capacitance(model) * ARRAY(initial_voltage)[i];
    double sum = -LAYERS * first * first;
    for (int j = 0; j < LAYERS; j++) {
        const double charge = layers(model, i)[j * model->coils];
        sum += charge * charge;
    }
    return 0.5 * sum / layer_capacitance(model);
}

void model_outputs(Model *model)
{
    const double lever = NUMBER(lever_ratio), capacitance = layer_capacitance(model);
    const double stiffness =
        NUMBER(youngs_modulus) * NUMBER(film_section) / (NUMBER(film_length) * lever * lever);
    const double stroke_per_charge = lever * NUMBER(strain_to_charge) / NUMBER(film_section);
    for (size_t i = 0; i < model->coils; i++) {
        double charge = 0.0;
        for (int j = 0; j < LAYERS; j++) {
            charge += layers(model, i)[j * model->coils];
        }
        ARRAY(temperature)[i] = NUMBER(ambient_temperature);
        ARRAY(stiffness)[i] = stiffness;
        ARRAY(rest_length)[i] = NUMBER(coil_rest_length) - stroke_per_charge * charge;
        /* The shunt takes what the films do not, so that strings share their voltage evenly (README.md). */
        ARRAY(resistance)[i] = ARRAY(reference_resistance)[i];
        ARRAY(stored_energy)[i] = stored(model, i);
        ARRAY(film_current)[i] =
            (ARRAY(voltage)[i] - layers(model, i)[0] / capacitance) / entry_resistance(model, i);
    }
}

void model_derivatives(Model *model)
{
    const double capacitance = layer_capacitance(model);
    const double layer_rate = 1.0 / (layer_resistance(model) * capacitance);
    for (size_t i = 0; i < model->coils; i++) {
        const double entry_rate = 1.0 / (entry_resistance(model, i) * capacitance), voltage = ARRAY(voltage)[i];
        double charge[LAYERS], rate[LAYERS], gain = 0.0;
        for (int j = 0; j < LAYERS; j++) {
            charge[j] = layers(model, i)[j * model->coils] - capacitance * voltage;
        }
        flow(charge, entry_rate, layer_rate, rate);
        for (int j = 0; j < LAYERS; j++) {
            ARRAY(der_charge_1)[i + j * model->coils] = rate[j];
            gain += layers(model, i)[j * model->coils] / capacitance * rate[j];
        }
        ARRAY(der_convected_energy)[i] = voltage * voltage / ARRAY(reference_resistance)[i] - gain;
    }
}

/* `charge` (counted from equilibrium) a time `step` [s] later: the series of the matrix exponential, in sub-steps short
 * enough for it to converge to rounding. */
static void relax(double *charge, double entry_rate, double layer_rate, double step)
{
    const double largest = fmax(entry_rate + 2.0 * layer_rate, 4.0 * layer_rate);
    const double count = fmax(1.0, ceil(largest * step / LARGEST_EXPONENT)), size = step / count;
    for (double k = 0.0; k < count; k += 1.0) {
        double term[LAYERS], rate[LAYERS];
        for (int j = 0; j < LAYERS; j++) {
            term[j] = charge[j];
        }
        for (int order = 1; order <= SERIES_TERMS; order++) {
            flow(term, entry_rate, layer_rate, rate);
            for (int j = 0; j < LAYERS; j++) {
                term[j] = size / order * rate[j];
                charge[j] += term[j];
            }
        }
    }
}

/* Exact for constant inputs. What the circuit gave and the films do not store has left as heat. */
void model_step(Model *model, double step)
{
    const double capacitance = layer_capacitance(model);
    const double layer_rate = 1.0 / (layer_resistance(model) * capacitance);
    for (size_t i = 0; i < model->coils; i++) {
        const double voltage = ARRAY(voltage)[i], before = stored(model, i);
        double charge[LAYERS];
        for (int j = 0; j < LAYERS; j++) {
            charge[j] = layers(model, i)[j * model->coils] - capacitance * voltage;
        }
        relax(charge, 1.0 / (entry_resistance(model, i) * capacitance), layer_rate, step);
        for (int j = 0; j < LAYERS; j++) {
            layers(model, i)[j * model->coils] = charge[j] + capacitance * voltage;
        }
        const double supplied = voltage * voltage / ARRAY(reference_resistance)[i] * step;
        ARRAY(convected_energy)[i] += supplied - (stored(model, i) - before);
    }
}

void model_accept(Model *model)
{
    (void)model; /* nothing remembers the past but the charges */
}
