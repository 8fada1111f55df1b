"""One thermal mass, the chassis, that all coils share."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter, State

CANDIDATE = CandidateTerm(
    identifier="shared_mass",
    name="thermal mass shared by all coils (chassis)",
    unit="thermal",
    law=("heat = -g * (T - chassis); C_chassis * d(chassis) = sum(g * (T - chassis)) - loss * (chassis - T_ambient)"),
    source=(
        "Lumped capacitances; F. P. Incropera et al., Fundamentals of Heat and Mass Transfer, 7th "
        "ed., Wiley 2011, chapter 5"
    ),
    parameters=(
        Parameter(
            "g",
            "W/K",
            0.0,
            0.05,
            "heat flows from hot to cold",
            meaning="heat transfer from each coil to the chassis",
            plausible=3.0,
            of="conductance",
            plausible_reason="pins and eyes pass less than a few times what the whole surface gives to the air",
            is_amplitude=True,
        ),
        Parameter(
            "C_chassis",
            "J/K",
            0.2,
            10000.0,
            "a heat capacity is positive",
            meaning="heat capacity of the chassis",
            plausible=1000.0,
            of="capacity",
            plausible_reason="a steel frame of 0.1 kg (46 J/K) for coils of 0.04 J/K; a heavier one hardly warms",
        ),
        Parameter(
            "loss",
            "W/K",
            0.0,
            10.0,
            "heat flows from hot to cold",
            meaning="heat transfer from the chassis to the surroundings",
            plausible=30.0,
            of="conductance",
            plausible_reason="a frame has some tens of times the surface of a coil",
            count=2,
        ),
    ),
    places=("all", "string"),
    fewest=2,
    lines={
        "heat": """
            conductance += g;
            heat += g * (chassis - T_ambient);
        """,
        "gather": """
            gathered = g * T;
            weight = g;
        """,
        "shared": """
            chassis_inflow = (gathered + loss * T_ambient) / C_chassis;
            chassis_rate = (weight + loss) / C_chassis;
        """,
    },
    signature="Unpowered coils creep up together with the powered ones, all with one slow time constant.",
    confused_with={
        "second_mass": "one string alone powered decides",
        "neighbour_heat": "distant coils decide",
        "ambient_drift": "a rest before decides",
    },
    states=(State("chassis", "K", "T", "shared"),),
)
