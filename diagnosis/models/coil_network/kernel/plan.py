"""What one call of the C function is given, mirrored field by field from plan.h."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from diagnosis.models.coil_network.kernel.inputs import CoilNetworkInputs
from diagnosis.models.coil_network.kernel.layout import QUANTITIES, Array, CoilNetworkLayout

_POINTER = ctypes.c_void_p
#: What record.c reports in place of a step where a sensor reads a current that nothing tells.
_NO_CURRENT = -2


class PlanLayout(ctypes.Structure):
    """`Plan` of plan.h."""

    _fields_ = [
        *(
            (n, ctypes.c_int64)
            for n in (
                "coils",
                "width",
                "strings",
                "sources",
                "steps",
                "is_midpoint",
                "pairs",
                "contacts",
                "has_circuit",
            )
        ),
        *(
            (n, _POINTER)
            for n in (
                "first",
                "pair_a",
                "pair_b",
                "contact_a",
                "contact_b",
                "time",
                "is_switch",
                "voltage",
                "ambient",
                "power",
                "given",
                "samples",
                "sample_time",
                "out_offset",
                "term_offset",
                "traces",
            )
        ),
    ]


class Plan:
    """A grid, inputs and samples, ready for any number of parameter sets.

    Args:
        layout: Coils and strings.
        inputs: What drives them.
        times: Quantity to its sample times [s], not falling.
        is_midpoint: Whether what depends on the temperature is taken at the middle of a step.

    Raises:
        ValueError: Inputs of the wrong shape, an unknown quantity, or sample times outside the grid.
    """

    def __init__(
        self, layout: CoilNetworkLayout, inputs: CoilNetworkInputs, times: Mapping[str, Array], is_midpoint: bool
    ) -> None:
        self.layout = layout
        self._time = inputs.time
        self._keep: list[npt.NDArray[Any]] = []
        #: `coil`, `string` or `channel` to the numbers of a set's output that belong to each of them, once asked for.
        self.owned: dict[str, list[npt.NDArray[np.int64]]] = {}
        _check_inputs(layout, inputs)
        self.times = _checked_times(layout, inputs, times)
        self.structure = PlanLayout(
            coils=layout.coils,
            width=layout.width,
            strings=len(layout.strings),
            sources=layout.sources,
            steps=len(inputs.ambient),
            is_midpoint=int(is_midpoint),
            pairs=len(layout.pairs),
            contacts=len(layout.contacts),
            has_circuit=int(bool(layout.strings) and inputs.power is None),
        )
        pairs, contacts = (np.array(p, dtype=np.int64).reshape(-1, 2) for p in (layout.pairs, layout.contacts))
        self._set("first", np.array(layout.first, dtype=np.int64))
        self._set("pair_a", pairs[:, 0])
        self._set("pair_b", pairs[:, 1])
        self._set("contact_a", contacts[:, 0])
        self._set("contact_b", contacts[:, 1])
        self._set("time", inputs.time)
        self._set("is_switch", inputs.is_switch.astype(np.int8))
        self._set("ambient", inputs.ambient)
        self._set("voltage", inputs.voltage if self.structure.has_circuit else None)
        self._set("power", self._padded(inputs.power))
        self._set("given", self._padded(inputs.temperature))
        self._set_samples()

    def _set(self, name: str, array: npt.NDArray[Any] | None) -> None:
        if array is not None:
            array = np.ascontiguousarray(array)
            self._keep.append(array)
        setattr(self.structure, name, None if array is None else array.ctypes.data)

    def _padded(self, values: Array | None) -> Array | None:
        if values is None:
            return None
        return np.pad(values, ((0, 0), (0, self.layout.width - self.layout.coils)), mode="edge")

    def _set_samples(self) -> None:
        counts, offsets, pointers = [], [], []
        self.out_size = 0
        for name in QUANTITIES:
            times = self.times.get(name)
            counts.append(0 if times is None else times.size)
            offsets.append(self.out_size)
            pointers.append(0 if times is None else times.ctypes.data)
            self.out_size += counts[-1] * self.layout.elements(name)
        self._set("samples", np.array(counts, dtype=np.int64))
        self._set("out_offset", np.array(offsets, dtype=np.int64))
        self._set("sample_time", np.array(pointers, dtype=np.uintp))
        self._offsets = dict(zip(QUANTITIES, offsets))

    def read_traces(self, traces: Mapping[str, Array]) -> None:
        """Let every run under this plan read traces in place of a simulation.

        Args:
            traces: Quantity to its values at the ends of the steps, shape (steps + 1, elements), SI; a flow stands in
                the row that its step ends with. All that is sampled, and `current` where a sensor reads it.

        Raises:
            ValueError: One that is sampled is missing, or has another shape.
        """
        missing = sorted(set(self.times) - set(traces))
        if missing:
            raise ValueError(f"there is no trace of {missing[0]}, which is sampled")
        pointers = np.zeros(len(QUANTITIES), dtype=np.uintp)
        for number, name in enumerate(QUANTITIES):
            if name not in traces:
                continue
            array = np.ascontiguousarray(traces[name], dtype=np.float64)
            shape = len(self._time), self.layout.elements(name)
            if array.shape != shape:
                raise ValueError(f"the trace of {name} has the shape {array.shape}; this plan needs {shape}")
            self._keep.append(array)
            pointers[number] = array.ctypes.data
        self._set("traces", pointers)

    def time_after(self, step: int) -> float:
        """End of a step [s] in which a simulation failed.

        Raises:
            ValueError: There was none: a sensor reads the current in its coil, and the strings' currents are unknown.
        """
        if step == _NO_CURRENT:
            raise ValueError(
                "a sensor reads the current in its coil, but the currents of the strings are unknown here: the network "
                "is given its power, or traces without `current`"
            )
        return float(self._time[step + 1])

    def split(self, out: Array) -> dict[str, Array]:
        """Views of an output, shape (sets, out_size), by quantity: shape (sets, samples, elements)."""
        views = {}
        for name, times in self.times.items():
            elements, begin = self.layout.elements(name), self._offsets[name]
            views[name] = out[:, begin : begin + times.size * elements].reshape(len(out), times.size, elements)
        return views


def _check_inputs(layout: CoilNetworkLayout, inputs: CoilNetworkInputs) -> None:
    steps = len(inputs.ambient)
    shapes = {
        "time": (inputs.time, (steps + 1,)),
        "ambient": (inputs.ambient, (steps,)),
        "voltage": (inputs.voltage, (steps, layout.sources)),
        "power": (inputs.power, (steps, layout.coils)),
        "temperature": (inputs.temperature, (steps + 1, layout.coils)),
    }
    for name, (array, shape) in shapes.items():
        if array is not None and array.shape != shape:
            raise ValueError(f"{name} has the shape {array.shape}; this network needs {shape}")
    if inputs.power is None and (inputs.voltage is None or not layout.strings):
        raise ValueError("give either the power of every coil, or strings and the voltage of their supply")


def _checked_times(
    layout: CoilNetworkLayout, inputs: CoilNetworkInputs, times: Mapping[str, Array]
) -> dict[str, Array]:
    checked = {}
    slack = 1e-9 * (inputs.time[-1] - inputs.time[0])
    for name, values in times.items():
        if name not in QUANTITIES:
            raise ValueError(f"a network records no {name}; it records {', '.join(QUANTITIES)}")
        has_no_circuit = inputs.power is not None and QUANTITIES[name].needs_circuit
        if layout.elements(name) == 0 or has_no_circuit:
            raise ValueError(f"{name} needs a circuit, and this network has none or is given its power")
        moments = np.ascontiguousarray(values, dtype=np.float64)
        if moments.ndim != 1 or np.any(np.diff(moments) < 0.0):
            raise ValueError(f"the sample times of {name} must not fall")
        if moments.size and not (inputs.time[0] - slack <= moments[0] and moments[-1] <= inputs.time[-1] + slack):
            raise ValueError(
                f"{name} is sampled from {moments[0]:g} s to {moments[-1]:g} s, outside the grid "
                f"({inputs.time[0]:g} s to {inputs.time[-1]:g} s)"
            )
        if moments.size:
            checked[name] = moments
    return checked
