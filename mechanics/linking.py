"""Are two link frames still hooked? Counted with the centre lines of their bars and arms."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from cosim.unit.protocol import Array


def corners(back: Array, axes: Array, bar_distance: Array, half_width: float) -> Array:
    """Corners of every link's centre line, in order around the frame.

    Args:
        back: Shape (link, 3), centres of the back bars [m].
        axes: Shape (link, 3, 3), columns are the links' x, y, z axes.
        bar_distance: Shape (link,) [m].
        half_width: Distance of the arms' axes from the middle [m].

    Returns:
        Shape (link, 4, 3) [m].
    """
    side = half_width * axes[:, :, 0]
    front = back + bar_distance[:, None] * axes[:, :, 1]
    return np.stack([back - side, back + side, front + side, front - side], axis=1)


def is_hooked(
    back: Array, axes: Array, bar_distance: Array, half_width: float, pairs: npt.NDArray[np.int64]
) -> npt.NDArray[np.bool_]:
    """Whether the frames of each pair pass through each other.

    Two closed curves that share no point are hooked if one crosses a surface spanned by the other an odd number of
    times (linking number modulo 2). A frame is flat and spans a rectangle, so the edges of the first link are taken to
    the coordinates of the second and counted where they cross z = 0 inside it.

    Args:
        back, axes, bar_distance, half_width: As in `corners`.
        pairs: Shape (pair, 2), indices of links.

    Returns:
        Shape (pair,).
    """
    first, second = pairs[:, 0], pairs[:, 1]
    apart = corners(back, axes, bar_distance, half_width)[first] - back[second, None, :]
    local = apart @ axes[second]
    begin, end = local, local[:, (1, 2, 3, 0)]
    z0, z1 = begin[..., 2], end[..., 2]
    is_across = (z0 > 0) != (z1 > 0)
    share = z0 / np.where(is_across, z0 - z1, 1.0)
    x = begin[..., 0] + share * (end[..., 0] - begin[..., 0])
    y = begin[..., 1] + share * (end[..., 1] - begin[..., 1])
    is_inside = (np.abs(x) < half_width) & (y > 0) & (y < bar_distance[second, None])
    return np.asarray((is_across & is_inside).sum(axis=1) % 2 == 1)
