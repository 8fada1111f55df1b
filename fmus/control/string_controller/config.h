/* A controller of one string: its variables. Equations in model.c.
 *
 * The laws of `kind: controller` (docs/control.md): on-off, proportional-integral, hold on the cooling branch, and a
 * supervisor over them. `coils` is the number of readings of the string.
 */
#ifndef CONFIG_H
#define CONFIG_H

#define MODEL_IDENTIFIER "string_controller"
#define MODEL_DESCRIPTION \
    "Sampled controller of one string of coils: on-off or PI, hold on the cooling branch, supervisor"
#define MODEL_STOP_TIME 30.0
#define MODEL_STEP_SIZE 0.1
#define MODEL_CO_SIMULATION_ONLY
/* Samples that a delay may last. */
#define HISTORY 64

/* Four times 16 hidden numbers, one after the other: rises that no reading shows yet, oldest first. */
#define WAITING(V, part) \
    V(waiting_##part##_0, "waiting", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(waiting_##part##_1, "waiting", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(waiting_##part##_2, "waiting", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(waiting_##part##_3, "waiting", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(waiting_##part##_4, "waiting", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(waiting_##part##_5, "waiting", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(waiting_##part##_6, "waiting", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(waiting_##part##_7, "waiting", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(waiting_##part##_8, "waiting", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(waiting_##part##_9, "waiting", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(waiting_##part##_10, "waiting", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(waiting_##part##_11, "waiting", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(waiting_##part##_12, "waiting", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(waiting_##part##_13, "waiting", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(waiting_##part##_14, "waiting", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(waiting_##part##_15, "waiting", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "")
/* Four times 16 hidden numbers, one after the other: what follows seen. */
#define SEEN(V, part) \
    V(seen_##part##_0, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(seen_##part##_1, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(seen_##part##_2, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(seen_##part##_3, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(seen_##part##_4, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(seen_##part##_5, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(seen_##part##_6, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(seen_##part##_7, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(seen_##part##_8, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(seen_##part##_9, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(seen_##part##_10, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(seen_##part##_11, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(seen_##part##_12, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(seen_##part##_13, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(seen_##part##_14, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "") \
    V(seen_##part##_15, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "")

/* V(identifier, name, role, extent, unit, start, limit, nominal, depends, description) */
#define VARIABLES(V) \
    V(time, "time", TIME, SCALAR, "s", 0, ANY, 1, "", "Simulated time") \
    V(coils, "coils", STRUCTURE, SCALAR, "1", COILS, ANY, 1, "", "Number of readings") \
    V(measured, "measured", INPUT, PER_COIL, "K", 295.15, ANY, 300, "", "What the sensor reads") \
    V(setpoint, "setpoint", INPUT, SCALAR, "K", 295.15, ANY, 300, "", "What is asked for") \
    V(command, "command", OUTPUT, SCALAR, "V", 0, ANY, 1, "", "What drives, held until the next sample") \
    V(demand, "demand", OUTPUT, SCALAR, "1", 0, ANY, 1, "", \
      "What the law asks for, before limits: in V, or in V^2 with drive_squared") \
    V(alarm, "alarm", OUTPUT, SCALAR, "1", 0, ANY, 1, "", \
      "0 none, 1 limited, 2 out of range, 3 frozen, 4 no response: from 2 on the string is off for good") \
    V(sample, "sample", PARAMETER, SCALAR, "s", 0.1, POSITIVE, 1, "", \
      "Interval between samples; a multiple of the communication step size") \
    V(lowest, "lowest", PARAMETER, SCALAR, "V", 0, NON_NEGATIVE, 1, "", "Lowest command") \
    V(highest, "highest", PARAMETER, SCALAR, "V", 10, POSITIVE, 1, "", "Highest command") \
    V(drive_squared, "drive_squared", FLAG, SCALAR, "1", 0, ANY, 1, "", \
      "Whether demand and gains are in squares of the command, as heat is of a voltage") \
    V(combine, "combine", PARAMETER, SCALAR, "1", 0, NON_NEGATIVE, 1, "", \
      "How the readings of a string become one: 0 mean, 1 largest, 2 smallest") \
    V(law, "law", PARAMETER, SCALAR, "1", 1, NON_NEGATIVE, 1, "", "0 on-off, 1 proportional-integral") \
    V(band, "band", PARAMETER, SCALAR, "K", 1, NON_NEGATIVE, 1, "", "On-off: width of the band around the setpoint") \
    V(gain, "gain", PARAMETER, SCALAR, "1", 1, ANY, 1, "", "PI: demand per kelvin") \
    V(integral_time, "integral_time", PARAMETER, SCALAR, "s", 4, POSITIVE, 1, "", "PI: integral time") \
    V(feedforward, "feedforward", PARAMETER, SCALAR, "1", 0, ANY, 1, "", \
      "PI: demand that holds one kelvin above ambient") \
    V(ambient, "ambient", PARAMETER, SCALAR, "K", 295.15, ANY, 1, "", \
      "PI: temperature of the surroundings that feedforward counts from") \
    V(use_hold, "use_hold", FLAG, SCALAR, "1", 0, ANY, 1, "", \
      "Whether a string that has reached its setpoint is held lower, on the cooling branch") \
    V(hold_at, "hold_at", PARAMETER, SCALAR, "K", 319.15, ANY, 1, "", "Temperature of the hold") \
    V(reheat_below, "reheat_below", PARAMETER, SCALAR, "K", 315.15, ANY, 1, "", \
      "Temperature below which a string is heated again") \
    V(use_supervisor, "use_supervisor", FLAG, SCALAR, "1", 0, ANY, 1, "", \
      "Whether a supervisor keeps every reading below limit") \
    V(limit, "limit", PARAMETER, SCALAR, "K", 353.15, ANY, 1, "", "Supervisor: highest temperature allowed") \
    V(margin, "margin", PARAMETER, SCALAR, "K", 0.5, NON_NEGATIVE, 1, "", \
      "Supervisor: largest error of a right thermometer") \
    V(fastest_rise, "fastest_rise", PARAMETER, SCALAR, "K/s", 50, POSITIVE, 1, "", \
      "Supervisor: rise at the highest command of the coil that heats fastest") \
    V(slowest_rise, "slowest_rise", PARAMETER, SCALAR, "K/s", 0, NON_NEGATIVE, 1, "", \
      "Supervisor: the same of the slowest; 0: no check of the response") \
    V(cooling_time, "cooling_time", PARAMETER, SCALAR, "s", 1, POSITIVE, 1, "", \
      "Supervisor: shortest time constant of cooling") \
    V(lowest_ambient, "lowest_ambient", PARAMETER, SCALAR, "K", 0, ANY, 1, "", \
      "Supervisor: lowest temperature of the surroundings") \
    V(tolerance, "tolerance", PARAMETER, SCALAR, "K", 1e9, NON_NEGATIVE, 1, "", \
      "Supervisor: lack of response that is a failure") \
    V(delay, "delay", PARAMETER, SCALAR, "s", 0, NON_NEGATIVE, 1, "", \
      "Supervisor: from a temperature to its reading, at most 64 samples") \
    V(lag, "lag", PARAMETER, SCALAR, "s", 0, NON_NEGATIVE, 1, "", "Supervisor: time constant of the sensor") \
    V(lowest_reading, "lowest_reading", PARAMETER, SCALAR, "K", -1e9, ANY, 1, "", \
      "Supervisor: at or below this a reading is a failure") \
    V(highest_reading, "highest_reading", PARAMETER, SCALAR, "K", 1e9, ANY, 1, "", \
      "Supervisor: at or above this a reading is a failure") \
    V(frozen_after, "frozen_after", PARAMETER, SCALAR, "s", 0, NON_NEGATIVE, 1, "", \
      "Supervisor: an unchanged reading is a failure after this; 0: no check") \
    V(begin, "begin", HIDDEN, SCALAR, "s", 0, ANY, 1, "", "Time of the first sample") \
    V(held_command, "held_command", HIDDEN, SCALAR, "V", 0, ANY, 1, "", "Since the last sample") \
    V(held_demand, "held_demand", HIDDEN, SCALAR, "1", 0, ANY, 1, "", "Since the last sample") \
    V(held_alarm, "held_alarm", HIDDEN, SCALAR, "1", 0, ANY, 1, "", "Since the last sample") \
    V(on, "on", HIDDEN, SCALAR, "1", 0, ANY, 1, "", "On-off: whether it drives") \
    V(integral, "integral", HIDDEN, SCALAR, "1", 0, ANY, 1, "", "PI: integral part of the demand") \
    V(holding, "holding", HIDDEN, SCALAR, "1", 0, ANY, 1, "", "Whether the setpoint was reached") \
    V(lagging, "lagging", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "Supervisor: rise that the sensor's lag hides") \
    V(coldest, "coldest", HIDDEN, SCALAR, "K", 0, ANY, 1, "", "Supervisor: temperature of the slowest coil") \
    V(last, "last", HIDDEN, PER_COIL, "K", 0, ANY, 1, "", "Supervisor: last readings") \
    V(unchanged, "unchanged", HIDDEN, PER_COIL, "s", 0, ANY, 1, "", "Supervisor: time without a change") \
    V(failed, "failed", HIDDEN, PER_COIL, "1", 0, ANY, 1, "", "Supervisor: why a thermometer failed") \
    WAITING(V, 0) WAITING(V, 1) WAITING(V, 2) WAITING(V, 3) \
    V(seen, "seen", HIDDEN, SCALAR, "K", 0, ANY, 1, "", \
      "Supervisor: the slowest coil as its sensor saw it, oldest first") \
    SEEN(V, 0) SEEN(V, 1) SEEN(V, 2) SEEN(V, 3)

#endif
