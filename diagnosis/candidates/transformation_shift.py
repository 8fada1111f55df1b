"""Transformation temperatures of another alloy or heat treatment."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="transformation_shift",
    name="shifted transformation temperatures",
    unit="stiffness",
    law="shift = offset",
    source=(
        "K. Otsuka and C. M. Wayman, Shape Memory Materials, Cambridge 1998, section 1.2 (composition"
        " and heat treatment)"
    ),
    parameters=(
        Parameter(
            "offset",
            "K",
            -30.0,
            30.0,
            "a batch differs by some kelvins",
            meaning="shift of the transformation temperatures",
            plausible=20.0,
            plausible_reason="neighbouring alloys of one series (70 and 90 degC wires)",
            is_amplitude=True,
            negligible=2.0,
        ),
    ),
    places=("coil", "string", "all"),
    lines={
        "stiffness": "shift += offset;",
    },
    signature="Both branches of the loop displaced by the same temperature on one coil.",
    confused_with={
        "stress_dependent_transformation": "several loads decide",
        "sensor_bias": "a thermometer off by as much: current through R(T) or a soak decides",
    },
)
