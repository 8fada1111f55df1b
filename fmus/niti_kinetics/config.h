/* NiTi coils with phase kinetics: their variables. Equations in model.c, sources of the numbers in README.md. */
#ifndef CONFIG_H
#define CONFIG_H

#define MODEL_IDENTIFIER "niti_kinetics"
#define MODEL_DESCRIPTION \
    "Joule-heated NiTi coils with martensite fraction (Liang and Rogers), latent heat and stress-dependent transformation"
#define MODEL_STOP_TIME 30.0
#define MODEL_STEP_SIZE 0.01

/* V(identifier, name, role, extent, unit, start, limit, nominal, depends, description) */
#define VARIABLES(V) \
    V(time, "time", TIME, SCALAR, "s", 0, ANY, 1, "", "Simulated time") \
    V(coils, "coils", STRUCTURE, SCALAR, "1", COILS, ANY, 1, "", "Number of coils") \
    V(power, "power", INPUT, PER_COIL, "W", 0, ANY, 0.5, "", "Electrical power turned into heat in each coil") \
    V(ambient_temperature, "ambient_temperature", INPUT, SCALAR, "K", 295.15, POSITIVE, 300, "", \
      "Temperature of the surrounding air or bath") \
    V(tension, "tension", INPUT, PER_COIL, "N", 0, ANY, 5, "", "Pull on each coil; a negative one counts as none") \
    V(stored_energy, "stored_energy", STATE, PER_COIL, "J", 0, ANY, 1, "stored_energy", \
      "Sensible and latent heat stored in each coil since the start") \
    V(convected_energy, "convected_energy", STATE, PER_COIL, "J", 0, ANY, 1, "convected_energy", \
      "Heat given to the surroundings since the start") \
    V(temperature, "temperature", OUTPUT, PER_COIL, "K", 0, SOLID_NITI, 300, "tension stored_energy", \
      "Temperature of each coil") \
    V(martensite_fraction, "martensite_fraction", OUTPUT, PER_COIL, "1", 0, NON_NEGATIVE, 1, "tension stored_energy", \
      "Part of each coil that is martensite") \
    V(stiffness, "stiffness", OUTPUT, PER_COIL, "N/m", 0, POSITIVE, 200, "tension stored_energy", \
      "Spring constant of each coil") \
    V(rest_length, "rest_length", OUTPUT, PER_COIL, "m", 0, POSITIVE, 0.01, "tension stored_energy", \
      "Length of each coil without load") \
    V(resistance, "resistance", OUTPUT, PER_COIL, "ohm", 0, POSITIVE, 2, "tension stored_energy", \
      "Electrical resistance of each coil") \
    V(latent_energy, "latent_energy", OUTPUT, PER_COIL, "J", 0, ANY, 1, "tension stored_energy", \
      "Part of stored_energy that is heat of transformation") \
    V(der_stored_energy, "der(stored_energy)", DERIVATIVE, PER_COIL, "W", 0, ANY, 0.5, \
      "power ambient_temperature tension stored_energy", "Heat flow into each coil") \
    V(der_convected_energy, "der(convected_energy)", DERIVATIVE, PER_COIL, "W", 0, ANY, 0.5, \
      "ambient_temperature tension stored_energy", "Heat flow to the surroundings") \
    V(reference_resistance, "reference_resistance", PARAMETER, PER_COIL, "ohm", 2.2, POSITIVE, 2, "", \
      "Resistance of a coil of martensite") \
    V(heat_transfer_coefficient, "heat_transfer_coefficient", PARAMETER, PER_COIL, "W/(m^2*K)", 90, NON_NEGATIVE, \
      90, "", "Convective heat transfer coefficient h") \
    V(volume, "volume", PARAMETER, PER_COIL, "m^3", 7.328e-9, POSITIVE, 1e-8, "", "Volume of NiTi in each coil") \
    V(area, "area", PARAMETER, SCALAR, "m^2", 97.85e-6, POSITIVE, 1e-4, "", "Surface area of one coil") \
    V(density, "density", PARAMETER, SCALAR, "kg/m^3", 6450, POSITIVE, 6450, "", "Density of NiTi") \
    V(specific_heat, "specific_heat", PARAMETER, SCALAR, "J/(kg*K)", 837, POSITIVE, 837, "", \
      "Specific heat of NiTi, the same in both phases") \
    V(latent_heat, "latent_heat", PARAMETER, SCALAR, "J/kg", 24000, NON_NEGATIVE, 24000, "", \
      "Heat taken up by the change from martensite to austenite") \
    V(initial_temperature, "initial_temperature", PARAMETER, PER_COIL, "K", 295.15, POSITIVE, 300, "", \
      "Temperature of each coil at the start; zero of stored_energy") \
    V(initial_loop_position, "initial_loop_position", PARAMETER, PER_COIL, "1", 0, NON_NEGATIVE, 1, "", \
      "Place of each coil in its hysteresis loop at the start: 0 heating branch (never heated), 1 cooling branch") \
    V(martensite_finish, "martensite_finish", PARAMETER, SCALAR, "K", 278.34, POSITIVE, 300, "", \
      "Temperature without stress at which cooling coils are all martensite") \
    V(martensite_start, "martensite_start", PARAMETER, SCALAR, "K", 310.37, POSITIVE, 300, "", \
      "Temperature without stress at which cooling austenite begins to transform") \
    V(austenite_start, "austenite_start", PARAMETER, SCALAR, "K", 297.42, POSITIVE, 300, "", \
      "Temperature without stress at which heated martensite begins to transform") \
    V(austenite_finish, "austenite_finish", PARAMETER, SCALAR, "K", 320.37, POSITIVE, 300, "", \
      "Temperature without stress at which heated coils are all austenite") \
    V(clausius_clapeyron_slope, "clausius_clapeyron_slope", PARAMETER, SCALAR, "Pa/K", 13.8e6, POSITIVE, 1e7, "", \
      "Shear stress, mean over the wire's section, that raises the transformation temperatures by one kelvin") \
    V(wire_diameter, "wire_diameter", PARAMETER, SCALAR, "m", 0.29956e-3, POSITIVE, 3e-4, "", "Diameter of the wire") \
    V(coil_diameter, "coil_diameter", PARAMETER, SCALAR, "m", 1.0676e-3, POSITIVE, 1e-3, "", \
      "Mean diameter of the coil") \
    V(turns, "turns", PARAMETER, SCALAR, "1", 31, POSITIVE, 31, "", "Number of active turns") \
    V(martensite_shear_modulus, "martensite_shear_modulus", PARAMETER, SCALAR, "Pa", 5.8873e9, POSITIVE, 1e10, "", \
      "Apparent shear modulus of martensite") \
    V(austenite_shear_modulus, "austenite_shear_modulus", PARAMETER, SCALAR, "Pa", 13.3433e9, POSITIVE, 1e10, "", \
      "Shear modulus of austenite") \
    V(coil_rest_length, "coil_rest_length", PARAMETER, SCALAR, "m", 0.0094, POSITIVE, 0.01, "", \
      "Length without load of a coil of austenite") \
    V(transformation_strain, "transformation_strain", PARAMETER, SCALAR, "1", 0.002, NON_NEGATIVE, 0.01, "", \
      "Shear strain at the wire's surface that martensite keeps without load") \
    V(martensite_resistivity, "martensite_resistivity", PARAMETER, SCALAR, "ohm*m", 1.02e-6, POSITIVE, 1e-6, "", \
      "Resistivity of martensite; only its ratio to austenite_resistivity counts") \
    V(austenite_resistivity, "austenite_resistivity", PARAMETER, SCALAR, "ohm*m", 0.89e-6, POSITIVE, 1e-6, "", \
      "Resistivity of austenite") \
    V(memory_fraction, "memory_fraction", HIDDEN, PER_COIL, "1", 0, ANY, 1, "", "Austenite at the last accepted step") \
    V(memory_temperature, "memory_temperature", HIDDEN, PER_COIL, "K", 0, ANY, 300, "", \
      "Temperature less its shift by stress at the last accepted step") \
    V(initial_fraction, "initial_fraction", HIDDEN, PER_COIL, "1", 0, ANY, 1, "", "Austenite at the start")

#endif
