"""The examples of the documents run and say what they should."""

import runpy
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[1] / "docs" / "examples"


def test_the_example_of_one_coil_prints_the_terminal_temperatures_of_equation_4(capsys):
    runpy.run_path(str(EXAMPLES / "heat_one_coil.py"))
    lines = capsys.readouterr().out.splitlines()
    # U^2 / (h A R) + T_a with T_a = 22 degC; 40 s leave less than 0.1 degC of the rise.
    expected = {u: u**2 / (90 * 97.85e-6 * 2.2) + 22 for u in (0.5, 0.7, 0.8, 0.9, 1.0, 1.2)}
    assert len(lines) == 6
    for line, (voltage, temperature) in zip(lines, expected.items(), strict=True):
        assert line.startswith(f"{voltage:.1f} V: ")
        assert abs(float(line.split()[2]) - temperature) < 0.1


def test_the_example_of_an_own_fabric_reports_its_links(capsys):
    runpy.run_path(str(EXAMPLES / "own_fabric.py"))
    printed = capsys.readouterr().out
    assert printed.startswith("15 links; mean length by row [cm]: [3.0")
    lengths = [float(text) for text in printed.split("[")[-1].rstrip("]\n").split(", ")]
    assert len(lengths) == 5
    assert all(2.99 < length < 3.32 for length in lengths)
