"""Radiation between two parts."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="exchange_by_radiation",
    name="radiation between two parts",
    role=Role.COUPLED_TEMPERATURE,
    formula="-emission * (T ** 4 - T_2 ** 4)",
    numbers=(
        Number("emission", "rate/d/T_abs**3", "rate of cooling per difference of fourth powers", (0.05, 0.5)),
        Number(
            "ratio",
            "d/d",
            "what the other part gets, as a multiple: the ratio of heat capacities",
            (0.3, 1.0, 3.0),
            1e3,
            1e-3,
        ),
    ),
    source="Stefan and Boltzmann; Incropera, Fundamentals of Heat and Mass Transfer, Wiley 2007, section 13.2",
    confused_with={
        "exchange": "differences at a higher level decide",
    },
    reaction="ratio * emission * (T ** 4 - T_2 ** 4)",
    reacts_on="T_2",
)
