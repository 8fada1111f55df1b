/* Twisted-and-coiled polymer muscles: their variables. Equations in model.c, sources of the numbers in README.md. */
#ifndef CONFIG_H
#define CONFIG_H

#define MODEL_IDENTIFIER "tcp_muscle"
#define MODEL_DESCRIPTION "Bundles of Joule-heated twisted-and-coiled nylon muscles: linear contraction, no hysteresis"
#define MODEL_STOP_TIME 30.0
#define MODEL_STEP_SIZE 0.01

/* V(identifier, name, role, extent, unit, start, limit, nominal, depends, description) */
#define VARIABLES(V) \
    V(time, "time", TIME, SCALAR, "s", 0, ANY, 1, "", "Simulated time") \
    V(coils, "coils", STRUCTURE, SCALAR, "1", COILS, ANY, 1, "", "Number of bundles") \
    V(power, "power", INPUT, PER_COIL, "W", 0, ANY, 1, "", "Electrical power turned into heat in each bundle") \
    V(ambient_temperature, "ambient_temperature", INPUT, SCALAR, "K", 295.15, POSITIVE, 300, "", \
      "Temperature of the surrounding air or bath") \
    V(temperature, "temperature", STATE, PER_COIL, "K", 0, SOLID_NYLON, 300, "temperature", \
      "Temperature of each bundle") \
    V(convected_energy, "convected_energy", STATE, PER_COIL, "J", 0, ANY, 1, "convected_energy", \
      "Heat given to the surroundings since the start") \
    V(stiffness, "stiffness", OUTPUT, PER_COIL, "N/m", 0, POSITIVE, 2000, "", "Spring constant of each bundle") \
    V(rest_length, "rest_length", OUTPUT, PER_COIL, "m", 0, POSITIVE, 0.03, "temperature", \
      "Length of each bundle without load") \
    V(resistance, "resistance", OUTPUT, PER_COIL, "ohm", 0, POSITIVE, 1, "", "Electrical resistance of each bundle") \
    V(stored_energy, "stored_energy", OUTPUT, PER_COIL, "J", 0, ANY, 1, "temperature", \
      "Heat stored in each bundle since the start") \
    V(der_temperature, "der(temperature)", DERIVATIVE, PER_COIL, "K/s", 0, ANY, 10, \
      "power ambient_temperature temperature", "Rate of change of the temperature") \
    V(der_convected_energy, "der(convected_energy)", DERIVATIVE, PER_COIL, "W", 0, ANY, 1, \
      "ambient_temperature temperature", "Heat flow to the surroundings") \
    V(reference_resistance, "reference_resistance", PARAMETER, PER_COIL, "ohm", 1.15, POSITIVE, 1, "", \
      "Resistance of the silver coating of a bundle") \
    V(muscle_conductance, "muscle_conductance", PARAMETER, PER_COIL, "W/K", 3.6e-3, NON_NEGATIVE, 1e-3, "", \
      "Heat flow per kelvin from each muscle of a bundle to the surroundings") \
    V(muscle_heat_capacity, "muscle_heat_capacity", PARAMETER, SCALAR, "J/K", 0.0222, POSITIVE, 0.01, "", \
      "Heat capacity of one muscle") \
    V(muscle_stiffness, "muscle_stiffness", PARAMETER, SCALAR, "N/m", 756, POSITIVE, 1000, "", \
      "Spring constant of one muscle") \
    V(muscles, "muscles", PARAMETER, SCALAR, "1", 3, POSITIVE, 1, "", "Number of muscles side by side in a bundle") \
    V(contraction_coefficient, "contraction_coefficient", PARAMETER, SCALAR, "1/K", 1.82e-3, NON_NEGATIVE, 1e-3, "", \
      "Part of its length by which a muscle contracts per kelvin") \
    V(contraction_limit, "contraction_limit", PARAMETER, SCALAR, "1", 0.49, NON_NEGATIVE, 1, "", \
      "Largest contraction, as a part of the length: neighbouring turns touch") \
    V(reference_temperature, "reference_temperature", PARAMETER, SCALAR, "K", 295.15, POSITIVE, 300, "", \
      "Temperature at which the length without load is coil_rest_length") \
    V(initial_temperature, "initial_temperature", PARAMETER, PER_COIL, "K", 295.15, POSITIVE, 300, "", \
      "Temperature of each bundle at the start; zero of stored_energy") \
    V(coil_rest_length, "coil_rest_length", PARAMETER, SCALAR, "m", 0.03137, POSITIVE, 0.03, "", \
      "Length without load at reference_temperature")

#endif
