"""Two channels that were mistaken for each other."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="wrong_identity",
    name="wrong identity of two channels",
    unit="measurement",
    law="value = truth + exchange * (truth_of_other - truth)",
    source="Permutation of channels",
    parameters=(
        Parameter(
            "exchange",
            "1",
            0.0,
            1.0,
            "1: exchanged",
            meaning="factor 0 or 1: whether the channels are exchanged",
            plausible=1.0,
            plausible_reason="exchanged or not",
            is_amplitude=True,
            is_switch=True,
        ),
        Parameter("other", "1", 0.0, 1000000.0, "the other element; given", (0.0,), is_fixed=True),
    ),
    places=("swap",),
    fewest=2,
    lines={
        "channel": """
            share += exchange;
            partner = (int64_t)other;
        """,
    },
    signature="Two channels each fit the other's element.",
    confused_with={
        "sensor_bias": "a change of power decides",
    },
)
