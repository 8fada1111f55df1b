"""A coil that breaks at an instant."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="open_coil",
    name="coil open from an instant on",
    unit="electrical",
    law="R = R_0 / (1 - openness * step(t - instant))",
    source="Break of a series circuit (Kirchhoff's laws)",
    parameters=(
        Parameter(
            "openness",
            "1",
            0.0,
            1.0,
            "1 is a clean break, less a wire that is partly torn",
            meaning="share of the coil's conductance that is lost: 1 is a clean break",
            plausible=1.0,
            plausible_reason="a clean break",
            starts=(1.0, 0.9, 0.5),
            starts_reason="a clean break, ten times and twice the resistance: what is felt is 1 / (1 - openness)",
            is_amplitude=True,
        ),
        Parameter("instant", "s", -1000000.0, 1000000.0, "within the recordings", (10.0,)),
    ),
    places=("coil",),
    lines={
        "resistance": "R /= most(1.0 - openness * share_after(instant, t_begin, t_end), 1e-12);",
    },
    signature="Current of one string drops to nothing at an instant; all coils of the string cool from then on.",
    confused_with={
        "loose_contact": "voltage across the coil, or its heat where the break is partial, decides",
        "open_coil": "another coil of the same string: never from currents and temperatures after a clean break",
    },
    scope_reason="a wire that broke stays broken",
)
