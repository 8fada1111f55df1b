"""Dead zone of an input."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="input_dead_zone",
    name="dead zone of an input",
    role=Role.INPUT,
    formula="-min(max(u, -zone), zone)",
    numbers=(Number("zone", "u", "half width of the zone in which nothing passes", (0.05, 0.2), 3.0, 0.0),),
    source="Tao and Kokotovic, Adaptive Control of Systems with Actuator Nonlinearities, Wiley 1996, chapter 2",
    confused_with={
        "input_gain": "inputs of different size decide",
    },
)
