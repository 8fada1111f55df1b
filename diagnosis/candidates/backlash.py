"""Lost motion between coil and marker."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="backlash",
    name="backlash",
    unit="mechanical",
    law="abs(extension_marker - extension) <= 0.5 * gap",
    source=(
        "G. Tao and P. V. Kokotovic, Adaptive Control of Systems with Actuator and Sensor "
        "Nonlinearities, Wiley 1996, chapter 2"
    ),
    parameters=(
        Parameter(
            "gap",
            "m",
            0.0,
            0.005,
            "a gap is positive",
            meaning="play of the pin, from end to end",
            plausible=0.27,
            of="stretch",
            plausible_reason=(
                "an eye is as wide as its coil, at most 12 wires of 0.3 mm (spring index, Shigley, chapter 10), and "
                "a pin fills half of that: 1.65 mm where the paper's coil stretches by 6.2 mm"
            ),
            is_amplitude=True,
            negligible=2e-5,
        ),
    ),
    places=("coil", "all", "string"),
    lines={
        "length": "extension = clip(extension_before, extension - 0.5 * gap, extension + 0.5 * gap);",
    },
    signature="Extension stands still after each reversal for a constant length.",
    confused_with={
        "slide_friction": "coils of different stiffness or load decide",
    },
)
