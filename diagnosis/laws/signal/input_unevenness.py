"""An actuator that is stronger in one direction than in the other."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="input_unevenness",
    name="actuator that is stronger in one direction",
    role=Role.INPUT,
    formula="unevenness * abs(u)",
    numbers=(Number("unevenness", "u/u", "half of the difference of both factors", (0.05, -0.05), 0.9, None),),
    source="calibration of an actuator; valves and cylinders with one rod: Merritt, Hydraulic Control Systems, 1967",
    confused_with={
        "input_gain": "an input of both signs decides",
        "input_offset": "a small input decides",
    },
)
