"""What `cosim validate` says of size and time before a run."""

import pytest

from cosim.assemble import assemble
from cosim.estimate import Estimate, estimate
from cosim.run import run
from cosim.scenario import load_scenario


def of(name, *changes):
    assembly = assemble(load_scenario(name, changes))
    try:
        return estimate(assembly)
    finally:
        assembly.system.terminate()


def test_the_size_is_that_of_the_recorded_values():
    changes = ["time.stop=2 s", "time.checkpoint_step=2 s"]
    told = of("tclab", *changes)
    recorded = run(load_scenario("tclab", changes))
    assert told.outputs == recorded.sizes["time"]
    sizes = [values.nbytes for name, values in recorded.data_vars.items() if "." in name]
    assert told.bytes == sum(sizes) + 8 * told.outputs
    assert told.simulated == 2.0


def test_a_large_fabric_is_valid_and_told_to_take_long():
    """The pairs of its 79,800 links were looked for in a table of 47 GB."""
    small, large = of("passive_drape"), of("passive_drape", "fabric.rows=200", "fabric.columns=200")
    assert 5.0 < small.seconds < 200.0  # 24 links, 10,000 micro-steps: about 30 s
    assert large.seconds / small.seconds == pytest.approx(79_800 / 24, rel=0.05)


def test_a_cheaper_solver_is_told_to_take_less():
    whole = of("passive_drape").seconds
    assert of("passive_drape", "fabric.solver.iterations=100").seconds == pytest.approx(0.5 * whole, rel=0.01)
    assert of("passive_drape", "fabric.solver.friction_model=pyramid").seconds == pytest.approx(0.6 * whole, rel=0.01)


@pytest.mark.parametrize(
    ("seconds", "size", "words"),
    [
        (0.04, 300, "300 bytes; computing takes about 0.04 s, 50 simulated seconds a second"),
        (45.0, 2_400_000, "2.4 MB; computing takes about 45 s, 0.044 simulated"),
        (400.0, 3_000_000_000, "3 GB; computing takes about 6.7 min"),
        (1e6, 12_000, "12 kB; computing takes about 12 days"),
    ],
)
def test_numbers_are_told_as_people_read_them(seconds, size, words):
    assert words in str(Estimate(10, size, seconds, 2.0))
