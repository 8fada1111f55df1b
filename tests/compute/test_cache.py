"""Results that are kept on disk."""

from __future__ import annotations

import importlib
import os
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cosim.compute.cache import Cache
from cosim.compute.result import Result


@pytest.mark.parametrize("function", ["numpy.savez_compressed", "numpy.lib.format.write_array"])
def test_ctrl_c_while_a_result_is_written_stops_when_it_is_kept(
    function: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Inside an open archive, KeyboardInterrupt would end as the ValueError of a file that cannot be closed."""
    module, _, name = function.rpartition(".")
    real = getattr(importlib.import_module(module), name)
    calls = []

    def interrupted(*arguments: Any, **options: Any) -> Any:
        calls.append(function)
        if len(calls) == 1:
            os.kill(os.getpid(), signal.SIGINT)
        return real(*arguments, **options)

    monkeypatch.setattr(function, interrupted)
    handler = signal.getsignal(signal.SIGINT)
    cache = Cache(tmp_path)
    with pytest.raises(KeyboardInterrupt):
        cache.put("key", Result((np.arange(5.0),), "", 0.1))
    kept = cache.get("key")
    assert calls
    assert signal.getsignal(signal.SIGINT) is handler
    assert kept is not None
    assert np.array_equal(kept.arrays[0], np.arange(5.0))
