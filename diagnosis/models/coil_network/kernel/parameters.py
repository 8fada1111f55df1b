"""Parameters of a network, and their place in the vector that its C function reads."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.models.coil_network.kernel.layout import (
    AXIS_OF_FIELD,
    COIL_FIELDS,
    QUANTITY_FIELDS,
    SOURCE_FIELDS,
    STRING_FIELDS,
    Array,
    CoilNetworkLayout,
    FieldAxis,
)

_FIELDS = {**COIL_FIELDS, **STRING_FIELDS, **SOURCE_FIELDS, **QUANTITY_FIELDS}
_DEFAULTS = {n: default for n, (default, _) in _FIELDS.items()}


@dataclass(frozen=True)
class CoilNetworkParameters:
    """Values of a network's parameters, SI.

    Args:
        base: Name (see `layout.COIL_FIELDS`, `STRING_FIELDS`, `SOURCE_FIELDS`) to a number or an array over the coils,
            strings or sources; what is left out has its default.
        terms: Candidate to its parameters, each a number or an array over the candidate's axis. A candidate that is
            left out, or whose amplitude is 0 everywhere, is switched off. Parameters left out have their first start
            value; amplitudes left out are 0.
    """

    base: Mapping[str, float | Array] = field(default_factory=dict)
    terms: Mapping[str, Mapping[str, float | Array]] = field(default_factory=dict)

    def with_base(self, **values: float | Array) -> CoilNetworkParameters:
        """The same with other values of base parameters."""
        return replace(self, base={**self.base, **values})

    def with_term(self, identifier: str, **values: float | Array) -> CoilNetworkParameters:
        """The same with other values of one candidate's parameters."""
        own = {**self.terms.get(identifier, {}), **values}
        return replace(self, terms={**self.terms, identifier: own})


class Packing:
    """Where the values of each parameter lie in the vector of a set.

    Args:
        layout: The network's coils and strings.
        terms: Candidates compiled into the network.
        active: Identifiers of those that are switched on.
    """

    def __init__(self, layout: CoilNetworkLayout, terms: Sequence[CandidateTerm], active: frozenset[str]) -> None:
        self.layout = layout
        self.axes: dict[str, FieldAxis] = {}
        #: Begin, end without the padding, and end of each parameter.
        self._places: dict[str, tuple[int, int, int]] = {}
        self.size = 0
        for name, axis in AXIS_OF_FIELD.items():
            self._place(name, axis)
        self.term_offset = np.full(max(len(terms), 1), -1, dtype=np.int64)
        for number, term in enumerate(terms):
            if term.identifier in active:
                self.term_offset[number] = self.size
                for parameter in term.parameters:
                    self._place(f"{term.identifier}.{parameter.name}", term.axis)
        #: Numbers of the candidates that are switched on.
        self.switched_on = np.flatnonzero(self.term_offset >= 0).tolist()

    def _place(self, name: str, axis: FieldAxis) -> None:
        self.axes[name] = axis
        end = self.size + self.layout.stride(axis)
        self._places[name] = self.size, self.size + self.layout.size(axis), end
        self.size = end

    def where(self, name: str) -> slice:
        """Place of a parameter, without the padding.

        Raises:
            KeyError: There is no such parameter, or its candidate is switched off.
        """
        begin, end, _ = self._places[name]
        return slice(begin, end)

    def write(self, vector: Array, name: str, value: float | Array) -> None:
        """Write a parameter into a vector; padded coils repeat the last one."""
        begin, end, padded = self._places[name]
        array = value if isinstance(value, float) else np.asarray(value, dtype=np.float64)
        if not isinstance(array, float) and array.shape not in ((), (end - begin,)):
            raise ValueError(f"{name} has the shape {array.shape}; it needs one number or {end - begin}")
        if not (math.isfinite(array) if isinstance(array, float) else np.isfinite(array).all()):
            raise ValueError(f"{name} holds a value that is not finite")
        vector[begin:end] = array
        if begin < end < padded:
            vector[end:padded] = vector[end - 1]


def active_terms(terms: Sequence[CandidateTerm], parameters: CoilNetworkParameters) -> frozenset[str]:
    """Candidates whose amplitude is not 0 everywhere.

    Raises:
        KeyError: A candidate is not in the network.
    """
    if not parameters.terms:
        return frozenset()
    known = {t.identifier: t for t in terms if t.identifier in parameters.terms}
    for identifier in parameters.terms:
        if identifier not in known:
            raise KeyError(f"the candidate {identifier} is not in this network")

    def is_on(identifier: str, values: Mapping[str, float | Array]) -> bool:
        return bool(np.any(np.asarray(values.get(known[identifier].amplitude.name, 0.0))))

    return frozenset(i for i, values in parameters.terms.items() if is_on(i, values))


def pack_all(packing: Packing, terms: Sequence[CandidateTerm], sets: Sequence[CoilNetworkParameters]) -> Array:
    """Vectors of sets, shape (sets, packing.size); values that a set shares with the first are packed once.

    Raises:
        KeyError: See `pack`, and so is the other.
        ValueError: A value does not fit.
    """
    found = np.empty((len(sets), packing.size))
    first = sets[0].base
    base = pack(packing, (), sets[0])
    for vector, parameters in zip(found, sets):
        vector[:] = base
        own = parameters.base
        if own.keys() != first.keys():
            vector[:] = pack(packing, (), parameters)
        else:
            for name, value in own.items():
                if value is not first[name]:
                    packing.write(vector, name, value)
        _pack_terms(packing, terms, parameters, vector)
    return found


def pack(packing: Packing, terms: Sequence[CandidateTerm], parameters: CoilNetworkParameters) -> Array:
    """Vector of one set, shape (packing.size,).

    Raises:
        KeyError: An unknown parameter.
        ValueError: A wrong shape or a value that is not finite.
    """
    unknown = sorted(set(parameters.base) - set(_DEFAULTS))
    if unknown:
        raise KeyError(f"{unknown[0]} is no parameter of the network; there are {', '.join(_DEFAULTS)}")
    vector = np.zeros(packing.size)
    for name, default in _DEFAULTS.items():
        packing.write(vector, name, parameters.base.get(name, default))
    _pack_terms(packing, terms, parameters, vector)
    return vector


def _pack_terms(
    packing: Packing, terms: Sequence[CandidateTerm], parameters: CoilNetworkParameters, vector: Array
) -> None:
    for number in packing.switched_on if terms else ():
        term = terms[number]
        values = parameters.terms.get(term.identifier, {})
        surplus = sorted(set(values) - {p.name for p in term.parameters})
        if surplus:
            raise KeyError(f"{term.identifier} has no parameter {surplus[0]}")
        for p in term.parameters:
            default = 0.0 if p.is_amplitude else p.starts[0]
            packing.write(vector, f"{term.identifier}.{p.name}", values.get(p.name, default))
