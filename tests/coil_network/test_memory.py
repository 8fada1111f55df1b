"""What is given to C is checked: a length that does not fit is an error and nothing is read beyond an array's end."""

from __future__ import annotations

import numpy as np
import pytest

from diagnosis.models.coil_network.kernel.layout import CoilNetworkLayout
from diagnosis.models.coil_network.kernel.network import CoilNetwork
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters, pack
from diagnosis.models.coil_network.kernel.whiten import Whitening
from tests.coil_network.rigs import network_inputs

TWO, MANY = CoilNetworkLayout(2, (1, 1)), CoilNetworkLayout(40, (20, 20))
TIMES = {"temperature": np.array([0.0, 10.0, 20.0]), "current": np.array([5.0])}


def test_a_plan_or_packing_of_other_coils_is_refused():
    small, large = CoilNetwork(TWO), CoilNetwork(MANY)
    inputs = network_inputs()
    plan, packing = small.plan(inputs, TIMES), small.packing(frozenset())
    vectors = pack(packing, (), CoilNetworkParameters())[None]
    assert np.isfinite(small.run(plan, packing, vectors)).all()
    with pytest.raises(ValueError, match="the plan is one of"):
        small.run(large.plan(inputs, TIMES), packing, vectors)
    with pytest.raises(ValueError, match="the packing is one of"):
        small.run(plan, large.packing(frozenset()), vectors)
    with pytest.raises(ValueError, match="this packing needs"):
        small.run(plan, packing, vectors[:, :-1])


def test_vectors_in_single_precision_are_read_as_what_they_are():
    network = CoilNetwork(TWO)
    plan, packing = network.plan(network_inputs(), TIMES), network.packing(frozenset())
    vectors = pack(packing, (), CoilNetworkParameters())[None]
    found = network.run(plan, packing, vectors.astype(np.float32))
    assert found == pytest.approx(network.run(plan, packing, vectors), rel=1e-5)  # 24 bits


def test_traces_are_read_in_place_of_a_simulation_and_must_fit_the_plan():
    network = CoilNetwork(TWO)
    inputs = network_inputs()
    plan, packing = network.plan(inputs, TIMES), network.packing(frozenset())
    vectors = pack(packing, (), CoilNetworkParameters())[None]
    rows = len(inputs.time)
    traces = {"temperature": np.tile([300.0, 301.0], (rows, 1)), "current": np.full((rows, 2), 0.1)}
    for wrong, text in (
        ({"temperature": traces["temperature"]}, "there is no trace of current"),
        (traces | {"current": traces["current"][:-1]}, "the trace of current has the shape"),
        (traces | {"temperature": traces["temperature"][:, :1]}, "the trace of temperature has the shape"),
    ):
        with pytest.raises(ValueError, match=text):
            plan.read_traces(wrong)
    plan.read_traces({name: values.copy() for name, values in traces.items()})  # the plan keeps what it points to
    found = plan.split(network.run(plan, packing, vectors))
    assert found["temperature"][0].tolist() == [[300.0, 301.0]] * 3
    assert found["current"][0].tolist() == [[0.1, 0.1]]


def test_whitening_reads_no_sample_that_there_is_not():
    pick, weight, shares, lengths = np.array([0, 2, 4]), np.ones(3), np.zeros(2), np.array([2, 1])
    whitening = Whitening(pick, weight, shares, lengths)
    assert whitening.slopes(np.ones((2, 5)), 2).tolist() == [[-1.0] * 3] * 2
    with pytest.raises(ValueError, match="samples 0 to 4 of 4"):
        whitening.slopes(np.ones((2, 4)), 2)
    for into, factors in ((np.array([0]), np.ones(2)), (np.array([0, 1]), np.ones(1))):
        with pytest.raises(ValueError, match="2 directions"):
            whitening.slopes(np.ones((2, 5)), 2, into, factors)
    for wrong in ((pick[:2], weight, shares, lengths), (pick, weight, shares[:1], lengths)):
        with pytest.raises(ValueError, match="samples"):
            Whitening(*wrong)
