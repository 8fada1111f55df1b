"""Heat between two coils that touch although the rig does not mean them to."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="touching_coils",
    name="heat between two coils that touch",
    unit="thermal",
    law="heat_a = -g * (T_a - T_b); heat_b = -heat_a",
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
            meaning="heat transfer between the two coils",
            plausible=3.0,
            of="conductance",
            plausible_reason=(
                "wires that cross touch over a tenth of a millimetre: 2 a k = 2e-4 m * 18 W/(m K) = 4 mW/K, less"
                " than the surface gives to the air; several contacts are allowed"
            ),
            is_amplitude=True,
        ),
    ),
    places=("pair",),
    # Of two coils the only pair is all of them: `neighbour_heat`.
    fewest=2,
    lines={
        "contacts": "exchange = g;",
    },
    signature="One coil warms up with one other, with a delay, powered or not; all others keep their own.",
    confused_with={
        "neighbour_heat": "a coil beside the two that is not powered decides",
        "uneven_cooling": "the two coils powered one at a time decide",
        "shared_mass": "distant coils decide",
    },
)
