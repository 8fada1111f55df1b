"""Order in which things that depend on each other can be dealt with, and which of them form rings."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def in_order(count: int, edges: Iterable[tuple[int, int]]) -> list[list[int]]:
    """Strongly connected groups of nodes, each after those that it depends on.

    Args:
        count: Number of nodes.
        edges: (before, after): node `after` depends on node `before`.

    Returns:
        Groups of node numbers; a group of more than one is a ring, and so is a single node with an edge to itself.

    Source: M. Sharir, A strong-connectivity algorithm and its applications in data flow analysis, Comput. Math. Appl. 7
    (1981) 67. SciPy has the same, but loading it takes a third of a second, which every command that opens a scenario
    would pay.

    >>> in_order(4, [(2, 1), (1, 2), (1, 0)])
    [[3], [1, 2], [0]]
    """
    after: list[list[int]] = [[] for _ in range(count)]
    before: list[list[int]] = [[] for _ in range(count)]
    for first, second in edges:
        after[first].append(second)
        before[second].append(first)
    left = [node for tree in _trees(range(count), after) for node in tree]
    return [sorted(tree) for tree in _trees(left[::-1], before)]


def _trees(roots: Iterable[int], following: Sequence[Sequence[int]]) -> list[list[int]]:
    """Nodes that each root leads to and no earlier root did, in the order in which a search in depth leaves them.

    With a stack instead of recursion, for chains of thousands of nodes.
    """
    is_seen = [False] * len(following)
    trees: list[list[int]] = []
    for root in roots:
        if is_seen[root]:
            continue
        is_seen[root] = True
        path, left = [(root, iter(following[root]))], []
        while path:
            new = next((n for n in path[-1][1] if not is_seen[n]), None)
            if new is None:
                left.append(path.pop()[0])
            else:
                is_seen[new] = True
                path.append((new, iter(following[new])))
        trees.append(left)
    return trees
