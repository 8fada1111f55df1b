/* Thermal and stiffness model of NiTi coils: its variables. Equations in model.c.
 *
 * Constants: Active Chainmail Fabrics (Smart Materials and Structures 26, 08LT02, 2017), sections 2.2 and 2.3.
 */
#ifndef CONFIG_H
#define CONFIG_H

#define MODEL_IDENTIFIER "thermal_stiffness"
#define MODEL_DESCRIPTION \
    "Joule-heated NiTi coils: temperature (equations 3 to 5) and hysteretic stiffness (equation 2)"
#define MODEL_STOP_TIME 30.0
#define MODEL_STEP_SIZE 0.01

/* V(identifier, name, role, extent, unit, start, limit, nominal, depends, description) */
#define VARIABLES(V) \
    V(time, "time", TIME, SCALAR, "s", 0, ANY, 1, "", "Simulated time") \
    V(coils, "coils", STRUCTURE, SCALAR, "1", COILS, ANY, 1, "", "Number of coils") \
    V(power, "power", INPUT, PER_COIL, "W", 0, ANY, 0.5, "", "Electrical power turned into heat in each coil") \
    V(ambient_temperature, "ambient_temperature", INPUT, SCALAR, "K", 295.15, POSITIVE, 300, "", \
      "Temperature of the surrounding air or bath") \
    V(temperature, "temperature", STATE, PER_COIL, "K", 0, SOLID_NITI, 300, "temperature", "Temperature of each coil") \
    V(convected_energy, "convected_energy", STATE, PER_COIL, "J", 0, ANY, 1, "convected_energy", \
      "Heat given to the surroundings since the start") \
    V(stiffness, "stiffness", OUTPUT, PER_COIL, "N/m", 0, POSITIVE, 200, "temperature", \
      "Spring constant of each coil, equation (2) with a play operator between its branches") \
    V(rest_length, "rest_length", OUTPUT, PER_COIL, "m", 0, POSITIVE, 0.01, "", "Length of each coil without load") \
    V(resistance, "resistance", OUTPUT, PER_COIL, "ohm", 0, POSITIVE, 2, "temperature", \
      "Electrical resistance of each coil") \
    V(stored_energy, "stored_energy", OUTPUT, PER_COIL, "J", 0, ANY, 1, "temperature", \
      "Heat stored in each coil since the start") \
    V(der_temperature, "der(temperature)", DERIVATIVE, PER_COIL, "K/s", 0, ANY, 10, \
      "power ambient_temperature temperature", "Rate of change of the temperature") \
    V(der_convected_energy, "der(convected_energy)", DERIVATIVE, PER_COIL, "W", 0, ANY, 0.5, \
      "power ambient_temperature temperature", "Heat flow to the surroundings") \
    V(reference_resistance, "reference_resistance", PARAMETER, PER_COIL, "ohm", 2.2, POSITIVE, 2, "", \
      "Resistance at reference_temperature") \
    V(heat_transfer_coefficient, "heat_transfer_coefficient", PARAMETER, PER_COIL, "W/(m^2*K)", 90, NON_NEGATIVE, \
      90, "", "Convective heat transfer coefficient h") \
    V(volume, "volume", PARAMETER, PER_COIL, "m^3", 7.328e-9, POSITIVE, 1e-8, "", "Volume of NiTi in each coil") \
    V(area, "area", PARAMETER, SCALAR, "m^2", 97.85e-6, POSITIVE, 1e-4, "", "Surface area of one coil") \
    V(density, "density", PARAMETER, SCALAR, "kg/m^3", 6450, POSITIVE, 6450, "", "Density of NiTi") \
    V(specific_heat, "specific_heat", PARAMETER, SCALAR, "J/(kg*K)", 837, POSITIVE, 837, "", "Specific heat of NiTi") \
    V(initial_temperature, "initial_temperature", PARAMETER, PER_COIL, "K", 295.15, POSITIVE, 300, "", \
      "Temperature of each coil at the start; zero of stored_energy") \
    V(initial_loop_position, "initial_loop_position", PARAMETER, PER_COIL, "1", 0, NON_NEGATIVE, 1, "", \
      "Place of each coil in its hysteresis loop at the start: 0 heating branch (never heated), 1 cooling branch") \
    V(heating_a, "heating_a", PARAMETER, SCALAR, "N/m", 230.5, POSITIVE, 200, "", \
      "Equation (2), temperature rising: rise of the stiffness") \
    V(heating_b, "heating_b", PARAMETER, SCALAR, "1", 17443, POSITIVE, 17443, "", \
      "Equation (2), temperature rising: displacement") \
    V(heating_c, "heating_c", PARAMETER, SCALAR, "1/K", 0.1669, POSITIVE, 0.1, "", \
      "Equation (2), temperature rising: growth rate") \
    V(heating_d, "heating_d", PARAMETER, SCALAR, "N/m", 157.1, POSITIVE, 200, "", \
      "Equation (2), temperature rising: stiffness of martensite") \
    V(cooling_a, "cooling_a", PARAMETER, SCALAR, "N/m", 199.6, POSITIVE, 200, "", \
      "Equation (2), temperature falling: rise of the stiffness") \
    V(cooling_b, "cooling_b", PARAMETER, SCALAR, "1", 696, POSITIVE, 696, "", \
      "Equation (2), temperature falling: displacement") \
    V(cooling_c, "cooling_c", PARAMETER, SCALAR, "1/K", 0.1549, POSITIVE, 0.1, "", \
      "Equation (2), temperature falling: growth rate") \
    V(cooling_d, "cooling_d", PARAMETER, SCALAR, "N/m", 157.9, POSITIVE, 200, "", \
      "Equation (2), temperature falling: stiffness of martensite") \
    V(coil_rest_length, "coil_rest_length", PARAMETER, SCALAR, "m", 0.0094, POSITIVE, 0.01, "", \
      "Length of a coil without load") \
    V(resistance_temperature_coefficient, "resistance_temperature_coefficient", PARAMETER, SCALAR, "1/K", 0, ANY, \
      1e-3, "", "Relative change of resistance per kelvin; 0 in the paper") \
    V(reference_temperature, "reference_temperature", PARAMETER, SCALAR, "K", 295.15, POSITIVE, 300, "", \
      "Temperature at which the resistance is reference_resistance") \
    V(cooling_rate, "cooling_rate", PARAMETER, SCALAR, "1/s", 0.14, NON_NEGATIVE, 0.1, "", \
      "alpha of equation (5), regressed in the paper") \
    V(off_power, "off_power", PARAMETER, SCALAR, "W", 1e-9, NON_NEGATIVE, 1e-9, "", \
      "A coil whose power is at most this counts as switched off") \
    V(use_regressed_cooling_rate, "use_regressed_cooling_rate", FLAG, SCALAR, "1", 1, ANY, 1, "", \
      "Whether a coil that is switched off cools with cooling_rate instead of h A / C") \
    V(memory, "memory", HIDDEN, PER_COIL, "N/m", 0, ANY, 1, "", "Stiffness at the last accepted step") \
    V(crossing, "crossing", HIDDEN, SCALAR, "1", 0, ANY, 1, "", "Temperature [degC] at which the branches meet")

#endif
