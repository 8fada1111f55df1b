"""A recording in which one channel alone reads so many times what it reads in the others: a sensor, or a number.

Another range, amplification, calibration or unit multiplies the readings of one sensor. A number of the rig seldom
acts on one output alone and by a factor; whether one does is tried, number by number.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import closing

import numpy as np

from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from diagnosis.check.beside import Beside, Compared
from diagnosis.check.input_runs import is_quick, readings_of
from diagnosis.check.unit_of_one import ALIKE, LEAST, ratio_to, slope, stated_unit
from diagnosis.judge.diagnosis import Doubt
from diagnosis.judge.doubts import ODD
from diagnosis.models.coil_network.kernel.compiler import CompilerError
from diagnosis.models.systems.fmu_layout import NotFast
from diagnosis.models.systems.run import SystemRuns

#: Powers of the factor by which a number is multiplied.
POWERS = (1.0, -1.0, 2.0, -2.0, 0.5, -0.5)
#: How far from the factor that is sought a number's may be (logarithms), and how far from 1 that on other channels.
REACHED, UNMOVED = 0.25, 0.1


def gain_of_one(one: Compared, others: Sequence[Compared]) -> Doubt | None:
    """A doubt about one channel that reads so many times what it reads in the others; all other channels are as there.

    It is serious where no number of the rig does the same.

    Args:
        one: A recording that stands out (`diagnosis.check.odd_one_out`).
        others: The other recordings.
    """
    found = _apart(one, others)
    if found is None:
        return None
    name, ratio = found
    does = _numbers_that_do(one, name, ratio)
    text = (
        f"beside the simulation its readings are {ratio:.3g} times those of the other recordings, which is the factor "
        "to no unit that is known here, and the other channels are as there: another range, amplification, "
        f"calibration or unit than {stated_unit(one, name)}"
    )
    if does is None:
        text += "; whether a number of the rig does the same was not tried"
    elif does:
        text += f", or another {' or '.join(does)} in this recording"
    remedy = f"what did this sensor read in, and with which calibration? Correct `channels.{name}` of this recording"
    z = abs(math.log(ratio)) / ALIKE
    is_serious = does == []
    kind = "unit" if is_serious else ODD
    return Doubt(one.recording.title, name, kind, text, remedy, is_serious, one.begin, one.end, z)


def _apart(one: Compared, others: Sequence[Compared]) -> tuple[str, float] | None:
    """The one channel whose slope in the simulation is another than in the others, and how many times."""
    ratios = {}
    for name, beside in one.channels.items():
        ratio = ratio_to(slope(beside), [slope(o.channels[name]) for o in others if name in o.channels])
        if ratio is None:
            return None
        ratios[name] = ratio
    apart = [n for n, r in ratios.items() if abs(math.log(r)) > LEAST]
    alike = [n for n, r in ratios.items() if abs(r - 1.0) <= ALIKE]
    return (apart[0], ratios[apart[0]]) if len(apart) == 1 and alike and len(ratios) == len(alike) + 1 else None


def _numbers_that_do(one: Compared, name: str, ratio: float) -> list[str] | None:
    """Numbers of the rig that multiply this channel alone by about the ratio; None where that cannot be tried."""
    if not is_quick(one.scenario):
        return None
    found = []
    try:
        with closing(SystemRuns(one.scenario)) as system:
            for component, number, _, value in system.numbers():
                if value == 0.0:
                    continue  # it has no multiples
                for power in POWERS:
                    results = system.with_number(component, number, value * ratio**power)
                    if results is not None and _does(
                        {n: (b, readings_of(results, b, one)) for n, b in one.channels.items()}, name, ratio
                    ):
                        found.append(f"{component}.{number}")
                        break
    except (InputError, NotFast, CompilerError):
        return None
    return found


def _does(channels: dict[str, tuple[Beside, Array]], name: str, ratio: float) -> bool:
    """Whether simulated readings are about so many times the stated ones of one channel, and unmoved of the others."""
    for other, (beside, moved) in channels.items():
        before = beside.simulated_there - np.mean(beside.simulated_there)
        size = float(before @ before)
        factor = float(before @ (moved - np.mean(moved))) / size if size > 0.0 else 1.0
        if other == name and (factor <= 0.0 or abs(math.log(factor / ratio)) > REACHED):
            return False
        if other != name and abs(factor - 1.0) > UNMOVED:
            return False
    return True
