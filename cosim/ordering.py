"""Order in which things that depend on each other can be dealt with, and which of them form rings."""

from __future__ import annotations

from collections.abc import Iterable
from graphlib import TopologicalSorter

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components


def in_order(count: int, edges: Iterable[tuple[int, int]]) -> list[list[int]]:
    """Strongly connected groups of nodes, each after those that it depends on.

    Args:
        count: Number of nodes.
        edges: (before, after): node `after` depends on node `before`.

    Returns:
        Groups of node numbers; a group of more than one is a ring, and so is a single node with an edge to itself.

    >>> in_order(4, [(2, 1), (1, 2), (1, 0)])
    [[3], [1, 2], [0]]
    """
    pairs = list(edges)
    if not count:
        return []
    rows, columns = [a for a, _ in pairs], [b for _, b in pairs]
    graph = coo_array((np.ones(len(pairs)), (rows, columns)), shape=(count, count))
    number, labels = connected_components(graph, directed=True, connection="strong")
    before: dict[int, set[int]] = {label: set() for label in range(number)}
    for first, second in pairs:
        if labels[first] != labels[second]:
            before[int(labels[second])].add(int(labels[first]))
    members: dict[int, list[int]] = {label: [] for label in range(number)}
    for node, label in enumerate(labels):
        members[int(label)].append(node)
    return [members[label] for label in TopologicalSorter(before).static_order()]
