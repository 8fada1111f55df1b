"""Transformation that fades with every cycle."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter, State

CANDIDATE = CandidateTerm(
    identifier="fatigue",
    name="fatigue per cycle",
    unit="stiffness",
    law="fraction = 1 - loss * cycles; d(cycles) = 0.5 * abs(d(phase))",
    source=(
        "G. Eggeler et al., Structural and functional fatigue of NiTi shape memory alloys, Mater. "
        "Sci. Eng. A 378 (2004) 24-33"
    ),
    parameters=(
        Parameter(
            "loss",
            "1",
            0.0,
            0.3,
            "cycling fades the effect; it never adds to it",
            meaning="share of the rise of the stiffness that is lost in a full cycle",
            plausible=0.1,
            plausible_reason=(
                "untrained wire keeps about 0.5 % of a transformation strain of 5 % in its first cycle and less in "
                "each one after it (Eggeler et al. 2004); with a tenth in every cycle ten of them leave nothing"
            ),
            is_amplitude=True,
            negligible=0.005,
        ),
    ),
    places=("all", "coil"),
    lines={
        "stiffness": "fraction *= most(1.0 - loss * cycles, 0.0);",
        "accept": """
            cycles += 0.5 * fabs(phase - phase_last);
            phase_last = phase;
        """,
    },
    signature="Stiffness when hot falls from cycle to cycle; the first cycle is right.",
    confused_with={
        "incomplete_transformation": "many cycles decide, never one pulse",
    },
    states=(State("cycles", "1", "cycles_before", "memory"), State("phase_last", "1", "phase", "memory")),
)
