/* Coils whose stiffness switches with the power: their variables. The paper's comparison without a heating model
 * (section 2.5). Interchangeable with thermal_stiffness: same inputs and outputs.
 */
#ifndef CONFIG_H
#define CONFIG_H

#define MODEL_IDENTIFIER "instant_stiffness"
#define MODEL_DESCRIPTION "NiTi coils without a heating model: stiffness set to its maximum or minimum by the power"
#define MODEL_STOP_TIME 30.0
#define MODEL_STEP_SIZE 0.01

/* V(identifier, name, role, extent, unit, start, limit, nominal, depends, description) */
#define VARIABLES(V) \
    V(time, "time", TIME, SCALAR, "s", 0, ANY, 1, "", "Simulated time") \
    V(coils, "coils", STRUCTURE, SCALAR, "1", COILS, ANY, 1, "", "Number of coils") \
    V(power, "power", INPUT, PER_COIL, "W", 0, ANY, 0.5, "", "Electrical power turned into heat in each coil") \
    V(ambient_temperature, "ambient_temperature", INPUT, SCALAR, "K", 295.15, POSITIVE, 300, "", \
      "Temperature of the surrounding air or bath") \
    V(convected_energy, "convected_energy", STATE, PER_COIL, "J", 0, ANY, 1, "convected_energy", \
      "Heat given to the surroundings since the start: all of it, at once") \
    V(temperature, "temperature", OUTPUT, PER_COIL, "K", 0, POSITIVE, 300, "ambient_temperature", \
      "Temperature of each coil: that of the surroundings") \
    V(stiffness, "stiffness", OUTPUT, PER_COIL, "N/m", 0, POSITIVE, 200, "power", \
      "Spring constant of each coil: maximum_stiffness under power, minimum_stiffness without") \
    V(rest_length, "rest_length", OUTPUT, PER_COIL, "m", 0, POSITIVE, 0.01, "", "Length of each coil without load") \
    V(resistance, "resistance", OUTPUT, PER_COIL, "ohm", 0, POSITIVE, 2, "", "Electrical resistance of each coil") \
    V(stored_energy, "stored_energy", OUTPUT, PER_COIL, "J", 0, ANY, 1, "", "Heat stored in each coil: none") \
    V(der_convected_energy, "der(convected_energy)", DERIVATIVE, PER_COIL, "W", 0, ANY, 0.5, "power", \
      "Heat flow to the surroundings") \
    V(reference_resistance, "reference_resistance", PARAMETER, PER_COIL, "ohm", 2.2, POSITIVE, 2, "", \
      "Resistance of each coil") \
    V(minimum_stiffness, "minimum_stiffness", PARAMETER, SCALAR, "N/m", 157.1, POSITIVE, 200, "", \
      "Stiffness without power: equation (2), temperature rising, far below 30 degC") \
    V(maximum_stiffness, "maximum_stiffness", PARAMETER, SCALAR, "N/m", 356.05951795685417, POSITIVE, 200, "", \
      "Stiffness under power: equation (2), temperature rising, at 70 degC") \
    V(coil_rest_length, "coil_rest_length", PARAMETER, SCALAR, "m", 0.0094, POSITIVE, 0.01, "", \
      "Length of a coil without load") \
    V(off_power, "off_power", PARAMETER, SCALAR, "W", 1e-9, NON_NEGATIVE, 1e-9, "", \
      "A coil whose power is at most this counts as switched off")

#endif
