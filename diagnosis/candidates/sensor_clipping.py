"""A sensor at the end of its range."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="sensor_clipping",
    name="clipping of a sensor",
    unit="measurement",
    law="value = truth + clipped * (min(truth, pivot + ceiling * scale) - truth)",
    source="JCGM 200:2012, International Vocabulary of Metrology, 4.7 (measuring interval)",
    parameters=(
        Parameter("clipped", "1", 0.0, 1.0, "1: clipped", (1.0,), is_amplitude=True, is_switch=True),
        Parameter("ceiling", "1", -20.0, 50.0, "in scales above the pivot", (5.0, 3.0, 2.0, 1.0)),
        Parameter("scale", "unit of the channel", 0.0, 1000.0, "typical size; given", (1.0,), is_fixed=True),
        Parameter("pivot", "unit of the channel", -1000.0, 1000.0, "given", (0.0, 295.15), is_fixed=True),
    ),
    places=("channel", "quantity"),
    lines={
        "sensor": "value += clipped * (least(value, pivot + ceiling * scale) - value);",
    },
    signature="One channel flat at one value where the others go on rising.",
    confused_with={
        "supply_current_limit": "temperatures decide",
    },
)
