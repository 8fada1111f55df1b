"""Length that changes with temperature."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="thermal_contraction",
    name="thermal contraction",
    unit="mechanical",
    law="extension = extension_0 - contraction * (T - reference_temperature)",
    source=(
        "K. Otsuka and C. M. Wayman, Shape Memory Materials, Cambridge 1998, chapter 1 (two-way "
        "effect and thermal expansion, linear)"
    ),
    parameters=(
        Parameter(
            "contraction",
            "m/K",
            -0.0002,
            0.0002,
            "expansion of metals or a two-way effect, either sign",
            meaning="change of the length per kelvin, positive where it shrinks",
            plausible=0.01,
            of="stretch",
            plausible_reason=(
                "a two-way effect moves half of the stretch over 50 K; expansion of steel is a hundredth of that"
            ),
            is_amplitude=True,
            negligible=1e-6,
        ),
    ),
    places=("all", "coil", "string"),
    lines={
        "length": "extension -= contraction * (T - reference_temperature);",
    },
    signature="Extension drifts with the temperature also where the stiffness is saturated.",
    confused_with={
        "creep": "cooling decides",
        "base:heating_a": "temperatures outside the transformation decide",
    },
)
