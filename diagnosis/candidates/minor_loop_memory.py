"""Stiffness that moves inside the loop."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="minor_loop_memory",
    name="minor loops with a slope of their own",
    unit="stiffness",
    law="d(stiffness) = slope * 0.5 * (d(heating) + d(cooling))",
    source=("A. Visintin, Differential Models of Hysteresis, Springer 1994, chapter III (generalised play, Duhem)"),
    parameters=(
        Parameter(
            "slope",
            "1",
            0.0,
            1.0,
            "0 is the play operator, 1 follows the mean branch: stiffness never falls on heating",
            (0.1, 0.3, 0.7),
            is_amplitude=True,
        ),
    ),
    places=("all", "coil"),
    lines={
        "play": "remembered += slope * 0.5 * ((heating - heating_before) + (cooling - cooling_before));",
    },
    signature="After a partial reversal the stiffness moves at once instead of standing still.",
    confused_with={
        "transformation_shift": "a run without partial reversals shows nothing of this one",
    },
)
