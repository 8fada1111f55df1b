/* Many independent arms on hinges in one world of Bullet, in one pass; see pendulum_batch.py.
 *
 * Bullet is called through its C interface, which pybullet's library exports. A run costs a step of Bullet, one command
 * that sets torques and one that reads states for every STAR arms; the laws of friction are those of
 * mechanics/bullet_pendulum.py, in the same order.
 */
#include <dlfcn.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STAR = 4 };   /* arms on one fixed base: the cost of Bullet's solver grows with the square of it */
enum { TORQUE = 1, VELOCITY = 0, REVOLUTE = 0, NO_SLEEP = 4 };  /* numbers of Bullet's interface */

typedef struct {
    double inertia, moment, angle, speed, tilt;
    double viscous, quadratic, cubic, coulomb, stiction, stribeck;
    double stiffness, rest, band_damping, band_width, shake, rhythm, phase, constant;
} Arm;

typedef void *Handle;
#define CALLS(X) \
    X(Handle, b3ConnectPhysicsDirect, (void)) \
    X(Handle, b3SubmitClientCommandAndWaitStatus, (Handle, Handle)) \
    X(Handle, b3InitStepSimulationCommand, (Handle)) \
    X(Handle, b3InitResetSimulationCommand, (Handle)) \
    X(Handle, b3InitPhysicsParamCommand, (Handle)) \
    X(int, b3PhysicsParamSetGravity, (Handle, double, double, double)) \
    X(int, b3PhysicsParamSetTimeStep, (Handle, double)) \
    X(int, b3PhysicsParamSetNumSubSteps, (Handle, int)) \
    X(int, b3PhysicsParamSetNumSolverIterations, (Handle, int)) \
    X(int, b3PhysicsParamSetSolverResidualThreshold, (Handle, double)) \
    X(Handle, b3CreateMultiBodyCommandInit, (Handle)) \
    X(int, b3CreateMultiBodyBase, (Handle, double, int, int, const double *, const double *, const double *, const double *)) \
    X(int, b3CreateMultiBodyLink, (Handle, double, double, double, const double *, const double *, const double *, \
                                   const double *, int, int, const double *)) \
    X(int, b3GetStatusBodyIndex, (Handle)) \
    X(int, b3GetStatusType, (Handle)) \
    X(Handle, b3InitChangeDynamicsInfo, (Handle)) \
    X(int, b3ChangeDynamicsInfoSetLocalInertiaDiagonal, (Handle, int, int, const double *)) \
    X(int, b3ChangeDynamicsInfoSetLinearDamping, (Handle, int, double)) \
    X(int, b3ChangeDynamicsInfoSetAngularDamping, (Handle, int, double)) \
    X(int, b3ChangeDynamicsInfoSetJointDamping, (Handle, int, int, double)) \
    X(int, b3ChangeDynamicsInfoSetMaxJointVelocity, (Handle, int, double)) \
    X(int, b3ChangeDynamicsInfoSetActivationState, (Handle, int, int)) \
    X(Handle, b3CreatePoseCommandInit, (Handle, int)) \
    X(int, b3CreatePoseCommandSetJointPosition, (Handle, Handle, int, double)) \
    X(int, b3CreatePoseCommandSetJointVelocity, (Handle, Handle, int, double)) \
    X(Handle, b3JointControlCommandInit2, (Handle, int, int)) \
    X(int, b3JointControlSetDesiredVelocity, (Handle, int, double)) \
    X(int, b3JointControlSetKd, (Handle, int, double)) \
    X(int, b3JointControlSetMaximumForce, (Handle, int, double)) \
    X(int, b3JointControlSetDesiredForceTorque, (Handle, int, double)) \
    X(Handle, b3RequestActualStateCommandInit, (Handle, int)) \
    X(int, b3GetStatusActualState, (Handle, int *, int *, int *, const double **, const double **, const double **, \
                                    const double **))

#define POINTER(result, name, arguments) static result(*name) arguments;
CALLS(POINTER)

static Handle client;

/* Connects to Bullet in the library at `path`; 0 if that worked (again: nothing happens), else 1. */
int pendulums_open(const char *path) {
    if (client) return 0;
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!library) return 1;
#define FIND(result, name, arguments) \
    name = (result(*) arguments)dlsym(library, #name); \
    if (!name) return 1;
    CALLS(FIND)
    client = b3ConnectPhysicsDirect();
    return client ? 0 : 1;
}

static Handle send(Handle command) { return b3SubmitClientCommandAndWaitStatus(client, command); }

static void world(double step) {
    send(b3InitResetSimulationCommand(client));
    Handle command = b3InitPhysicsParamCommand(client);
    b3PhysicsParamSetGravity(command, 0.0, 0.0, -9.80665);
    b3PhysicsParamSetTimeStep(command, step);
    b3PhysicsParamSetNumSubSteps(command, 0);
    b3PhysicsParamSetNumSolverIterations(command, 10);
    b3PhysicsParamSetSolverResidualThreshold(command, 0.0);
    send(command);
}

