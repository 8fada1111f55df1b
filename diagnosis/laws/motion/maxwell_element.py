"""Spring and damper in series (Maxwell)."""

from diagnosis.laws.law import Law, Number, OwnState, Role

LAW = Law(
    identifier="maxwell_element",
    name="spring and damper in series (Maxwell)",
    role=Role.VELOCITY,
    formula="-branch_stiffness * (x - slack)",
    numbers=(
        Number("branch_stiffness", "rate/x", "acceleration per stretch of its spring", (0.1, 0.5)),
        Number("relaxation_time", "x/v", "time in which it relaxes", (0.3, 3.0), 100.0, 0.01),
    ),
    source="Maxwell; Flugge, Viscoelasticity, Springer 1975, section 1.2",
    states=(OwnState("slack", "(x - slack) / relaxation_time", "x", "x"),),
    confused_with={
        "viscous_damping": "slow and fast motion decide: a damper alone never pushes back",
    },
)
