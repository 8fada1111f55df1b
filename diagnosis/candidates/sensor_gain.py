"""A sensor with a wrong gain."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="sensor_gain",
    name="gain of a sensor",
    unit="measurement",
    law="value = truth + gain * (truth - pivot - zero * scale)",
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
        # What is right about another reading differs by a bias. Held at one reading, a gain about 0 degC looks like a
        # bias: the rest of it, about the room, is what other heat capacities and losses do as well.
        Parameter(
            "zero",
            "1",
            -5.0,
            2.0,
            "within the readings of the rig, or at the zero of a scale",
            meaning="where the sensor is right: distance from the pivot, as a factor of the channel's typical reading",
            physical="reading",
            plausible=4.0,
            plausible_reason=(
                "a factor acts on what a sensor counts from: a thermocouple from its cold junction in the room, a "
                "scale in degC or degF from its own 0, 22 and 40 K below the room; a length from its own zero"
            ),
            is_position=True,
        ),
        Parameter("scale", "unit of the channel", 0.0, 1000.0, "typical size; given", (1.0,), is_fixed=True),
        Parameter("pivot", "unit of the channel", -1000.0, 1000.0, "given", (0.0, 295.15), is_fixed=True),
    ),
    places=("channel", "quantity"),
    lines={
        "sensor": "value += gain * (value - pivot - zero * scale);",
    },
    signature="One channel departs in proportion to its own reading; its neighbours and other quantities fit.",
    confused_with={
        "base:conductance": "an isothermal soak or a stiffness reading decides",
        "base:capacity": "as above",
        "sensor_bias": "readings far from each other decide: a bias is the same in all of them",
    },
    keeps_sums=True,
)