/* One fixed base with up to STAR arms, which do not act on each other; number of its body, or -1.
 * Mass and distance are chosen so that moment and inertia about the hinge are those asked for. */
static int star(const Arm *arms, int count) {
    const double none[3] = {0, 0, 0}, straight[4] = {0, 0, 0, 1}, axis[3] = {0, 1, 0}, gravity = 9.80665;
    Handle command = b3CreateMultiBodyCommandInit(client);
    b3CreateMultiBodyBase(command, 0.0, -1, -1, none, straight, none, straight);
    for (int i = 0; i < count; i++) {
        const double distance = 0.5 * arms[i].inertia * gravity / arms[i].moment;
        const double centre[3] = {0, 0, distance};
        const double leaning[4] = {0, sin(-0.5 * arms[i].tilt), 0, cos(-0.5 * arms[i].tilt)};
        b3CreateMultiBodyLink(command, arms[i].moment / (gravity * distance), -1, -1, none, leaning, centre, straight, 0,
                              REVOLUTE, axis);
    }
    const int body = b3GetStatusBodyIndex(send(command));
    if (body < 0) return -1;
    Handle change = b3InitChangeDynamicsInfo(client);
    b3ChangeDynamicsInfoSetLinearDamping(change, body, 0.0);
    b3ChangeDynamicsInfoSetAngularDamping(change, body, 0.0);
    b3ChangeDynamicsInfoSetMaxJointVelocity(change, body, 1e6);
    b3ChangeDynamicsInfoSetActivationState(change, body, NO_SLEEP);
    send(change);
    for (int i = 0; i < count; i++) {
        const double central = 0.5 * arms[i].inertia, diagonal[3] = {central, central, central};
        change = b3InitChangeDynamicsInfo(client);
        b3ChangeDynamicsInfoSetLocalInertiaDiagonal(change, body, i, diagonal);
        b3ChangeDynamicsInfoSetJointDamping(change, body, i, 0.0);
        send(change);
    }
    return body;
}

static double dry(const Arm *arm, double speed) {
    if (arm->stiction == 0.0) return arm->coulomb;
    const double ratio = speed / arm->stribeck;
    return arm->coulomb + arm->stiction * exp(-ratio * ratio);
}

/* Torque of all laws but weight and dry friction. `ahead` makes up for the error of the longer step: Takahashi, Imada,
 * J. Phys. Soc. Jpn. 53 (1984) 3765, the force of V - step^2 / 24 V'^2 / J; here step^2 less that of the unit. What is
 * then left is a change of coordinates, generated by step^2 / 12 w V', which `shift` undoes. */
static double torque(const Arm *arm, double time, double angle, double speed, double ahead) {
    double found = arm->constant
        - (arm->viscous + arm->quadratic * fabs(speed) + arm->cubic * speed * speed) * speed;
    if (arm->stiffness != 0.0) found -= arm->stiffness * (angle - arm->rest);
    if (arm->band_damping != 0.0) {
        const double ratio = (angle - M_PI) / arm->band_width;
        found -= arm->band_damping * exp(-ratio * ratio) * speed;
    }
    if (arm->shake != 0.0) found += arm->shake * sin(arm->rhythm * time + arm->phase);
    const double leaning = angle - arm->tilt, share = ahead / 12.0 * arm->moment / arm->inertia;
    return found * (1.0 + share * cos(leaning)) + share * arm->moment * sin(leaning) * cos(leaning);
}

typedef struct { double angle, speed, acceleration, held; } State;

/* From the arm's own angle and speed to those that the longer step carries on; back with -ahead. */
static void shift(const Arm *arm, double ahead, double *angle, double *speed) {
    const double leaning = *angle - arm->tilt, share = ahead / 12.0 * arm->moment / arm->inertia;
    *angle -= share * sin(leaning);
    *speed *= 1.0 + share * cos(leaning);
}

/* Angle and angular velocity now, as the unit would tell them: speed half a step ago and the acceleration of the last
 * step give the angular velocity but for step^2 / 2 times its second derivative, and the unit errs by its own. */
static void seen(const Arm *arm, const State *state, double step, double ahead, double *angle, double *speed) {
    *angle = state->angle;
    *speed = state->speed + 0.5 * step * state->acceleration;
    *speed *= 1.0 + 0.5 * ahead * arm->moment / arm->inertia * cos(*angle - arm->tilt);
    shift(arm, -ahead, angle, speed);
}

static void put(int body, const State *states, int count) {
    Handle command = b3CreatePoseCommandInit(client, body);
    for (int i = 0; i < count; i++) {
        b3CreatePoseCommandSetJointPosition(client, command, i, states[i].angle);
        b3CreatePoseCommandSetJointVelocity(client, command, i, states[i].speed);
    }
    send(command);
}

/* First coordinates of a body belong to its base: 7 of the position, 6 of the velocity. */
enum { BASE_Q = 7, BASE_U = 6 };

