"""Viscous damping of a coil's motion."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="viscous_damping",
    name="viscous damping",
    unit="mechanical",
    law="damping * d(extension) = tension - stiffness * extension",
    source="L. Meirovitch, Fundamentals of Vibrations, McGraw-Hill 2001, section 1.9",
    parameters=(
        Parameter(
            "damping",
            "N*s/m",
            0.0,
            10000.0,
            "damping only takes energy",
            meaning="force of the dashpot per speed",
            plausible=200.0,
            plausible_reason=(
                "stiff grease (100 Pa s at a rate of 10 1/s) on 1 cm^2 in a gap of 0.05 mm; air and the metal's own "
                "friction are far below"
            ),
            is_amplitude=True,
        ),
    ),
    places=("coil", "all", "string"),
    lines={
        "length": "extension += (extension_before - extension) * exp(-stiffness * dt / most(damping, 1e-9));",
    },
    signature="Extension follows with a time constant of damping over stiffness, both ways.",
    confused_with={
        "sensor_lag": "one channel's lag is the same at every stiffness",
        "creep": "a long rest decides",
    },
)
