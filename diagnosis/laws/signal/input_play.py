"""Play (backlash) of an actuator."""

from diagnosis.laws.law import Law, Number, OwnState, Role

LAW = Law(
    identifier="input_play",
    name="play (backlash) of an actuator",
    role=Role.INPUT,
    formula="-min(max(u - follower, -play), play)",
    numbers=(Number("play", "u", "half width within which nothing passes after a turn", (0.05, 0.2), 3.0, 0.0),),
    source="Tao and Kokotovic, Adaptive Control of Systems with Actuator Nonlinearities, Wiley 1996, chapter 2",
    # The follower is dragged along at the edges of the play, behind a delay of a reading.
    constants={"step": ("u/rate", 1.0)},
    states=(
        OwnState("follower", "(max(u - follower - play, 0 * u) + min(u - follower + play, 0 * u)) / step", "u", "u"),
    ),
    confused_with={
        "input_dead_zone": "turns of the input away from 0 decide: a play opens at each of them",
    },
)
