"""Surroundings whose temperature drifts."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="ambient_drift",
    name="drifting ambient temperature",
    unit="thermal",
    law="T_ambient = T_ambient_0 + drift * t",
    source="First term of a Taylor series in time of an unrecorded room temperature",
    parameters=(
        Parameter(
            "drift",
            "K/s",
            -0.1,
            0.1,
            "a room changes by kelvins within minutes",
            meaning="rate of the room's temperature",
            plausible=0.012,
            plausible_reason=(
                "36 coils at 0.4 W warm the air under a hood of 1 m^3 (1.2 kJ/K) by 0.012 K/s; 2 kW warm a "
                "laboratory of 50 m^3 by 0.011 K/s, with three times the air's heat capacity for what stands in it"
            ),
            is_amplitude=True,
            negligible=5e-4,
        ),
    ),
    places=("all", "string"),
    lines={
        "heat": "T_ambient += drift * t;",
    },
    signature="All temperatures leave the model slowly, powered or not, with no link to power.",
    confused_with={
        "second_mass": "a long soak decides",
        "sensor_drift": "an unpowered coil at known temperature, or stiffness, decides",
    },
    scope="day",
    scope_reason="a room drifts by its weather and its heating, of which another day has others",
)
