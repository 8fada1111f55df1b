"""Material that never transforms."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="incomplete_transformation",
    name="incomplete transformation",
    unit="stiffness",
    law="stiffness = heating_d + (1 - retained) * (stiffness_0 - heating_d)",
    source="G. Eggeler et al., Mater. Sci. Eng. A 378 (2004) 24-33 (martensite kept by plastic strain)",
    parameters=(
        Parameter(
            "retained",
            "1",
            0.0,
            0.95,
            "between none and nearly all of the material",
            meaning="share of the rise of the stiffness that is missing",
            plausible=0.6,
            plausible_reason="a coil of which more than half never transforms is no actuator",
            is_amplitude=True,
            negligible=0.02,
        ),
    ),
    places=("coil", "string", "all"),
    lines={
        "stiffness": "fraction *= 1.0 - retained;",
    },
    signature="Rise of the stiffness too small by one share; cold stiffness and temperatures right.",
    confused_with={
        "base:heating_a": "acts on all coils at once",
        "fatigue": "many cycles decide",
    },
)
