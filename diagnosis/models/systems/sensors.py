"""What the sensors of a system may lack: as `diagnosis.search.pendulum_terms.SENSOR_TERMS`, sized by the readings."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnosis.recording.recording import Recording
from diagnosis.search.cosim_model import ComponentTerm
from diagnosis.search.pendulum_terms import SENSOR_TERMS
from diagnosis.search.problem import Term, TermParameter
from diagnosis.search.unit_law import UnitLaw

#: Times between two readings: largest lag, largest offset of a clock, and where a search begins.
LONGEST_LAG, LARGEST_OFFSET, LAGS, OFFSETS = 300.0, 50.0, (1.0, 8.0), (1.0, -1.0)
#: A zero that is off by the whole reading is that of a gauge that was taken for absolute; where a search begins, in
#: typical departures of the channel.
BIASES, WIDEST_BIAS = (0.1, -0.1), 5.0
#: Drifts over the longest recording with which a search begins, in typical departures, and the largest.
DRIFTS, MOST_DRIFT = (0.3, -0.3), 10.0
#: Where the end of a sensor's range is looked for: below the largest reading, in shares of all that it reads.
ENDS = (0.0, 0.1, 0.25)
#: Half of the width of a loop of hysteresis with which a search begins, in typical departures of the channel; what half
#: of the way is through it after a turn, and the largest of both.
LOOPS, TRAVELS, MOST_LOOP = (0.1, -0.1), (0.1, 0.5), 2.0
#: Departure from a straight line at a typical departure of the channel, in such, with which a search begins, and the
#: largest; where a characteristic touches the straight line, in shares of what the channel reads.
BENDS, MOST_BEND, CENTRES = (0.05, -0.05), 1.0, (0.0, 0.5, 1.0)
_SOURCE = "JCGM 200:2012, International Vocabulary of Metrology, "
_LOOP_SOURCE = "Brokate and Sprekels, Hysteresis and Phase Transitions, Springer 1996, section 2.1 (stop operator)"
_BIAS_CONFUSED = {
    "a start value": "the end of a run decides",
    "input_offset": "a recording at another level of that input, or without it",
}
_DRIFT_CONFUSED = {"ambient drift": "a second sensor beside it decides"}
_LOOP_CONFUSED = {
    "sensor_lag": "slow and fast courses decide: a loop is as wide in both",
    "input_play": "another sensor behind the same actuator decides",
}
_BEND_SOURCE = "Fraden, Handbook of Modern Sensors, Springer 2016, section 3.1 (nonlinearity)"
_BEND_CONFUSED = {"a law of what it measures": "a second sensor of another kind beside it decides"}
_RANGE_CONFUSED = {"upper_stop, lower_stop, input_saturation": "another sensor of the same quantity decides"}


@dataclass(frozen=True)
class Reach:
    """What a channel reads in all recordings together.

    Args:
        unit: SI unit.
        size: Root mean square of its departure from its mean.
        least: Smallest reading.
        most: Largest reading.
        noise: Deviation of its noise.
        duration: Of its longest recording [s].
        is_state: Whether it is a state of the model, or in proportion to one: the rig has nothing before the sensor.
    """

    unit: str
    size: float
    least: float
    most: float
    noise: float
    duration: float
    is_state: bool = False


def reach_of(recordings: Sequence[Recording], states: Container[str] = ()) -> dict[str, Reach]:
    """Channel to what it reads; channels without a reading are left out.

    Args:
        recordings: With the channels.
        states: Names of channels that are states of a Model Exchange FMU, or in proportion to one.
    """
    found = {}
    for name in dict.fromkeys(n for r in recordings for n in r.channels):
        channels = [r.channels[name] for r in recordings if name in r.channels and len(r.channels[name].values)]
        if not channels:
            continue
        values = np.concatenate([c.values for c in channels])
        noise = max(c.deviation for c in channels)
        duration = max(float(c.times[-1] - c.times[0]) for c in channels)
        size = max(float(np.std(values)), noise)
        ends = float(values.min()), float(values.max())
        found[name] = Reach(channels[0].unit, size, *ends, noise, duration, name in states)
    return found


def sensor_laws_of(channels: Mapping[str, Reach], sample_step: float, macro_step: float) -> list[UnitLaw]:
    """Gain, lag, clock, bias, hysteresis, linearity, drift and range of every channel.

    Args:
        channels: Their names, with what they read.
        sample_step: Typical time between two readings [s].
        macro_step: Of the co-simulation [s]; what is shorter is an error of the coupling.
    """
    found = []
    for channel, reach in channels.items():
        for identifier, (name, law, number) in SENSOR_TERMS.items():
            own = _sized(identifier, number, sample_step, macro_step)
            term = Term(identifier, channel, "measurement", (own,), law=law.replace("pi", "middle"))
            found.append(UnitLaw(ComponentTerm(term, channel, ()), name))
        found += _of_readings(channel, reach)
    return found


def _of_readings(channel: str, reach: Reach) -> list[UnitLaw]:
    """Laws whose numbers are of the unit that the channel reads."""

    def law(
        identifier: str, name: str, formula: str, numbers: tuple[TermParameter, ...], section: str, of: str = _SOURCE
    ) -> UnitLaw:
        term = Term(identifier, channel, "measurement", numbers, law=formula)
        is_of_either = identifier in _OF_EITHER and not reach.is_state
        return UnitLaw(ComponentTerm(term, channel, ()), name, of + section, _CONFUSED[identifier], is_of_either)

    found = [
        law("sensor_bias", "bias of a sensor", "value = truth + bias", (_bias(reach),), "4.20 (instrument bias)"),
        law(
            "sensor_clipping",
            "end of a sensor's range",
            "value = truth + clipped * (min(truth + noise, ceiling) - truth)",
            _range(reach, "ceiling", True),
            "4.7 (measuring interval)",
        ),
        law(
            "sensor_clipping_below",
            "lower end of a sensor's range",
            "value = truth + clipped * (max(truth + noise, floor) - truth)",
            _range(reach, "floor", False),
            "4.7 (measuring interval)",
        ),
    ]
    loop = "value = truth - half_width * turned; turned follows truth with a slope of 1/travel and stays within -1 to 1"
    found.append(law("sensor_hysteresis", "hysteresis of a sensor", loop, _loop(reach), "", _LOOP_SOURCE))
    bent = "value = truth + bend * (truth - centre)^2"
    found.append(law("sensor_bend", "sensor that is not linear", bent, _bend(reach), "", _BEND_SOURCE))
    if reach.duration > 0.0:
        what = "value = truth + drift * t, t from the first reading of a recording"
        found.append(law("sensor_drift", "drift of a sensor", what, (_drift(reach),), "4.21 (instrumental drift)"))
    return found


#: Laws of a form that a rigging, a gear or a membrane has as well as a sensor: the rig may do that between states and
#: an output that is none.
_OF_EITHER = ("sensor_hysteresis", "sensor_bend")
_CONFUSED: Mapping[str, Mapping[str, str]] = {
    "sensor_bias": _BIAS_CONFUSED,
    "sensor_drift": _DRIFT_CONFUSED,
    "sensor_clipping": _RANGE_CONFUSED,
    "sensor_clipping_below": _RANGE_CONFUSED,
    "sensor_hysteresis": _LOOP_CONFUSED,
    "sensor_bend": _BEND_CONFUSED,
}


def _bias(reach: Reach) -> TermParameter:
    most = max(abs(reach.least), abs(reach.most)) + WIDEST_BIAS * reach.size
    return TermParameter(
        "bias",
        reach.unit,
        -most,
        most,
        tuple(share * reach.size for share in BIASES),
        negligible=reach.noise,
        meaning="change of every reading",
    )


def _loop(reach: Reach) -> tuple[TermParameter, ...]:
    """Half of the width of the loop, to either side (a reading that is behind, or ahead), and half of the way."""
    most = MOST_LOOP * reach.size
    half = TermParameter(
        "half_width",
        reach.unit,
        -most,
        most,
        tuple(share * reach.size for share in LOOPS),
        negligible=reach.noise,
        meaning="half of the difference between readings that rise and that fall",
    )
    travel = TermParameter(
        "travel",
        reach.unit,
        min(reach.noise, 0.01 * reach.size),
        most,
        tuple(share * reach.size for share in TRAVELS),
        meaning="half of the way after a turn from one end of the loop to the other",
    )
    return half, travel


def _bend(reach: Reach) -> tuple[TermParameter, ...]:
    """Curvature of its characteristic, and the reading at which it is right with its slope."""
    per = 1.0 / reach.size
    bend = TermParameter(
        "bend",
        "1" if reach.unit in ("", "1") else f"1/({reach.unit})",
        -MOST_BEND * per,
        MOST_BEND * per,
        tuple(share * per for share in BENDS),
        negligible=reach.noise * per**2,
        meaning="departure from a straight line per square of the distance from the centre",
    )
    whole = reach.most - reach.least
    centre = TermParameter(
        "centre",
        reach.unit,
        reach.least - whole,
        reach.most + whole,
        tuple(reach.least + share * whole for share in CENTRES),
        meaning="reading at which it is right",
        is_reading=True,
    )
    return bend, centre


def _drift(reach: Reach) -> TermParameter:
    rate = reach.size / reach.duration
    return TermParameter(
        "drift",
        f"{reach.unit}/s",
        -MOST_DRIFT * rate,
        MOST_DRIFT * rate,
        tuple(share * rate for share in DRIFTS),
        negligible=reach.noise / reach.duration,
        meaning="change of the reading in a second",
    )


def _range(reach: Reach, name: str, is_upper: bool) -> tuple[TermParameter, ...]:
    """A switch, and the reading at which the range ends, which lies within what was read."""
    whole = reach.most - reach.least
    end, inward = (reach.most, -1.0) if is_upper else (reach.least, 1.0)
    starts = tuple(end + inward * (2.0 * reach.noise + share * whole) for share in ENDS)
    switch = TermParameter(
        "clipped", "1", 0.0, 1.0, (1.0,), is_switch=True, meaning="factor 0 or 1: whether the readings are cut off"
    )
    edge = TermParameter(
        name,
        reach.unit,
        reach.least - 3.0 * reach.noise,
        reach.most + 3.0 * reach.noise,
        starts,
        meaning="reading at which the range ends",
        is_reading=True,
    )
    return switch, edge


def _sized(identifier: str, number: TermParameter, step: float, macro_step: float) -> TermParameter:
    if identifier == "sensor_lag":
        return replace(
            number,
            upper=LONGEST_LAG * step,
            starts=tuple(step * s for s in LAGS),
            negligible=macro_step,
            plausible=LONGEST_LAG * step,
            plausible_reason="no sensor of a rig follows that late",
        )
    if identifier == "sensor_clock_offset":
        most = LARGEST_OFFSET * step
        return replace(
            number,
            lower=-most,
            upper=most,
            starts=tuple(step * s for s in OFFSETS),
            negligible=macro_step,
            plausible=most,
            plausible_reason="an offset of so many readings is seen in the table",
        )
    return number
