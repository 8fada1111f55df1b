"""Transformation temperatures that rise with the load."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="stress_dependent_transformation",
    name="stress-dependent transformation temperature",
    unit="stiffness",
    law="shift = slope * tension",
    source=(
        "Clausius-Clapeyron relation; K. Otsuka and C. M. Wayman, Shape Memory Materials, Cambridge 1998, section 1.4"
    ),
    parameters=(
        Parameter(
            "slope",
            "K/N",
            0.0,
            40.0,
            "stress favours martensite, so the temperatures rise",
            meaning="shift of the transformation temperatures per newton",
            plausible=30.0,
            of="per_load",
            plausible_reason=(
                "7 MPa/K and 200 MPa, which NiTi bears for many cycles (Otsuka and Wayman, section 1.4): 30 K "
                "under the load"
            ),
            is_amplitude=True,
            negligible=0.5,
        ),
    ),
    places=("all", "coil"),
    lines={
        "stiffness": "shift += slope * most(tension, 0.0);",
    },
    signature="Stiffness rises and falls at higher temperatures on loaded coils; temperatures untouched.",
    confused_with={
        "transformation_shift": "several loads decide; never with one load",
    },
)
