"""The C source of a system: the stepper, and one function for each law and each state of a law."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from cosim.fmu.access import address_of
from diagnosis.models.coil_network.kernel.compiler import load
from diagnosis.models.systems.expression import PREAMBLE, to_c
from diagnosis.models.systems.placed import Placed


@dataclass(frozen=True)
class Compiled:
    """The loaded library.

    Args:
        library: The library.
    """

    library: ctypes.CDLL

    def address(self, name: str) -> int:
        """Of a function."""
        return address_of(getattr(self.library, name))


def compiled(
    laws: Sequence[Placed], known: Mapping[str, Mapping[str, str]], base: Sequence[Mapping[str, str]]
) -> Compiled:
    """Compile a system's laws.

    Args:
        laws: The laws.
        known: Component to the names that its laws may use, with what stands for them in C.
        base: Of each law, its constants as numbers in SI base units, as text.

    Raises:
        CompilerError: There is no compiler, or it refuses the source.
    """
    parts = [Path(__file__).with_name("system.c").read_text(encoding="utf-8"), PREAMBLE]
    arguments = "const double *e, const double *p, const double *z, const double *d"
    for number, (law, constants) in enumerate(zip(laws, base)):
        names = {**known[law.component], **constants}
        names |= {name: f"p[{i}]" for i, (name, _) in enumerate(law.numbers)}
        names |= {state.name: f"z[{i}]" for i, state in enumerate(law.states)}
        names |= {delay.name: f"d[{i}]" for i, delay in enumerate(law.delays)}
        functions = {"amount": law.formula}
        for i, state in enumerate(law.states):
            functions |= {f"rate_{i}": state.rate, f"start_{i}": state.start}
        for name, formula in functions.items():
            unused = "(void)e; (void)p; (void)z; (void)d;"
            parts.append(
                f'__attribute__((visibility("default"))) double law_{number}_{name}({arguments})\n'
                f"{{ {unused} return {to_c(formula, names)}; }}\n"
            )
    library = load("\n".join(parts))
    library.system_run.argtypes, library.system_run.restype = [ctypes.c_void_p], ctypes.c_int64
    library.system_rates.argtypes = [ctypes.c_void_p, ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p]
    library.system_rates.restype = ctypes.c_int
    return Compiled(library)
