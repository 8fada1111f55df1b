"""Heat between coils that touch."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="neighbour_heat",
    name="heating between neighbours",
    unit="thermal",
    law="heat_a = -0.5 * (g_a + g_b) * (T_a - T_b); heat_b = -heat_a",
    source=(
        "F. P. Incropera et al., Fundamentals of Heat and Mass Transfer, 7th ed., Wiley 2011, section"
        " 3.1 (conductance of a contact)"
    ),
    parameters=(
        Parameter(
            "g",
            "W/K",
            0.0,
            0.1,
            "heat flows from hot to cold",
            meaning="heat transfer between coils that touch",
            plausible=3.0,
            of="conductance",
            plausible_reason=(
                "wires that cross touch over a tenth of a millimetre: 2 a k = 2e-4 m * 18 W/(m K) = 4 mW/K, less"
                " than the surface gives to the air; several contacts are allowed"
            ),
            is_amplitude=True,
        ),
    ),
    places=("all", "string"),
    fewest=2,
    lines={
        "pairs": "exchange = 0.5 * (g_a + g_b);",
    },
    signature="Unpowered coils warm up beside powered ones, with a delay; inner coils hotter than outer ones.",
    confused_with={
        "uneven_cooling": "strings powered one at a time decide",
        "shared_mass": "distant coils decide",
    },
)
