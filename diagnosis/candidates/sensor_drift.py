"""A sensor whose offset grows with time."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="sensor_drift",
    name="drift of a sensor",
    unit="measurement",
    law="value = truth + drift * scale * t / 60",
    source="JCGM 200:2012, International Vocabulary of Metrology, 4.21 (instrumental drift)",
    parameters=(
        Parameter(
            "drift",
            "1/min",
            -5.0,
            5.0,
            "larger ones are seen by eye",
            meaning="change of the reading in a minute, as a share of what the channel typically reads",
            physical="rate",
            plausible=0.1,
            plausible_reason="1 K or 0.1 mm in a minute: no sensor in order does more while it is looked at",
            is_amplitude=True,
        ),
        Parameter("scale", "unit of the channel", 0.0, 1000.0, "typical size; given", (1.0,), is_fixed=True),
    ),
    places=("channel", "quantity"),
    lines={
        "sensor": "value += drift * scale * t / 60.0;",
    },
    signature="One channel leaves the model steadily, powered or not.",
    confused_with={
        "ambient_drift": "several channels together decide",
        "creep": "an unloaded coil decides",
    },
    keeps_sums=True,
)
