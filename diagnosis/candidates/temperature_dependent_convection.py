"""Convection that grows with the temperature difference."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="temperature_dependent_convection",
    name="temperature-dependent convection",
    unit="thermal",
    law="heat = -hA * slope * abs(T - T_ambient) * (T - T_ambient)",
    source=(
        "S. W. Churchill and H. H. S. Chu, Int. J. Heat Mass Transfer 18 (1975) 1049-1053 (free "
        "convection rises with the temperature difference), linearised"
    ),
    parameters=(
        Parameter(
            "slope",
            "1/K",
            0.0,
            0.05,
            "free convection rises with the temperature difference; heat flows from hot to cold",
            meaning="change of the heat transfer per kelvin above the surroundings, as a share of h A",
            plausible=0.02,
            plausible_reason=(
                "h rises at most with dT**n, n = 1/3 (turbulent, Churchill and Chu): at dT = 25 K the straight "
                "line has n / ((1 - n) dT) = 0.02 / K"
            ),
            is_amplitude=True,
            negligible=3e-4,
        ),
    ),
    places=("all", "coil", "string"),
    lines={
        "heat": "conductance *= 1.0 + slope * fabs(T - T_ambient);",
    },
    signature="Hot plateaus too low while cool ones fit; cooling faster at first and slower later.",
    confused_with={
        "radiation": "a class of its own with it, even with seven levels of power",
        "second_mass": "a soak decides",
    },
)
