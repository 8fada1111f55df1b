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
            plausible=1.0,
            plausible_reason=(
                "10 K in a minute: the reference junction of a thermocouple follows its connector (ASTM MNL 12, ch. 7) "
                "and 1 W of stray heat warms one of 10 g (6 J/K) so fast, while the wires drift by a few K in 1000 h; "
                "a mount that slips or an amplifier that warms up is allowed as many typical readings"
            ),
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
