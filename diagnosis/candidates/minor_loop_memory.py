"""Stiffness that moves inside the loop."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="minor_loop_memory",
    name="minor loops with a slope of their own",
    unit="stiffness",
    law="d(stiffness) = slope * (max(d(heating), 0) + min(d(cooling), 0))",
    source=("A. Visintin, Differential Models of Hysteresis, Springer 1994, chapter III (generalised play, Duhem)"),
    parameters=(
        Parameter(
            "slope",
            "1",
            0.0,
            1.0,
            "0 is the play operator; at most 1, so that the outer loop stays as it is",
            meaning="share of the branch's own slope that the stiffness has inside the loop",
            plausible=0.9,
            plausible_reason=(
                "measured minor loops of NiTi are less steep than the branches (Visintin, chapter III); at 1 "
                "there is no hysteresis inside"
            ),
            is_amplitude=True,
            negligible=0.06,
        ),
    ),
    places=("all", "coil"),
    lines={
        "play": "remembered += slope * (most(heating - heating_before, 0.0) + least(cooling - cooling_before, 0.0));",
    },
    signature="After a partial reversal the stiffness moves at once instead of standing still.",
    confused_with={
        "transformation_shift": "a run without partial reversals shows nothing of this one",
    },
)
