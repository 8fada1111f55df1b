"""Gravity that pulls at an angle."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="tilt",
    name="tilt against gravity",
    unit="mechanical",
    law="tension = load * (1 - loss)",
    source="Component of the weight along the coil: loss = 1 - cos(angle)",
    parameters=(
        Parameter(
            "loss",
            "1",
            0.0,
            0.9,
            "the component along the coil is never more than the weight",
            meaning="share of the load that does not pull along the coil",
            plausible=0.3,
            plausible_reason="a stand that leans by 45 degrees is seen: 1 - cos(45 degrees)",
            is_amplitude=True,
            negligible=0.01,
        ),
    ),
    places=("all", "string", "coil"),
    lines={
        "load": "tension *= 1.0 - loss;",
    },
    signature="Extension too small by one share at every temperature.",
    confused_with={
        "base:load": "never told apart: the same number",
        "supply_wire_stiffness": "two stiffnesses decide",
    },
)
