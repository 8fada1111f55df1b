"""The hooks of a model and the names that a candidate's C lines may use there, for people and for code generators."""

from __future__ import annotations

from collections.abc import Mapping

#: Hook: what it may change, when it comes.
HOOKS: Mapping[str, str] = {
    "resistance": "resistance of a coil, before the circuit is solved",
    "source": "voltage of a source, once in a step, before the circuit is solved",
    "string": "what lies in series with a string",
    "supply": "a source: its voltage, inner resistance and limit",
    "pairs": "heat between coils that touch: set `exchange` [W/K]; parameters end in `_a`, `_b`",
    "contacts": "heat between two coils that may touch: set `exchange` [W/K]; parameters are those of the pair",
    "heat": "heat balance of a coil, once its power is known",
    "state": "added states, continuous: set `<state>_inflow` and `<state>_rate` of d state/dt = inflow - rate * state",
    "gather": "sums over the coils for a shared state: set `gathered` and `weight`",
    "shared": "an added state that all coils share, as `state`, from the sums `gathered` and `weight`",
    "stiffness": "transformation temperature and transformed share, before the branches are found",
    "play": "the remembered stiffness, once the branches are known and before it is clipped to them",
    "load": "force on a coil, before its extension is found",
    "length": "extension, once force and stiffness are in balance",
    "accept": "memories, at the end of a step that stands",
    "channel": "a channel before it is sampled",
    "sensor": "a sampled value",
}

#: Name: unit and meaning. `T` is the temperature at the instant that the hook belongs to.
NAMES: Mapping[str, tuple[str, str]] = {
    "t": (
        "s",
        "time that the values belong to: middle of the step (resistance to state), its end (stiffness and after)",
    ),
    "t_begin": ("s", "begin of the step"),
    "t_end": ("s", "end of the step"),
    "dt": ("s", "length of the step; 0 when the start values are found"),
    "T": ("K", "temperature: over the step in resistance to state, at its end in stiffness and after"),
    "T_begin": ("K", "temperature at the begin of the step"),
    "T_end": ("K", "temperature at the end of the step; before the heat balance is solved, its begin"),
    "T_ambient": ("K", "temperature of the surroundings of the coil"),
    "P": ("W", "electrical power in the coil over the step; in `resistance` that of the step before"),
    "I": (
        "A",
        "current; in `resistance` and `string` that of the last solution; in `sensor` that of the channel's coil at "
        "the time of the sample, without the sensor's lag",
    ),
    "dTdt": ("K/s", "rate of the temperature: mean over the step; in `resistance` and `heat` over the step before"),
    "energy": ("J", "electrical energy since the start"),
    "phase": ("1", "share of austenite: (remembered - heating_d) / heating_a, from 0 to 1"),
    "stiffness": ("N/m", "spring constant; before `play` that of the step before"),
    "extension": ("m", "extension; before `length` that of the step before"),
    "extension_before": ("m", "extension at the end of the step before"),
    "tension": ("N", "force on the coil"),
    "heating": ("N/m", "heating branch at T"),
    "cooling": ("N/m", "cooling branch at T; the heating branch above the crossing"),
    "heating_before": ("N/m", "heating branch at the step before"),
    "cooling_before": ("N/m", "cooling branch at the step before"),
    "crossing": ("degC", "temperature above which both branches are one"),
    "shift": ("K", "shift of the transformation temperatures"),
    "remembered": ("N/m", "stiffness that the play operator remembers"),
    "R": ("ohm", "resistance of the coil"),
    "R_string": ("ohm", "resistance in series with the string"),
    "V": ("V", "voltage of the source"),
    "R_supply": ("ohm", "inner resistance of the source"),
    "I_limit": ("A", "limit of its current"),
    "limited": ("1", "share of the limit that holds: 0 none, 1 wholly"),
    "heat": ("W", "heat into the coil beside the electrical"),
    "conductance": ("W/K", "heat flow to the surroundings per kelvin"),
    "capacity": ("J/K", "heat capacity"),
    "scale": ("1", "factor of the stiffness"),
    "fraction": ("1", "factor of its rise above heating_d"),
    "added": ("N/m", "stiffness that is added"),
    "rest": ("m", "length without load"),
    "offset": ("s", "how late the channel's clock is"),
    "lag": ("s", "time constant of the channel's sensor"),
    "share": ("1", "share of another element in the channel"),
    "partner": ("1", "that element, from 0"),
    "value": ("of the channel", "sampled value"),
}

#: Functions that lines may call beside those of C's maths library (`exp`, `fabs`, `sqrt`).
FUNCTIONS: Mapping[str, str] = {
    "least(a, b)": "the smaller",
    "most(a, b)": "the greater",
    "clip(x, low, high)": "x, not below low and not above high",
    "share_after(instant, begin, end)": "share of the step after an instant, from 0 to 1",
    "network_relaxation(x)": "(1 - exp(-x)) / x, 1 at 0",
    "gompertz(a, b, c, d, celsius)": "a branch of equation (2)",
}
