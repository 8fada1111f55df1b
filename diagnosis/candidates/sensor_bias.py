"""A sensor with a constant offset."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="sensor_bias",
    name="bias of a sensor",
    unit="measurement",
    law="value = truth + bias * scale",
    source="JCGM 200:2012, International Vocabulary of Metrology, 4.20 (instrument bias)",
    parameters=(
        Parameter(
            "bias",
            "1",
            -5.0,
            5.0,
            "larger ones are seen by eye",
            meaning="change of every reading, as a share of what the channel typically reads",
            physical="change",
            plausible=1.0,
            plausible_reason="10 K, 0.1 A or 1 mm are seen before a run begins",
            is_amplitude=True,
        ),
        Parameter("scale", "unit of the channel", 0.0, 1000.0, "typical size; given", (1.0,), is_fixed=True),
    ),
    places=("channel", "quantity"),
    lines={
        "sensor": "value += bias * scale;",
    },
    signature="One channel off by the same at all times, the rest before the first pulse included.",
    confused_with={
        "base:initial_temperature": "the end of a run decides",
        "transformation_shift": "a soak decides",
    },
    keeps_sums=True,
)
