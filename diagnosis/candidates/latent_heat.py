"""Heat taken up and given back by the transformation."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter, State

CANDIDATE = CandidateTerm(
    identifier="latent_heat",
    name="latent heat of transformation",
    unit="thermal",
    law="heat = -latent * d(phase)",
    source=(
        "C. Liang and C. A. Rogers, J. Intell. Mater. Syst. Struct. 1 (1990) 207-234; K. Otsuka and "
        "C. M. Wayman, Shape Memory Materials, Cambridge 1998, section 1.6"
    ),
    parameters=(
        Parameter(
            "latent",
            "J",
            0.0,
            10.0,
            "transformation to austenite takes heat up and gives the same back",
            meaning="heat that the whole transformation of one coil takes",
            plausible=40.0,
            of="capacity",
            plausible_reason=(
                "NiTi takes 20 to 30 J/g (Otsuka and Wayman 1998) at a specific heat of 0.84 J/(g K): 24 to 36 K "
                "times the heat capacity; a tenth more for the error of a calorimeter"
            ),
            is_amplitude=True,
        ),
    ),
    places=("all", "coil", "string"),
    lines={
        "heat": """
            heat -= dt > 0.0 ? owed / dt : 0.0;
            const double reach = dt / capacity * (P + heat - conductance * (T_begin - T_ambient)) *
                                 network_relaxation(conductance / capacity * dt);
            double change = reach;
            used = 0.0;
            #pragma GCC unroll 4
            for (int n = 0; n < 4; n++) {
                const double far = fabs(change) > 1e-9 ? change : 1e-9;
                const double celsius = T_begin + far - 273.15 - shift;
                const double up = gompertz(heating_a, heating_b, heating_c, heating_d, celsius);
                const double down =
                    celsius >= crossing ? up : gompertz(cooling_a, cooling_b, cooling_c, cooling_d, celsius);
                const double kept = clip(remembered, least(up, down), most(up, down));
                const double next = clip((kept - heating_d) / heating_a, 0.0, 1.0);
                used = latent * most((next - phase) / far, 0.0);
                change = reach * capacity / (capacity + used);
            }
            capacity += used;
            phase_then = phase;
        """,
        "accept": "owed = latent * (phase - phase_then) - used * (T_end - T_begin);",
    },
    signature=(
        "Heating pauses within the transformation and cooling pauses lower; the area of the pause is "
        "the same at every rate."
    ),
    confused_with={
        "temperature_dependent_resistance": "a staircase of voltages decides",
        "second_mass": "a run below the transformation decides",
    },
    states=(
        State("used", "J/K", "0.0", "memory"),
        State("owed", "J", "0.0", "memory"),
        State("phase_then", "1", "0.0", "memory"),
    ),
    rank=10,
)
