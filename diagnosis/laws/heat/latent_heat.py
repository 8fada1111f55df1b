"""Latent heat of a phase change."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="latent_heat",
    name="latent heat of a phase change",
    role=Role.TEMPERATURE,
    formula="1 / (1 + latent * exp(-((T - change) / width) ** 2)) - 1",
    numbers=(
        Number("latent", "T/T", "heat capacity at the phase change, beyond the usual one, as a multiple", (1.0, 6.0)),
        Number("change", "T", "temperature of the phase change", (0.15, 0.4, 0.6, 0.85), 6.0, None, "T"),
        Number("width", "T", "temperature beside it at which a third of it is left", (0.15, 0.5), 4.0, 0.01),
    ),
    source="apparent heat capacity: Hashemi and Sliepcevich, Chem. Eng. Prog. Symp. Ser. 63 (1967) 34-41",
    confused_with={
        "second_mass": "the way back decides: a phase change holds at one temperature, in both directions",
    },
    is_share=True,
)
