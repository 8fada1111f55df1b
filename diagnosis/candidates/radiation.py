"""Heat radiated to the surroundings."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="radiation",
    name="thermal radiation",
    unit="thermal",
    law="heat = -emissivity_area * 5.670374419e-8 * (T**4 - T_ambient**4)",
    source=(
        "Stefan-Boltzmann law, small body in large surroundings; F. P. Incropera et al., Fundamentals"
        " of Heat and Mass Transfer, 7th ed., Wiley 2011, section 1.2.3; constant: CODATA 2018"
    ),
    parameters=(
        Parameter(
            "emissivity_area",
            "m^2",
            0.0,
            0.02,
            "emissivity from 0 to 1 times the surface: heat flows from hot to cold",
            meaning="area times emissivity",
            plausible=0.5,
            of="conductance",
            plausible_reason=(
                "free air carries at least 2 W/(m^2 K) (Incropera et al., table 1.1): the surface is h A / 2 at "
                "most, and emissivity 1 at most"
            ),
            is_amplitude=True,
        ),
    ),
    places=("all", "coil", "string"),
    lines={
        "heat": (
            "conductance += emissivity_area * 5.670374419e-8 * (T * T + T_ambient * T_ambient) * (T + T_ambient);"
        ),
    },
    signature="Hot plateaus too low while cool ones fit; grows with the third power of the temperature.",
    confused_with={
        "temperature_dependent_convection": "a class of its own with it, even with seven levels of power",
        "base:conductance": "a cold level decides",
    },
)
