"""Lag of an actuator that is at rest where a recording begins, though its input is not."""

from dataclasses import replace

from diagnosis.laws.law import Role
from diagnosis.laws.signal import input_lag

LAW = replace(
    input_lag.LAW,
    identifier="input_lag_from_rest",
    name="lag of an actuator that begins at rest",
    role=Role.STARTED_INPUT,
    states=tuple(replace(state, start="0 * u") for state in input_lag.LAW.states),
    confused_with={"input_lag": "the begin decides: was the input on before, or switched on there"},
)
