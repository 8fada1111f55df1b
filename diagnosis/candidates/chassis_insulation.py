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
            (0.1, 0.3, 0.5),
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
