"""Heat that evaporation takes from a wet surface or an open liquid."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="evaporation",
    name="evaporation of water",
    role=Role.TEMPERATURE,
    formula="-evaporation * exp(17.62 * (T - freezing) / (T - shift))",
    numbers=(Number("evaporation", "rate", "rate of cooling at 0 degC", (0.01, 0.1)),),
    source=(
        "Dalton: in proportion to the pressure of saturated vapour, by the equation of Magnus "
        "(WMO-No. 8, Guide to Instruments and Methods of Observation, annex 4.B)"
    ),
    constants={"freezing": ("T_abs", 273.15 / 300.0), "shift": ("T_abs", (273.15 - 243.12) / 300.0)},
    confused_with={
        "radiation": "a lid decides",
        "natural_convection": "a lid decides",
    },
)
