"""Surroundings that change at an instant."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="ambient_step",
    name="ambient temperature that changes at an instant",
    unit="thermal",
    law="T_ambient = T_ambient_0 + step_size * step(t - instant)",
    source="Heat balance with another surrounding temperature (Newton's law of cooling)",
    parameters=(
        Parameter(
            "step_size",
            "K",
            -30.0,
            30.0,
            "a door, a lamp, an air conditioner",
            meaning="change of the room's temperature",
            plausible=5.0,
            plausible_reason=(
                "a window that is opened mixes a fifth of the room's air with air 25 K colder: 5 K; no room "
                "jumps by more"
            ),
            is_amplitude=True,
            negligible=0.1,
        ),
        Parameter("instant", "s", -1000000.0, 1000000.0, "within the recordings", (10.0,)),
    ),
    places=("all", "string"),
    lines={
        "heat": "T_ambient += step_size * share_after(instant, t_begin, t_end);",
    },
    signature="All temperatures bend at one instant, each with its own time constant, without a change of power.",
    confused_with={
        "draught": "coils at different temperatures decide: a draught scales with T - T_ambient",
    },
    scope="day",
    scope_reason="the room of another day does not know of it",
)
