"""A supply that heaters share and that gives way, where a scenario gives power and not voltage."""

from diagnosis.candidates.candidate import CandidateTerm, Parameter, State

CANDIDATE = CandidateTerm(
    identifier="shared_supply_droop",
    name="droop of the shared supply",
    unit="electrical",
    law="heat = -P * min(r * sum(P), 1)",
    source=(
        "Thevenin's theorem to first order in the load: a supply with V0 and R loses the share R * I / V0 of its"
        " voltage, so heaters that are switched across it lose 2 * R / V0**2 per watt of the sum; P. Horowitz and"
        " W. Hill, The Art of Electronics, 3rd ed., Cambridge 2015, section 1.2.5"
    ),
    parameters=(
        Parameter(
            "r",
            "1/W",
            0.0,
            0.5,
            "a passive supply gives way, it does not push",
            meaning="share of every coil's power that is lost per watt of all coils together",
            plausible=0.2,
            plausible_reason="2 R / V0^2 of 5 V behind 2.5 ohm: a USB port at the end of a long cable",
            is_amplitude=True,
        ),
    ),
    places=("powered",),
    fewest=2,
    lines={
        "heat": "heat -= P * least(r * drawn, 1.0);",
        "gather": "gathered = 1000.0 * P;",
        # Within a millisecond the sum is that of the step: a supply gives way at once.
        "shared": """
            drawn_inflow = gathered;
            drawn_rate = 1000.0;
        """,
    },
    signature="Every heater gets less than its own while another is on, at once and both alike.",
    confused_with={
        "neighbour_heat": "one heater alone decides: its own power makes it droop, its neighbour does not",
        "temperature_dependent_convection": "both on at once at low temperature decides",
    },
    states=(State("drawn", "W", "0.0", "shared"),),
)
