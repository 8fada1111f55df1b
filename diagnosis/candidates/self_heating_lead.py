"""Leads that warm up and gain resistance."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="self_heating_lead",
    name="leads that warm up with the current",
    unit="electrical",
    law="R_string = R_string_0 + rise * I**2",
    source=(
        "Linear resistance of a lead at its own steady heating: R = R_0 (1 + alpha Theta I**2 R_0); "
        "C. Kittel, Introduction to Solid State Physics, 8th ed., Wiley 2005, chapter 6"
    ),
    parameters=(
        Parameter(
            "rise",
            "ohm/A^2",
            0.0,
            20.0,
            "metals gain resistance when they warm up",
            meaning="resistance that the leads gain per square of the current",
            plausible=4.4,
            of="resistance",
            plausible_reason=(
                "copper gains 0.0039/K, PTFE ends 180 K above a room: a lead as resistive as the coil gains 70 % of "
                "that at 0.4 A; one with more resistance than the coil is no lead"
            ),
            is_amplitude=True,
        ),
    ),
    places=("string",),
    lines={
        "string": "R_string += rise * I * I;",
    },
    signature="Current of a string too small, more than in proportion at high voltage.",
    confused_with={
        "contact_resistance": "several levels of voltage decide",
        "temperature_dependent_resistance": "no thermal time constant here",
    },
)
