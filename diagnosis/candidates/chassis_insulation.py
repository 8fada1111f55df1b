"""Part of the surface covered by the chassis."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="chassis_insulation",
    name="insulation by the chassis",
    unit="thermal",
    law="heat = hA * share * (T - T_ambient)",
    source=(
        "Active Chainmail Fabrics (Smart Mater. Struct. 26, 08LT02, 2017), section 2.3: the chassis insulates the coils"
    ),
    parameters=(
        Parameter(
            "share",
            "1",
            0.0,
            0.95,
            "a covered surface loses less heat, and never none",
            meaning="share of the heat transfer (h A) that is held back",
            plausible=0.8,
            plausible_reason=(
                "10 mm of still air (0.026 W/(m K)) before the surface still pass 2.6 W/(m^2 K), a fifth of the "
                "10 to 15 of a free surface with radiation"
            ),
            is_amplitude=True,
            negligible=0.02,
        ),
    ),
    places=("coil", "string", "all"),
    lines={
        "heat": "conductance *= 1.0 - share;",
    },
    signature="Plateau higher and both time constants longer, by the same share, in all phases of a run.",
    confused_with={
        "base:conductance": "a prior on h A is all that tells them apart",
        "uneven_cooling": "its pattern over the fabric",
    },
)
