"""Limit of the supply's current."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="supply_current_limit",
    name="current limit of the supply",
    unit="electrical",
    law="I_supply = I_free + share * (min(I_free, limit) - I_free)",
    source="P. Horowitz and W. Hill, The Art of Electronics, 3rd ed., Cambridge 2015, section 9.13",
    parameters=(
        Parameter(
            "share",
            "1",
            0.0,
            1.0,
            "1: the limit holds; less: a limit that gives way",
            meaning="factor 0 or 1: whether the supply limits its current",
            plausible=1.0,
            plausible_reason="the limit holds",
            is_amplitude=True,
            is_switch=True,
        ),
        Parameter(
            "limit",
            "A",
            0.01,
            1000.0,
            "a limit is positive",
            meaning="greatest current of the supply",
            plausible=30.0,
            plausible_reason="laboratory supplies are made for 0.3 to 30 A",
            count=6,
        ),
    ),
    places=("supply", "all"),
    lines={
        "supply": """
            I_limit = share > 0.0 ? limit : I_limit;
            limited = share > 0.0 ? share : limited;
        """,
    },
    signature="Supply current flat at one value while the voltage is high; nothing below it.",
    confused_with={
        "supply_source_resistance": "several levels of voltage decide",
        "sensor_clipping": "temperatures decide: a clipped sensor leaves them alone",
    },
)
