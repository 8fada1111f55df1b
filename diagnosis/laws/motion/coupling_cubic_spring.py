"""A spring between two parts that hardens or softens."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="coupling_cubic_spring",
    name="spring between two parts that hardens or softens",
    role=Role.COUPLED_VELOCITY,
    formula="-stiffness_3 * d ** 3",
    numbers=(
        Number("stiffness_3", "rate/d**3", "acceleration per cube of the distance apart", (0.05, -0.05), 1e3, None),
        Number(
            "ratio",
            "d/d",
            "what the other part gets, as a multiple: the ratio of inertias",
            (0.3, 1.0, 3.0),
            1e3,
            1e-3,
        ),
    ),
    source="Duffing; Nayfeh and Mook, Nonlinear Oscillations, Wiley 1979, section 4.1",
    confused_with={
        "coupling_play": "small and large torques decide",
    },
    reaction="ratio * stiffness_3 * d ** 3",
    reacts_on="v_2",
)
