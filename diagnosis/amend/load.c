/* What hangs below the coils, with the terms of the mechanical unit; the coils themselves are another FMU.
 *
 * The functions are those of the network. Added states follow what the coils were over the step and how stiff they were at
 * its begin, as in the network; then force and extension are found at the end of the step.
 */

bool model_start(Model *model, char *message, size_t size)
{
    (void)message;
    (void)size;
    Step step;
    Bound bound;
    Step *s = bind(model, &step, &bound);
    fill_fields(model, s);
    take_inputs(model, s);
    take_stiffness(model, s);
    for (int64_t i = 0; i < s->coils; i++) {
        s->tension[i] = ARRAY(field_load)[i];
        s->before[i] = s->temperature[i];
        s->extension[i] = 0.0;
    }
    s->t = s->t_begin = s->t_end = NUMBER(time);
    s->dt = 0.0;
    s->felt = s->temperature;
    START_states(s);
    find_length(s);
    return true;
}

void model_outputs(Model *model)
{
    Step step;
    Bound bound;
    Step *s = bind(model, &step, &bound);
    for (int64_t i = 0; i < s->coils; i++) {
        ARRAY(extension)[i] = s->extension[i];
        ARRAY(length)[i] = s->length[i];
        ARRAY(tension)[i] = s->tension[i];
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
    memcpy(s->before, s->temperature, (size_t)s->coils * sizeof(double));
    take_inputs(model, s);
    s->t_begin = NUMBER(time);
    s->dt = step_size;
    s->t_end = s->t_begin + s->dt;
    s->felt = s->mean;
    s->t = s->t_begin + 0.5 * s->dt;
    HOOK_state(s);
    HOOK_shared(s);
    take_stiffness(model, s);
    s->felt = s->temperature;
    s->t = s->t_end;
    find_length(s);
    HOOK_accept(s);
}

void model_accept(Model *model)
{
    (void)model;
}
