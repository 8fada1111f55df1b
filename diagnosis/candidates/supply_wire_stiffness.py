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
            (3.0, 15.0, 60.0),
            is_amplitude=True,
            negligible=0.5,
        ),
        Parameter("reach", "m", -0.05, 0.05, "extension at which the wires are slack", (0.0, 0.003, -0.003)),
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
