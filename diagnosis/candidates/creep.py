"""Slow stretch under load."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter, State

CANDIDATE = CandidateTerm(
    identifier="creep",
    name="creep under load",
    unit="mechanical",
    law="extension = extension_0 + crept; tau * d(crept) = compliance * tension - crept",
    source=(
        "Kelvin-Voigt element; W. N. Findley, J. S. Lai and K. Onaran, Creep and Relaxation of "
        "Nonlinear Viscoelastic Materials, North-Holland 1976, chapter 5"
    ),
    parameters=(
        Parameter(
            "compliance",
            "m/N",
            0.0,
            0.005,
            "a load stretches",
            meaning="extension that is crept at last, per newton",
            plausible=0.5,
            of="compliance",
            plausible_reason="metal below its yield stress creeps by less than half of what it stretches at once",
            is_amplitude=True,
        ),
        Parameter(
            "tau",
            "s",
            0.5,
            10000.0,
            "a time constant is positive",
            meaning="time constant of the creep",
            plausible=1000.0,
            plausible_reason="what creeps more slowly is a straight line over most of an hour",
        ),
    ),
    places=("all", "coil"),
    lines={
        "state": """
            crept_inflow = compliance * tension / tau;
            crept_rate = 1.0 / tau;
        """,
        "length": "extension += crept;",
    },
    signature="Extension grows slowly at constant temperature.",
    confused_with={
        "thermal_contraction": "cooling decides",
        "sensor_drift": "an unloaded coil decides",
    },
    states=(State("crept", "m", "0.0"),),
)
