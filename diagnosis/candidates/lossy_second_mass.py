"""A second thermal mass that itself loses heat to the surroundings."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter, State

CANDIDATE = CandidateTerm(
    identifier="lossy_second_mass",
    name="second thermal mass with a loss of its own",
    unit="thermal",
    law="heat = -g * (T - mass); C2 * d(mass) = g * (T - mass) - loss * (mass - T_ambient)",
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
        Parameter(
            "loss",
            "W/K",
            1e-6,
            0.5,
            "heat flows from hot to cold; without loss it is a second mass",
            meaning="heat transfer from the second mass to the surroundings",
            plausible=10.0,
            of="conductance",
            plausible_reason=(
                "a mass that loses ten times as much as the coil stays at the temperature of the surroundings"
            ),
        ),
    ),
    places=("all", "coil", "string"),
    lines={
        # The mass follows within the step, as in second_mass; `apart` is the part of g that it cannot follow.
        "heat": """
            const double held = network_relaxation((g + loss) / C2 * dt);
            const double apart = (loss + g * held) / (g + loss + 1e-300);
            conductance += g * apart;
            heat += g * held * (mass_begin - T_ambient);
        """,
        "state": """
            mass_inflow = (g * T + loss * T_ambient) / C2;
            mass_rate = (g + loss) / C2;
        """,
    },
    signature="As a second mass; the plateau itself is lower too.",
    confused_with={
        "second_mass": "one equation, beside an h A that is greater by g * loss / (g + loss): a known h A decides",
        "base:conductance": "only the slow part tells",
    },
    states=(State("mass", "K", "T"),),
)
