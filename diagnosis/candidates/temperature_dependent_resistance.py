"""Resistance that changes linearly with temperature."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="temperature_dependent_resistance",
    name="temperature-dependent resistance",
    unit="electrical",
    law="R = R_0 + alpha * reference_resistance * (T - reference_temperature)",
    source="C. Kittel, Introduction to Solid State Physics, 8th ed., Wiley 2005, chapter 6 (linear range)",
    parameters=(
        Parameter(
            "alpha",
            "1/K",
            -0.003,
            0.006,
            "resistance stays positive from 100 K to 600 K; pure metals reach 4e-3",
            meaning="change of the resistance per kelvin, as a share of the reference resistance",
            plausible=0.0045,
            plausible_reason="tungsten 4.5e-3, copper 3.9e-3, NiTi 1e-3 at most",
            is_amplitude=True,
            negligible=5e-5,
        ),
    ),
    places=("coil", "string", "all"),
    lines={
        "resistance": "R += alpha * reference_resistance * (T - reference_temperature);",
    },
    signature="Current that drifts with the temperature under constant voltage, with the thermal time constant.",
    confused_with={
        "phase_dependent_resistance": "a hysteresis against temperature decides",
        "latent_heat": "a staircase of voltages decides",
    },
)
