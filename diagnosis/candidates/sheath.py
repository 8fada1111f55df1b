"""A layer around the coil through which its heat must pass."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter, State

CANDIDATE = CandidateTerm(
    identifier="sheath",
    name="layer around the coil (core and shell)",
    unit="thermal",
    law=(
        "heat = share * hA * (T - T_ambient) - share * g * (T - layer); C2 * d(layer) = g * (T - "
        "layer) - hA * (layer - T_ambient)"
    ),
    source=(
        "Lumped core and shell; F. P. Incropera et al., Fundamentals of Heat and Mass Transfer, 7th "
        "ed., Wiley 2011, sections 3.1 and 5.1"
    ),
    parameters=(
        Parameter(
            "share",
            "1",
            0.0,
            1.0,
            "part of the surface that is covered, from none to all",
            meaning="share of the coil's heat transfer that goes through the layer",
            plausible=1.0,
            plausible_reason="a coil can be covered wholly",
            is_amplitude=True,
        ),
        Parameter(
            "g",
            "W/K",
            0.0001,
            0.5,
            "heat flows from hot to cold",
            meaning="heat transfer from the coil to the layer",
            plausible=30.0,
            of="conductance",
            plausible_reason=(
                "0.1 mm of paint (0.2 W/(m K)) pass 2000 W/(m^2 K), 22 times the coil's own 90; thinner layers are none"
            ),
        ),
        Parameter(
            "C2",
            "J/K",
            0.001,
            100.0,
            "a heat capacity is positive",
            meaning="heat capacity of the layer",
            plausible=10.0,
            of="capacity",
            plausible_reason="a layer of ten times the coil's capacity is thicker than the wire: a body of its own",
        ),
    ),
    places=("all", "coil", "string"),
    lines={
        # The layer follows within the step, as in second_mass; `apart` is the part of g that it cannot follow.
        "heat": """
            const double held = network_relaxation((g + conductance) / C2 * dt);
            const double apart = (conductance + g * held) / (g + conductance);
            conductance = conductance * (1.0 - share) + share * g * apart;
            heat += share * g * held * (layer_begin - T_ambient);
        """,
        "state": """
            layer_inflow = (g * T + conductance * T_ambient) / C2;
            layer_rate = (g + conductance) / C2;
        """,
    },
    signature="Plateau higher and reached in two stages; cooling slow at its end.",
    confused_with={
        "second_mass": "the height of the plateau decides, if h A is known",
        "chassis_insulation": "the shape of the rise decides",
        "sensor_lag": "stiffness or current decide",
    },
    states=(State("layer", "K", "T"),),
)
