"""Play in the spring that couples two parts (backlash of a transmission)."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="coupling_play",
    name="play between two coupled parts (backlash)",
    role=Role.COUPLED_VELOCITY,
    formula="stiffness * min(max(d, -play), play)",
    numbers=(
        Number("stiffness", "rate/d", "acceleration per distance apart that the play takes away", (0.5, 3.0)),
        Number("play", "d", "way to either side on which nothing couples them", (0.3, 1.0), 20.0),
        Number(
            "ratio",
            "d/d",
            "what the other part gets, as a multiple: the ratio of inertias",
            (0.3, 1.0, 3.0),
            1e3,
            1e-3,
        ),
    ),
    source="Nordin and Gutman, Automatica 38 (2002) 1633, dead-zone model",
    confused_with={
        "coupling_cubic_spring": "small and large torques decide",
    },
    reaction="-ratio * stiffness * min(max(d, -play), play)",
    reacts_on="v_2",
)
