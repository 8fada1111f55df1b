/* Polypyrrole film actuators: their variables. Equations in model.c, sources of the numbers in README.md. */
#ifndef CONFIG_H
#define CONFIG_H

#define MODEL_IDENTIFIER "polypyrrole_film"
#define MODEL_DESCRIPTION "Polypyrrole films behind a lever: charge diffuses into the film, strain follows the charge"
#define MODEL_STOP_TIME 60.0
#define MODEL_STEP_SIZE 0.01

/* Charge in one of the layers from surface to middle of a film, and its rate. */
#define CHARGE(V, layer) \
    V(charge_##layer, "charge_" #layer, STATE, PER_COIL, "C", 0, ANY, 10, "charge_" #layer, \
      "Charge in layer " #layer " of 5, from the surface inwards, of each actuator's films")
#define CURRENT(V, layer, depends) \
    V(der_charge_##layer, "der(charge_" #layer ")", DERIVATIVE, PER_COIL, "A", 0, ANY, 1, depends, \
      "Current into layer " #layer)

/* V(identifier, name, role, extent, unit, start, limit, nominal, depends, description) */
#define VARIABLES(V) \
    V(time, "time", TIME, SCALAR, "s", 0, ANY, 1, "", "Simulated time") \
    V(coils, "coils", STRUCTURE, SCALAR, "1", COILS, ANY, 1, "", "Number of actuators") \
    V(voltage, "voltage", INPUT, PER_COIL, "V", 0, ANY, 1, "", "Voltage on each actuator; positive reduces the film") \
    V(ambient_temperature, "ambient_temperature", INPUT, SCALAR, "K", 295.15, POSITIVE, 300, "", \
      "Temperature of the surrounding air or bath") \
    CHARGE(V, 1) CHARGE(V, 2) CHARGE(V, 3) CHARGE(V, 4) CHARGE(V, 5) \
    V(convected_energy, "convected_energy", STATE, PER_COIL, "J", 0, ANY, 1, "convected_energy", \
      "Heat given to the surroundings since the start") \
    V(temperature, "temperature", OUTPUT, PER_COIL, "K", 0, POSITIVE, 300, "ambient_temperature", \
      "Temperature of each actuator: that of the surroundings") \
    V(stiffness, "stiffness", OUTPUT, PER_COIL, "N/m", 0, POSITIVE, 2000, "", "Spring constant of each actuator") \
    V(rest_length, "rest_length", OUTPUT, PER_COIL, "m", 0, POSITIVE, 0.03, \
      "charge_1 charge_2 charge_3 charge_4 charge_5", "Length of each actuator without load") \
    V(resistance, "resistance", OUTPUT, PER_COIL, "ohm", 0, POSITIVE, 1, "", \
      "Resistance of each actuator with its balancing shunt, as the circuit sees it") \
    V(stored_energy, "stored_energy", OUTPUT, PER_COIL, "J", 0, ANY, 10, \
      "charge_1 charge_2 charge_3 charge_4 charge_5", "Electrical energy stored in each actuator's films since the start") \
    V(film_current, "film_current", OUTPUT, PER_COIL, "A", 0, ANY, 1, "voltage charge_1", \
      "Current into the films of each actuator") \
    CURRENT(V, 1, "voltage charge_1 charge_2") CURRENT(V, 2, "charge_1 charge_2 charge_3") \
    CURRENT(V, 3, "charge_2 charge_3 charge_4") CURRENT(V, 4, "charge_3 charge_4 charge_5") \
    CURRENT(V, 5, "charge_4 charge_5") \
    V(der_convected_energy, "der(convected_energy)", DERIVATIVE, PER_COIL, "W", 0, ANY, 1, \
      "voltage charge_1 charge_2 charge_3 charge_4 charge_5", "Heat flow to the surroundings") \
    V(reference_resistance, "reference_resistance", PARAMETER, PER_COIL, "ohm", 0.12, POSITIVE, 0.1, "", \
      "Resistance of electrolyte and contacts") \
    V(film_length, "film_length", PARAMETER, SCALAR, "m", 0.03, POSITIVE, 0.01, "", "Length of the films") \
    V(film_section, "film_section", PARAMETER, SCALAR, "m^2", 22.5e-6, POSITIVE, 1e-5, "", \
      "Cross-section of all films of an actuator") \
    V(film_thickness, "film_thickness", PARAMETER, SCALAR, "m", 4e-6, POSITIVE, 1e-5, "", \
      "Thickness of one film, wetted on both sides") \
    V(youngs_modulus, "youngs_modulus", PARAMETER, SCALAR, "Pa", 0.8e9, POSITIVE, 1e9, "", "Young's modulus of the film") \
    V(volumetric_capacitance, "volumetric_capacitance", PARAMETER, SCALAR, "F/m^3", 8e7, POSITIVE, 1e8, "", \
      "Charge per volt and volume of film") \
    V(strain_to_charge, "strain_to_charge", PARAMETER, SCALAR, "m^3/C", 1e-10, NON_NEGATIVE, 1e-10, "", \
      "Strain per charge and volume of film") \
    V(diffusion_coefficient, "diffusion_coefficient", PARAMETER, SCALAR, "m^2/s", 1e-12, POSITIVE, 1e-12, "", \
      "Diffusion coefficient of the ions in the film") \
    V(lever_ratio, "lever_ratio", PARAMETER, SCALAR, "1", 16.1, POSITIVE, 10, "", \
      "Stroke of the actuator over that of its films") \
    V(initial_voltage, "initial_voltage", PARAMETER, PER_COIL, "V", 0, ANY, 1, "", \
      "Voltage at which the films of each actuator were at rest before the start; 0: without charge") \
    V(coil_rest_length, "coil_rest_length", PARAMETER, SCALAR, "m", 0.0314, POSITIVE, 0.03, "", \
      "Length without load of an actuator without charge")

#endif
