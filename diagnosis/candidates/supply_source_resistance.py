"""Inner resistance of the supply."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="supply_source_resistance",
    name="source resistance of the supply",
    unit="electrical",
    law="V_terminal = V - R_source * I_supply",
    source=(
        "Thevenin's theorem; P. Horowitz and W. Hill, The Art of Electronics, 3rd ed., Cambridge 2015, section 1.2.5"
    ),
    parameters=(
        Parameter(
            "R_source",
            "ohm",
            0.0,
            20.0,
            "passive: it turns current into heat outside the coils",
            meaning="inner resistance of the supply",
            plausible=2.0,
            of="resistance",
            plausible_reason="a supply that loses more than two coils take drives no network",
            is_amplitude=True,
        ),
    ),
    places=("supply", "all"),
    lines={
        "supply": "R_supply += R_source;",
    },
    signature="All strings carry too little current, more so the more of them carry current.",
    confused_with={
        "base:reference_resistance": "never told apart without the terminal voltage or a string that is opened",
        "temperature_dependent_resistance": "cold start decides",
    },
)
