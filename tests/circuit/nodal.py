"""Modified nodal analysis in numpy: a second oracle, which knows nodes and elements but no strings.

Source: Ho, Ruehli and Brennan, IEEE Trans. Circuits Syst. 22 (1975) 504-509.
"""

import numpy as np


def solve(resistors, sources):
    """Node voltages and source currents of any linear network of resistors and voltage sources; node 0 is ground.

    `resistors` holds (node, node, ohm), `sources` (positive node, negative node, volt). Returns the voltage of every
    node [V], ground included, and the current out of the positive terminal of every source [A].
    """
    nodes = 1 + max(max(a, b) for a, b, _ in [*resistors, *sources])
    size = nodes - 1 + len(sources)
    matrix, right = np.zeros((size + 1, size + 1)), np.zeros(size + 1)  # the first row and column are ground's
    for a, b, ohm in resistors:
        matrix[a, a] += 1 / ohm
        matrix[b, b] += 1 / ohm
        matrix[a, b] -= 1 / ohm
        matrix[b, a] -= 1 / ohm
    for row, (plus, minus, volt) in enumerate(sources, nodes):
        matrix[row, plus] += 1
        matrix[row, minus] -= 1
        matrix[plus, row] -= 1
        matrix[minus, row] += 1
        right[row] = volt
    found = np.linalg.solve(matrix[1:, 1:], right[1:])
    return np.append(0.0, found[: nodes - 1]), found[nodes - 1 :]


def elements(network, voltage, resistance):
    """Resistors, sources and the two nodes of every coil. Shorted coils are sources of 0 V."""
    voltage, count = np.atleast_1d(voltage), 0
    resistors, sources, ends = [], [], []

    def node():
        nonlocal count
        count += 1
        return count

    def through(start, ohm):
        if ohm == 0:
            return start
        end = node()
        resistors.append((start, end, ohm))
        return end

    feeds = []
    for volt in voltage:
        terminal = node()
        sources.append((terminal, 0, volt))
        feeds.append(through(terminal, network.supply_resistance))
    opened = network.open_resistances()
    for string, coils in enumerate(network.coils_of_strings()):
        at = through(feeds[string if len(feeds) > 1 else 0], network.string_resistance)
        for coil in coils:
            after = 0 if coil == coils[-1] else node()
            ends.append((at, after))
            if coil in network.shorted_coils:
                sources.append((at, after, 0.0))
            else:
                resistors.append((at, after, opened.get(coil, resistance[coil - 1])))
            at = after
    return resistors, sources, np.array(ends)
