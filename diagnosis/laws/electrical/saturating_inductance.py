"""An inductance whose iron saturates."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="saturating_inductance",
    name="inductance whose iron saturates",
    role=Role.CURRENT,
    formula="saturation * i * i",
    numbers=(
        Number(
            "saturation",
            "1/i**2",
            "share by which the differential inductance falls per square of the current: L / (1 + saturation i^2)",
            (0.3, 2.0),
        ),
    ),
    source="flux L i_s atan(i / i_s), so dflux/di = L / (1 + (i / i_s)^2): Fitzgerald, Electric Machinery, "
    "McGraw-Hill 2003, section 1.3",
    confused_with={
        "series_resistance": "how fast a small current and a large one rise decides; resistance decides where they end",
    },
    is_share=True,
)
