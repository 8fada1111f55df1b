/* The coils of the network as the model of an FMU: heat, added states, stiffness. The circuit and the load are other units.
 *
 * A step is that of the network with everything taken at its begin (is_midpoint = 0), so that the model that was fitted is
 * the model that runs. Generated before this text: the network's own functions with the hooks of the terms, `bind`,
 * `fill_fields` and `take_inputs`.
 */

/* What the circuit takes [ohm]: a wire with a clean break is 1e12 ohm, one that is bridged 1 milliohm. */
#define LEAST_RESISTANCE 1e-3
#define MOST_RESISTANCE 1e12

bool model_start(Model *model, char *message, size_t size)
{
    Step step;
    Bound bound;
    Step *s = bind(model, &step, &bound);
    if (bound.plan.pairs + bound.plan.contacts > 0 && s->coils != PAIRED_COILS) {
        snprintf(message, size, "coils = %zu: the coils that touch each other are those of %d coils", model->coils,
                 PAIRED_COILS);
        return false;
    }
    fill_fields(model, s);
    take_inputs(model, s);
    for (int64_t i = 0; i < s->coils; i++) {
        ARRAY(field_load)[i] = s->tension[i];
        ARRAY(convected_energy)[i] = 0.0;
    }
    NUMBER(last_step) = 0.0;
    begin(s);
    return true;
}

void model_outputs(Model *model)
{
    Step step;
    Bound bound;
    Step *s = bind(model, &step, &bound);
    take_neighbours(model, s);
    s->dt = NUMBER(last_step); /* the step to come is taken to be as long as the last one */
    s->t = s->t_begin = NUMBER(time);
    s->t_end = s->t_begin + s->dt;
    memcpy(s->before, s->temperature, (size_t)s->coils * sizeof(double));
    find_resistance(s, s->temperature);
    const double *rest_length = COIL(rest_length), *capacity = COIL(capacity), *first = COIL(initial_temperature);
    for (int64_t i = 0; i < s->coils; i++) {
        ARRAY(temperature)[i] = s->temperature[i];
        ARRAY(stiffness)[i] = s->stiffness[i];
        ARRAY(rest_length)[i] = rest_length[i];
        ARRAY(resistance)[i] = clip(s->resistance[i], LEAST_RESISTANCE, MOST_RESISTANCE);
        ARRAY(stored_energy)[i] = capacity[i] * (s->temperature[i] - first[i]);
    }
    give_outputs(model, s);
}

void model_derivatives(Model *model)
{
    (void)model; /* no Model Exchange: the terms are written for steps */
}

void model_step(Model *model, double step_size)
{
    Step step;
    Bound bound;
    Step *s = bind(model, &step, &bound);
    take_inputs(model, s);
    s->t = s->t_begin = NUMBER(time);
    s->dt = NUMBER(last_step) = step_size;
    s->t_end = s->t_begin + s->dt;
    memcpy(s->before, s->temperature, (size_t)s->coils * sizeof(double));
    memcpy(s->middle, s->temperature, (size_t)s->coils * sizeof(double));
    balance_heat(s, 0);
    const double *capacity = COIL(capacity);
    for (int64_t i = 0; i < s->coils; i++) {
        ARRAY(convected_energy)[i] += s->power[i] * s->dt - capacity[i] * (s->temperature[i] - s->before[i]);
    }
    s->felt = s->mean;
    s->t = s->t_begin + 0.5 * s->dt;
    HOOK_state(s);
    HOOK_shared(s);
    s->t = s->t_end;
    find_stiffness(s);
    HOOK_accept(s);
}

void model_accept(Model *model)
{
    (void)model;
}