static void hold(int body, State *states, const double *friction, int count) {
    int is_other = 0;
    for (int i = 0; i < count; i++) is_other |= friction[i] != states[i].held;
    if (!is_other) return;
    Handle command = b3JointControlCommandInit2(client, body, VELOCITY);
    for (int i = 0; i < count; i++) {
        b3JointControlSetDesiredVelocity(command, BASE_U + i, 0.0);
        b3JointControlSetKd(command, BASE_U + i, 1.0);
        b3JointControlSetMaximumForce(command, BASE_U + i, friction[i]);
        states[i].held = friction[i];
    }
    send(command);
}

/* Torque of dry friction in a step in which the arm turns back: it acts one way before and the other way after, which
 * one motor over a whole step cannot. 0 and `friction` as it was where the arm does not turn, or may stick. */
static double turning(const Arm *arm, const State *state, double given, double step, double *friction) {
    const double free = given + arm->moment * sin(state->angle - arm->tilt);
    const double next = state->speed + step * free / arm->inertia;
    if (*friction == 0.0 || state->speed * next >= 0.0 || fabs(free) <= 2.0 * *friction) return 0.0;
    const double before = fabs(state->speed) / (fabs(state->speed) + fabs(next));
    const double found = -copysign(*friction, state->speed) * (2.0 * before - 1.0);
    *friction = 0.0;
    return found;
}

static void advance(const int *bodies, const Arm *arms, State *states, int count, double time, double step, double ahead) {
    for (int first = 0, b = 0; first < count; first += STAR, b++) {
        const int own = count - first < STAR ? count - first : STAR;
        double friction[STAR];
        int is_driven = 0;
        Handle command = b3JointControlCommandInit2(client, bodies[b], TORQUE);
        for (int i = 0; i < own; i++) {
            double angle, speed;
            seen(&arms[first + i], &states[first + i], step, ahead, &angle, &speed);
            double given = torque(&arms[first + i], time, angle, speed, ahead);
            friction[i] = dry(&arms[first + i], speed);
            given += turning(&arms[first + i], &states[first + i], given, step, &friction[i]);
            is_driven |= given != 0.0;
            b3JointControlSetDesiredForceTorque(command, BASE_U + i, given);
        }
        if (is_driven) send(command);
        hold(bodies[b], states + first, friction, own);
    }
    send(b3InitStepSimulationCommand(client));
    for (int first = 0, b = 0; first < count; first += STAR, b++) {
        const int own = count - first < STAR ? count - first : STAR;
        const double *q = 0, *u = 0;
        b3GetStatusActualState(send(b3RequestActualStateCommandInit(client, bodies[b])), 0, 0, 0, 0, &q, &u, 0);
        for (int i = 0; i < own; i++) {
            State *s = &states[first + i];
            const double speed = u[BASE_U + i];
            s->acceleration = (speed - s->speed) / step;
            s->speed = speed;
            s->angle = q[BASE_Q + i];
        }
    }
}

/* Angle and angular velocity of every arm at the start and after every `every` steps.
 * found: shape (count, samples, 2); unit_step: that of the unit whose runs are meant. 0 if it worked. */
int pendulums_run(const Arm *arms, int count, double step, double unit_step, int every, int samples, double *found) {
    const double ahead = step * step - unit_step * unit_step;
    State *states = calloc(2 * (size_t)count, sizeof *states), *begins = states + count;
    int *bodies = calloc((size_t)count, sizeof *bodies);
    int failed = !states || !bodies;
    if (!failed) world(step);
    for (int first = 0, b = 0; !failed && first < count; first += STAR, b++) {
        const int own = count - first < STAR ? count - first : STAR;
        for (int i = 0; i < own; i++) {
            State *s = &states[first + i];
            *s = (State){arms[first + i].angle, arms[first + i].speed, 0.0, -1.0};
            shift(&arms[first + i], ahead, &s->angle, &s->speed);
            begins[first + i] = *s;
        }
        bodies[b] = star(arms + first, own);
        failed = bodies[b] < 0;
        if (failed) break;
        put(bodies[b], states + first, own);
    }
    if (!failed) {
        /* a trial step gives the acceleration, with which the speed goes back by half a step */
        advance(bodies, arms, states, count, 0.0, step, ahead);
        for (int first = 0, b = 0; first < count; first += STAR, b++) {
            const int own = count - first < STAR ? count - first : STAR;
            for (int i = 0; i < own; i++) {
                State *s = &states[first + i];
                const State *begin = &begins[first + i];
                *s = (State){begin->angle, begin->speed - 0.5 * step * s->acceleration, s->acceleration,
                             s->held};
            }
            put(bodies[b], states + first, own);
        }
    }
    for (int n = 0; !failed && n < samples; n++) {
        for (int i = 0; i < count; i++) {
            double *own = found + ((size_t)i * samples + n) * 2;
            seen(&arms[i], &states[i], step, ahead, &own[0], &own[1]);
        }
        if (n + 1 < samples)
            for (int k = 0; k < every; k++)
                advance(bodies, arms, states, count, ((double)n * every + k) * step, step, ahead);
    }
    free(states);
    free(bodies);
    return failed;
}
