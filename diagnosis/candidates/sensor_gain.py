"""A sensor with a wrong gain."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="sensor_gain",
    name="gain of a sensor",
    unit="measurement",
    law="value = truth + gain * (truth - pivot)",
    source="JCGM 200:2012, International Vocabulary of Metrology, 4.12 (sensitivity)",
    parameters=(
        Parameter(
            "gain",
            "1",
            -0.5,
            0.5,
            "a calibration is never off by more",
            meaning="change of the sensor's factor: 0.01 reads 1 % too much",
            plausible=0.3,
            plausible_reason=(
                "a thermocouple of type J read as type K is off by 28 % (51.7 against 40.5 microvolt/K at 25 degC, "
                "NIST Monograph 175); yellow is K in ANSI MC96.1 and J in BS 1843"
            ),
            is_amplitude=True,
            negligible=0.003,
        ),
        Parameter(
            "pivot",
            "unit of the channel",
            -1000.0,
            1000.0,
            "where the sensor is right; given",
            (0.0, 295.15),
            is_fixed=True,
        ),
    ),
    places=("channel", "quantity"),
    lines={
        "sensor": "value += gain * (value - pivot);",
    },
    signature="One channel departs in proportion to its own reading; its neighbours and other quantities fit.",
    confused_with={
        "base:conductance": "an isothermal soak or a stiffness reading decides",
        "base:capacity": "as above",
    },
    keeps_sums=True,
)
