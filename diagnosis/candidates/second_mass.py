"""A second thermal mass behind each coil."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter, State

CANDIDATE = CandidateTerm(
    identifier="second_mass",
    name="second thermal mass",
    unit="thermal",
    law="heat = -g * (T - mass); C2 * d(mass) = g * (T - mass)",
    source=(
        "Two lumped capacitances; F. P. Incropera et al., Fundamentals of Heat and Mass Transfer, 7th"
        " ed., Wiley 2011, chapter 5"
    ),
    parameters=(
        Parameter(
            "g",
            "W/K",
            0.0,
            0.5,
            "heat flows from hot to cold",
            meaning="heat transfer between coil and second mass",
            plausible=10.0,
            of="conductance",
            plausible_reason=(
                "a mass that is joined ten times as well as the air has the coil's temperature within a tenth: "
                "it is the coil"
            ),
            is_amplitude=True,
        ),
        Parameter(
            "C2",
            "J/K",
            0.001,
            100.0,
            "a heat capacity is positive",
            meaning="heat capacity of the second mass",
            plausible=30.0,
            of="capacity",
            plausible_reason=(
                "a mass of more than some tens of coils hardly warms within a recording: it is the surroundings"
            ),
        ),
    ),
    places=("all", "coil", "string"),
    lines={
        # The mass follows within the step: its mean is what counts, so that no time constant is too short for the step.
        "heat": """
            const double held = network_relaxation(g / C2 * dt);
            conductance += g * held;
            heat += g * held * (mass_begin - T_ambient);
        """,
        "state": """
            mass_inflow = g * T / C2;
            mass_rate = g / C2;
        """,
    },
    signature="Fast rise, then a slow creep to the plateau; a slow tail after the power is cut.",
    confused_with={
        "temperature_dependent_convection": "a long soak decides",
        "ambient_drift": "a long soak decides",
        "sensor_lag": "stiffness or current decide: a lag leaves them alone",
    },
    states=(State("mass", "K", "T"),),
)
