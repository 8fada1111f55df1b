"""Heat transfer that changes at an instant."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="draught",
    name="draught from an instant on",
    unit="thermal",
    law="heat = -hA * amount * (T - T_ambient) * step(t - instant)",
    source=(
        "Newton's law of cooling with another coefficient; F. P. Incropera et al., Fundamentals of "
        "Heat and Mass Transfer, 7th ed., Wiley 2011, section 1.2.2"
    ),
    parameters=(
        Parameter(
            "amount",
            "1",
            -0.8,
            5.0,
            "heat transfer stays positive",
            meaning="change of the heat transfer after the instant, as a share of h A",
            plausible=4.0,
            plausible_reason=(
                "free air carries 10, a fan in a room 50 W/(m^2 K): fivefold (Incropera et al., table 1.1: 2 to "
                "25 free, 25 to 250 forced)"
            ),
            is_amplitude=True,
            negligible=0.02,
        ),
        Parameter("instant", "s", -1000000.0, 1000000.0, "within the recordings", (10.0,)),
    ),
    places=("all", "string", "coil"),
    lines={
        "heat": "conductance *= 1.0 + amount * share_after(instant, t_begin, t_end);",
    },
    signature="Temperatures bend at one instant in proportion to T - T_ambient.",
    confused_with={
        "ambient_step": "coils at different temperatures decide",
    },
    scope="day",
    scope_reason="a fan or a window is of that day; the rig has nothing of it",
)
