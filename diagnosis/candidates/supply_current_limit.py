"""Limit of the supply's current."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="supply_current_limit",
    name="current limit of the supply",
    unit="electrical",
    law="I_supply = min(I_free, 1 / inverse_limit)",
    source="P. Horowitz and W. Hill, The Art of Electronics, 3rd ed., Cambridge 2015, section 9.13",
    parameters=(
        Parameter(
            "inverse_limit",
            "1/A",
            0.0,
            100.0,
            "a limit is positive; 0 is no limit",
            (0.2, 0.35, 0.5, 1.0, 3.0),
            is_amplitude=True,
        ),
    ),
    places=("supply", "all"),
    lines={
        "supply": "if (inverse_limit > 0.0) I_limit = least(I_limit, 1.0 / inverse_limit);",
    },
    signature="Supply current flat at one value while the voltage is high; nothing below it.",
    confused_with={
        "supply_source_resistance": "several levels of voltage decide",
        "sensor_clipping": "temperatures decide: a clipped sensor leaves them alone",
    },
)
