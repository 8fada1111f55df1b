"""A sensor at the end of its range."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="sensor_clipping",
    name="clipping of a sensor",
    unit="measurement",
    law="value = truth + clipped * (min(truth + noise, pivot + ceiling * scale) - truth)",
    source="JCGM 200:2012, International Vocabulary of Metrology, 4.7 (measuring interval)",
    parameters=(
        Parameter(
            "clipped",
            "1",
            0.0,
            1.0,
            "1: clipped",
            meaning="factor 0 or 1: whether the readings are clipped",
            plausible=1.0,
            plausible_reason="clipped or not",
            is_amplitude=True,
            is_switch=True,
        ),
        Parameter(
            "ceiling",
            "1",
            -20.0,
            50.0,
            "in scales above the pivot",
            meaning="reading at which it clips, as a factor of what the channel typically reads",
            physical="reading",
            plausible=10.0,
            plausible_reason=(
                "100 K, 1 A or 10 mm above the pivot: the range of common sensors; where readings are at hand, "
                "shares of the largest of them are tried"
            ),
        ),
        Parameter("scale", "unit of the channel", 0.0, 1000.0, "typical size; given", (1.0,), is_fixed=True),
        Parameter("pivot", "unit of the channel", -1000.0, 1000.0, "given", (0.0, 295.15), is_fixed=True),
        Parameter("noise", "unit of the channel", 0.0, 1000.0, "of the sensor; given", (0.0,), is_fixed=True),
    ),
    places=("channel", "quantity"),
    lines={
        # A reading is cut off with its noise: below the ceiling, within the noise, its mean is lower than the truth.
        "sensor": """
            const double top = pivot + ceiling * scale, gap = (top - value) / most(noise, 1e-12);
            const double below = 0.5 * erfc(-gap * 0.7071067811865476);
            const double loss = gap * below + 0.3989422804014327 * exp(-0.5 * gap * gap);
            value += clipped * ((gap > 8.0 ? value : gap < -8.0 ? top : top - noise * loss) - value);
        """,
    },
    signature="One channel flat at one value where the others go on rising.",
    confused_with={
        "supply_current_limit": "temperatures decide",
    },
)
