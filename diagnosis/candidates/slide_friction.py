"""Coulomb friction in the slide of a coil."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="slide_friction",
    name="Coulomb friction in the slide",
    unit="mechanical",
    law="abs(tension - stiffness * extension) <= friction",
    source=(
        "B. Armstrong-Helouvry, P. Dupont and C. Canudas de Wit, Automatica 30 (1994) 1083-1138; "
        "quasi-static: a play operator"
    ),
    parameters=(
        Parameter(
            "friction",
            "N",
            0.0,
            5.0,
            "friction only takes energy",
            meaning="force that friction holds, of either direction",
            plausible=0.5,
            of="load",
            plausible_reason="dry metal has a coefficient of 0.5: even the whole load as normal force holds no more",
            is_amplitude=True,
            negligible=0.005,
        ),
    ),
    places=("coil", "all", "string"),
    lines={
        "length": (
            "extension = clip(extension_before, extension - friction / stiffness, extension + friction / stiffness);"
        ),
    },
    signature=("Extension stands still after each reversal, then lags by a constant force; a loop against stiffness."),
    confused_with={
        "backlash": "coils of different stiffness or load decide",
        "minor_loop_memory": "stiffness measured decides",
    },
)
