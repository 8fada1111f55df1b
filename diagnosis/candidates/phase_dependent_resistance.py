"""Resistance that differs between martensite and austenite."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="phase_dependent_resistance",
    name="phase-dependent resistance",
    unit="electrical",
    law="R = R_0 + delta * reference_resistance * phase",
    source=(
        "V. Novak et al., Electric resistance variation of NiTi shape memory alloy wires in "
        "thermomechanical tests, Mater. Sci. Eng. A 481-482 (2008) 127-133"
    ),
    parameters=(
        Parameter(
            "delta",
            "1",
            -0.5,
            0.5,
            "resistance stays positive; NiTi about -0.13 (0.89 against 1.02 microohm m)",
            meaning="change of the resistance from martensite to austenite, as a share of the reference resistance",
            plausible=0.3,
            plausible_reason="NiTi about -0.13, with an R-phase to -0.25 (Novak et al. 2008)",
            is_amplitude=True,
            negligible=0.005,
        ),
    ),
    places=("coil", "string", "all"),
    lines={
        "resistance": "R += delta * reference_resistance * phase;",
    },
    signature="Current that follows the hysteresis of the stiffness, not the temperature.",
    confused_with={
        "temperature_dependent_resistance": "cooling at low current through the loop decides",
        "latent_heat": "currents decide",
    },
)
