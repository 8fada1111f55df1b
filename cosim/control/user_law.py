"""A law of a user's own: a Python file with a function `command`, and `begin` where it remembers something."""

from __future__ import annotations

import importlib.util
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from cosim.control.laws import Memory, Sample
from cosim.unit.protocol import Array


class UserLaw:
    """Calls `command(sample, memory, **parameters)` of a file.

    Args:
        path: The file.
        parameters: Passed by name, as numbers in the units in which they were written.

    Raises:
        ValueError: The file cannot be read, is no Python, or has no function `command`.
    """

    def __init__(self, path: Path, parameters: Mapping[str, float]) -> None:
        self._path, self._parameters = path, dict(parameters)
        self._module = _loaded(path)

    def begin(self, groups: int) -> dict[str, Array]:
        """See `cosim.control.laws.Law`."""
        begin = getattr(self._module, "begin", None)
        memory = {} if begin is None else self._called(begin, groups)
        if not isinstance(memory, dict):
            raise ValueError(f"{self._path.name}: `begin` must return a mapping of names to arrays")
        return {name: np.asarray(value, dtype=np.float64) for name, value in memory.items()}

    def demand(self, sample: Sample, memory: Memory, low: float, high: float) -> Array:
        """See `cosim.control.laws.Law`."""
        found = self._called(self._module.command, sample, memory, **self._parameters)
        return np.broadcast_to(np.asarray(found, dtype=np.float64), sample.measured.shape)

    def _called(self, function: Any, *arguments: Any, **named: Any) -> Any:
        try:
            return function(*arguments, **named)
        except Exception as error:  # the user's own code
            raise ValueError(f"{self._path.name}: {type(error).__name__}: {error}") from error


def _loaded(path: Path) -> ModuleType:
    if not path.is_file():
        raise ValueError(f"there is no file `{path}`")
    spec = importlib.util.spec_from_file_location(f"user_law_{path.stem}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except Exception as error:  # the user's own code
        raise ValueError(f"`{path.name}` cannot be loaded: {type(error).__name__}: {error}") from error
    if not callable(getattr(module, "command", None)):
        raise ValueError(f"`{path.name}` has no function `command(sample, memory, ...)`")
    return module
