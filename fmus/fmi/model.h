/* What a model tells the FMI layer: one table of variables and a handful of equations.
 *
 * A model is a folder with config.h (the table, an X-macro) and model.c (the equations). The enumeration, the C table
 * and modelDescription.xml all come from that table. Everything is SI; every value is a double in one block, so that
 * saving a state is one copy. A config.h that defines MODEL_CO_SIMULATION_ONLY makes a model without Model Exchange.
 */
#ifndef MODEL_H
#define MODEL_H

#include <stdbool.h>
#include <stddef.h>

#include "config.h"
#include "size.h" /* generated: COILS, the number of coils at build time */

#define MINIMUM_COILS 1
#define MAXIMUM_COILS 100000

typedef enum {
    ROLE_TIME,       /* the independent variable */
    ROLE_STRUCTURE,  /* structural parameter `coils` (FMI 3.0 only) */
    ROLE_INPUT,
    ROLE_STATE,      /* continuous state that is also an output */
    ROLE_OUTPUT,
    ROLE_DERIVATIVE, /* of the state with the same rank among the states */
    ROLE_PARAMETER,
    ROLE_FLAG,       /* Boolean parameter, kept as 0.0 or 1.0 */
    ROLE_HIDDEN      /* part of the saved state, not described */
} Role;

typedef enum { SCALAR, PER_COIL } Extent;

/* Solids are positive temperatures whose description ends where the material melts; nothing refuses more. */
typedef enum { ANY, NON_NEGATIVE, POSITIVE, SOLID_NITI, SOLID_NYLON } Limit;

typedef struct {
    const char *name;        /* as in modelDescription.xml; elements of FMI 2.0 are `name[1]`, `name[2]`, ... */
    Role role;
    Extent extent;
    const char *unit;
    double start;
    Limit limit;             /* checked when set (inputs, parameters) and when computed (outputs) */
    double nominal;
    const char *depends;     /* names of the inputs and states that it depends on directly, separated by blanks;
                              * `@name`: in Initialization Mode alone */
    const char *description;
} Variable;

/* VARIABLES(V) in config.h lists
 * V(identifier, name, role, extent, unit, start, limit, nominal, depends, description). */
#define V(identifier, ...) VAR_##identifier,
enum { VARIABLES(V) VARIABLE_COUNT };
#undef V

typedef struct {
    size_t coils;
    double *values;                    /* all variables one after the other */
    size_t length;                     /* number of doubles in values */
    size_t offset[VARIABLE_COUNT];     /* where each variable begins in values */
} Model;

/* First value of a variable, inside functions that have a `Model *model`. */
#define ARRAY(identifier) (model->values + model->offset[VAR_##identifier])
#define NUMBER(identifier) (*ARRAY(identifier))

extern const Variable model_variables[VARIABLE_COUNT];

/* Compute states and hidden values from the parameters. False, with the reason in `message`: they contradict. */
bool model_start(Model *model, char *message, size_t size);

/* Compute the outputs from states, inputs and parameters. */
void model_outputs(Model *model);

/* Compute the derivatives of the states. */
void model_derivatives(Model *model);

/* Advance the states by `step` [s] with the inputs constant, and accept the result (Co-Simulation). */
void model_step(Model *model, double step);

/* The states are those of an accepted integrator step: update what remembers the past (Model Exchange). */
void model_accept(Model *model);

#endif
