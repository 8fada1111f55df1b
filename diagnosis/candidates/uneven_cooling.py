"""Heat transfer that differs over the fabric."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="uneven_cooling",
    name="uneven cooling over the fabric",
    unit="thermal",
    law="heat = -hA * amount * (T - T_ambient)",
    source=(
        "Local heat transfer along a surface; F. P. Incropera et al., Fundamentals of Heat and Mass "
        "Transfer, 7th ed., Wiley 2011, section 7.2"
    ),
    parameters=(
        Parameter(
            "amount",
            "1",
            -0.6,
            0.6,
            "heat transfer stays positive at every coil",
            meaning="change of the heat transfer, as a share of h A",
            plausible=0.5,
            plausible_reason="edges that lose three times as much as the middle: (1 + 0.5) / (1 - 0.5)",
            is_amplitude=True,
            negligible=0.02,
        ),
    ),
    places=("row_gradient", "column_gradient", "column", "string_ends", "outer_strings", "edge"),
    fewest=3,
    lines={
        "heat": "conductance *= 1.0 + amount;",
    },
    signature=(
        "Plateaus that rise or fall steadily across rows or columns, or that differ at the clamps or the edge; time "
        "constants with them."
    ),
    confused_with={
        "base:conductance": "independent scatter has no pattern",
        "neighbour_heat": "strings powered one at a time decide",
    },
)
