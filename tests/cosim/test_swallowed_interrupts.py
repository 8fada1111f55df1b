"""Ctrl-C that arrives where Python cannot raise it: in a callback from C, in a finaliser."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

#: Ctrl-C arrives in the first message of ngspice.
IN_NGSPICE = """
import os, signal
from PySpice.Spice.NgSpice.Shared import NgSpiceShared

said = NgSpiceShared._send_char
sent = []


def with_ctrl_c(*args):
    if not sent:
        sent.append(True)
        os.kill(os.getpid(), signal.SIGINT)
        for _ in range(1000):  # Python raises KeyboardInterrupt here
            pass
    return said(*args)


NgSpiceShared._send_char = staticmethod(with_ctrl_c)

from cosim.cli import main

main()
"""

#: Ctrl-C arrives in `what`; prints "lost" if nothing of it is seen within a minute.
ALONE = """
import ctypes, os, signal, time
from cosim.interrupt import keep_swallowed_interrupts


def ctrl_c():
    os.kill(os.getpid(), signal.SIGINT)
    for _ in range(1000):
        pass


class Finalised:
    def __del__(self):
        ctrl_c()


keep_swallowed_interrupts()
try:
    {what}
    time.sleep(60)
    print("lost")
except KeyboardInterrupt:
    print("interrupted")
"""


def python(program, *args, folder):
    line = [sys.executable, "-c", program, *map(str, args)]
    return subprocess.run(line, cwd=folder, capture_output=True, text=True, check=False, timeout=300)


def test_ctrl_c_in_a_message_of_ngspice_stops_a_sweep(tmp_path):
    sweep = ROOT / "docs/examples/sweeps/voltage_and_convection.yaml"
    answer = python(IN_NGSPICE, "sweep", sweep, "--jobs", "1", "--out", tmp_path / "out", folder=ROOT)
    assert answer.returncode == 130, answer
    assert "interrupted" in answer.stderr
    assert "Traceback" not in answer.stderr


@pytest.mark.parametrize(
    "what", ["ctypes.CFUNCTYPE(None)(ctrl_c)()", "Finalised()"], ids=["callback from C", "finaliser"]
)
def test_ctrl_c_that_python_swallows_is_sent_again(tmp_path, what):
    answer = python(ALONE.format(what=what), folder=ROOT)
    assert (answer.stdout, answer.stderr) == ("interrupted\n", "")


def test_other_ignored_exceptions_are_still_printed():
    what = "ctypes.CFUNCTYPE(None)(lambda: 1 / 0)(); raise KeyboardInterrupt"
    answer = python(ALONE.format(what=what), folder=ROOT)
    assert answer.stdout == "interrupted\n"
    assert "ZeroDivisionError" in answer.stderr
