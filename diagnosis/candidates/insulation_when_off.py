"""Heat transfer that is weaker while the power is off."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter

CANDIDATE = CandidateTerm(
    identifier="insulation_when_off",
    name="weaker heat transfer while the power is off",
    unit="thermal",
    law="heat = hA * share * (T - T_ambient) * is_off",
    source=(
        "Active Chainmail Fabrics (Smart Mater. Struct. 26, 08LT02, 2017), equations (3) and (5): "
        "0.2226 1/s heating, 0.14 1/s cooling"
    ),
    parameters=(
        Parameter(
            "share",
            "1",
            0.0,
            0.95,
            "heat transfer stays positive",
            meaning="share of the heat transfer (h A) that is held back while the power is off",
            plausible=0.8,
            plausible_reason=(
                "a fan that runs with the power raises h from 10 to 50 W/(m^2 K) (Incropera et al., table 1.1): "
                "four fifths go with it"
            ),
            is_amplitude=True,
            negligible=0.02,
        ),
    ),
    places=("all", "coil", "string"),
    lines={
        "heat": "conductance *= P <= off_power ? 1.0 - share : 1.0;",
    },
    signature="Heating fits, cooling is slower than its own time constant says.",
    confused_with={
        "second_mass": "a long soak decides: a second mass also slows heating",
        "latent_heat": "cooling below the transformation decides",
    },
)
