"""A coil that is bridged at an instant."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="shorted_coil",
    name="coil shorted from an instant on",
    unit="electrical",
    law="R = R_0 * (1 - bridged * step(t - instant))",
    source="Bridge in a series circuit (Kirchhoff's laws)",
    parameters=(
        Parameter(
            "bridged",
            "1",
            0.0,
            1.0,
            "share of the turns that are bridged",
            meaning="share of the coil's resistance that is bridged",
            plausible=1.0,
            plausible_reason="a coil can be bridged wholly",
            starts=(1.0, 0.5, 0.25),
            starts_reason="whole, half and a quarter: bridges are short, so that a whole coil comes first",
            is_amplitude=True,
        ),
        Parameter("instant", "s", -1000000.0, 1000000.0, "within the recordings", (10.0,)),
    ),
    places=("coil",),
    lines={
        "resistance": "R *= 1.0 - bridged * share_after(instant, t_begin, t_end);",
    },
    signature="Current of one string rises at an instant; one coil cools, the others of the string get hotter.",
    confused_with={
        "base:reference_resistance": "the part before the instant decides",
    },
    scope_reason="turns or crimps that touch stay so until somebody parts them",
)
