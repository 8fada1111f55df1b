"""Supply wires that act as a spring beside the coil."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="supply_wire_stiffness",
    name="stiffness of the supply wires",
    unit="mechanical",
    law="tension = stiffness * extension + wire * (extension - reach)",
    source="Hooke's law, springs in parallel",
    parameters=(
        Parameter(
            "wire",
            "N/m",
            0.0,
            300.0,
            "a spring that stores what it takes",
            meaning="spring constant of the wires",
            plausible=0.5,
            of="stiffness",
            plausible_reason=(
                "wires of half the coil's own stiffness carry a third of its load: nobody calls them wires"
            ),
            is_amplitude=True,
            negligible=0.5,
        ),
        Parameter(
            "reach",
            "m",
            -0.05,
            0.05,
            "extension at which the wires are slack",
            meaning="extension at which the wires pull with no force",
            plausible=1.0,
            of="stretch",
            plausible_reason="the wires are slack somewhere on the coil's way",
            is_position=True,
        ),
    ),
    places=("coil", "all", "string"),
    lines={
        "length": "extension -= wire * (extension - reach) / (stiffness + wire);",
    },
    signature="Extension too small when soft, little when stiff.",
    confused_with={
        "tilt": "two stiffnesses decide",
        "base:load": "two stiffnesses decide",
    },
)
