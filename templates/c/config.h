/* my_actuator: its variables. Edit this table and model.c; everything is SI.
 *
 * Example: coils heated by their own current, which stiffen along a straight line between two temperatures.
 * The inputs and outputs are the interface of docs/actuators/interface.md; the parameters are yours.
 */
#ifndef CONFIG_H
#define CONFIG_H

#define MODEL_IDENTIFIER "my_actuator"
#define MODEL_DESCRIPTION "Heated coils whose stiffness follows their temperature along a straight line"
#define MODEL_STOP_TIME 10.0
#define MODEL_STEP_SIZE 0.01

/* V(identifier, name, role, extent, unit, start, limit, nominal, depends, description)
 *
 * role: INPUT, STATE (a continuous state, also an output), OUTPUT, DERIVATIVE (of the states, in the same order),
 *   PARAMETER, FLAG (Boolean parameter), HIDDEN (kept with the state, not shown). extent: SCALAR or PER_COIL.
 * limit: ANY, NON_NEGATIVE or POSITIVE. depends: inputs and states that it depends on directly, separated by blanks.
 */
#define VARIABLES(V) \
    V(time, "time", TIME, SCALAR, "s", 0, ANY, 1, "", "Simulated time") \
    V(coils, "coils", STRUCTURE, SCALAR, "1", COILS, ANY, 1, "", "Number of coils") \
    V(power, "power", INPUT, PER_COIL, "W", 0, ANY, 0.5, "", "Electrical power turned into heat in each coil") \
    V(ambient_temperature, "ambient_temperature", INPUT, SCALAR, "K", 295.15, POSITIVE, 300, "", \
      "Temperature of the surroundings") \
    V(temperature, "temperature", STATE, PER_COIL, "K", 0, POSITIVE, 300, "temperature", "Temperature of each coil") \
    V(convected_energy, "convected_energy", STATE, PER_COIL, "J", 0, ANY, 1, "convected_energy", \
      "Heat given to the surroundings since the start") \
    V(stiffness, "stiffness", OUTPUT, PER_COIL, "N/m", 0, POSITIVE, 200, "temperature", "Spring constant of each coil") \
    V(rest_length, "rest_length", OUTPUT, PER_COIL, "m", 0, POSITIVE, 0.01, "", "Length of each coil without load") \
    V(resistance, "resistance", OUTPUT, PER_COIL, "ohm", 0, POSITIVE, 2, "", "Electrical resistance of each coil") \
    V(stored_energy, "stored_energy", OUTPUT, PER_COIL, "J", 0, ANY, 1, "temperature", \
      "Energy stored in each coil since the start") \
    V(der_temperature, "der(temperature)", DERIVATIVE, PER_COIL, "K/s", 0, ANY, 10, \
      "power ambient_temperature temperature", "Rate of change of the temperature") \
    V(der_convected_energy, "der(convected_energy)", DERIVATIVE, PER_COIL, "W", 0, ANY, 0.5, \
      "ambient_temperature temperature", "Heat flow to the surroundings") \
    V(reference_resistance, "reference_resistance", PARAMETER, PER_COIL, "ohm", 2.2, POSITIVE, 2, "", \
      "Resistance of one coil") \
    V(coil_rest_length, "coil_rest_length", PARAMETER, SCALAR, "m", 0.0094, POSITIVE, 0.01, "", \
      "Length of one coil without load") \
    V(heat_capacity, "heat_capacity", PARAMETER, SCALAR, "J/K", 0.0396, POSITIVE, 0.04, "", \
      "Mass times specific heat of one coil") \
    V(conductance, "conductance", PARAMETER, SCALAR, "W/K", 0.00881, POSITIVE, 0.01, "", \
      "Heat given to the surroundings per kelvin") \
    V(initial_temperature, "initial_temperature", PARAMETER, SCALAR, "K", 295.15, POSITIVE, 300, "", \
      "Temperature at the start") \
    V(soft_stiffness, "soft_stiffness", PARAMETER, SCALAR, "N/m", 157.1, POSITIVE, 200, "", \
      "Stiffness at soft_temperature and below") \
    V(stiff_stiffness, "stiff_stiffness", PARAMETER, SCALAR, "N/m", 356.1, POSITIVE, 200, "", \
      "Stiffness at stiff_temperature and above") \
    V(soft_temperature, "soft_temperature", PARAMETER, SCALAR, "K", 303.15, POSITIVE, 300, "", \
      "Where the stiffness begins to change") \
    V(stiff_temperature, "stiff_temperature", PARAMETER, SCALAR, "K", 343.15, POSITIVE, 300, "", \
      "Where the stiffness has changed")

#endif
