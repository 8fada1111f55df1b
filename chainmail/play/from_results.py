"""A fabric to show, from the results of a run."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt
import xarray as xr

from chainmail.measures import one_start
from chainmail.play.film import Curve, Fabric, Field, Shape
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array

Integers = npt.NDArray[np.int64]
#: Frames of a film, if not said otherwise.
FRAMES = 1000
#: Zero of the Celsius scale [K].
_ZERO = 273.15
#: Quantity of a coil to its name on the page, shown unit, factor and shift.
_FIELDS = {
    "temperature": ("°C", 1.0, -_ZERO),
    "stiffness": ("N/mm", 1e-3, 0.0),
    "tension": ("N", 1.0, 0.0),
    "extension": ("mm", 1e3, 0.0),
}
#: Nothing of a fabric is farther away [m].
_FARTHEST = 1000.0
#: Links that are this evenly spaced are woven and have not moved yet [m].
_EVEN = 1e-7
#: Variables that make a fabric.
_POSE = ("position", "orientation", "link_length", "marker_position")


def fabric_of(results: xr.Dataset, source: object, frames: int = FRAMES) -> Fabric:
    """The fabric of a run.

    Args:
        results: As `cosim.run.run` returns and results.nc holds; of an ensemble one start is shown, with a note.
        source: Named in errors.
        frames: At most this many frames are kept, evenly spaced; the last output is always among them.

    Raises:
        InputError: There is no fabric, no frame, or a pose is not finite.
    """
    starts, results = results.sizes.get("start", 1), one_start(results)
    names = _fabrics(results)
    if not names:
        raise InputError(
            source,
            "",
            "these results hold no fabric: there is no component with position and orientation of links",
            "play the run of a scenario with a component of kind bullet_fabric (docs/scenarios.md)",
        )
    name, count = names[0], results.sizes["time"]
    if not count:
        raise InputError(source, "time", "these results hold no output time", "run the scenario again")
    kept = _kept(count, frames)
    shown = results.isel(time=kept)
    pose = {part: np.asarray(shown[f"{name}.{part}"].values, dtype=np.float64) for part in _POSE}
    for part, values in pose.items():
        _check_finite(source, f"{name}.{part}", values, shown["time"].values)
        if np.abs(values).max(initial=0.0) > _FARTHEST:
            raise InputError(
                source,
                f"{name}.{part}",
                f"it reaches {np.abs(values).max():.4g} m, far off any fabric",
                "the run diverged: run it with a smaller solver.micro_step",
            )
    moved = np.ptp(pose["position"], axis=0).max(axis=1)
    row, place = (_coordinate(results, name, label, source) for label in ("link_row", "link_place"))
    fields, curves = list(_fields(shown, name, pose["link_length"])), list(_curves(shown, name))
    return Fabric(
        title=str(results.attrs.get("title", "")) or "run",
        name=name,
        shape=_shape(pose, row, place, source),
        times=np.asarray(shown["time"].values, dtype=np.float64),
        position=pose["position"],
        orientation=_continuous(pose["orientation"]),
        link_length=pose["link_length"],
        row=row,
        place=place,
        is_held=(moved == 0.0) & (count > 1),
        fields=tuple(q for q in fields if np.isfinite(q.values).all()),
        curves=tuple(c for c in curves if _is_finite(c)),
        notes=(*_notes(results, names, kept, starts), *_left_out(fields, curves)),
    )


def _fabrics(results: xr.Dataset) -> list[str]:
    named = [str(v).removesuffix(".orientation") for v in results.data_vars if str(v).endswith(".orientation")]
    return [n for n in named if "time" in results.dims and all(f"{n}.{part}" in results for part in _POSE)]


def _kept(count: int, frames: int) -> Integers:
    """Numbers of the outputs that become frames: every n-th, as uneven steps would shake, and the last."""
    kept = np.arange(0, count, max(math.ceil((count - 1) / max(frames - 1, 1)), 1))
    return kept if kept[-1] == count - 1 else np.append(kept, count - 1)


def _check_finite(source: object, name: str, values: Array, times: Array) -> None:
    bad = np.argwhere(~np.isfinite(values.reshape(len(values), values.shape[1], -1)).all(axis=2))
    if bad.size:
        frame, element = (int(i) for i in bad[0])
        raise InputError(
            source,
            name,
            f"element {element + 1} is not finite at t = {times[frame]:.6g} s",
            "the run diverged: run it with a smaller solver.micro_step",
        )


def _coordinate(results: xr.Dataset, name: str, label: str, source: object) -> Integers:
    """A coordinate of links; that of a second fabric has the dimension's name before its own."""
    links = results[f"{name}.link_length"].dims[1]
    found = [c for c in results.coords if str(c).endswith(label) and results[c].dims == (links,)]
    if not found:
        raise InputError(
            source,
            label,
            f"the links of `{name}` have no such coordinate",
            "give the results as `cosim.run.run` returns them",
        )
    return np.asarray(results[found[0]].values, dtype=np.int64)


def _shape(pose: dict[str, Array], row: Integers, place: Integers, source: object) -> Shape:
    """Size of a link, from what the results hold.

    The markers sit on the two bars of the last link of a row, at its outer side: their distance is L, and their middle
    lies w / 2 from the middle of the link. The pitch of the columns is w + (w - 4 d) / 3, to be read where the links
    are woven flat: in the first frame, and in held rows in any (`mechanics.fabric`).
    """
    position, marker = pose["position"][0], pose["marker_position"][0].reshape(-1, 2, 3)
    last = np.flatnonzero(place == place.max())
    distance = np.linalg.norm(marker[:, 1] - marker[:, 0], axis=1)
    offset = float(np.median(distance - pose["link_length"][0, last]))
    width = 2 * float(np.median(np.linalg.norm(marker.mean(axis=1) - position[last], axis=1)))
    is_first = row == 1
    across, is_a = position[is_first, 0], place[is_first] % 2 == 1
    pitch = float(across[is_a][-1] - across[is_a][0]) / (np.count_nonzero(is_a) - 1)
    diameter = (width - 3 * (pitch - width)) / 4
    is_held = len(pose["position"]) > 1 and not np.ptp(pose["position"][:, is_first][:, is_a], axis=0).any()
    is_even = np.ptp(np.diff(across)) < _EVEN
    if not (is_held or is_even) or not 0 < diameter <= width / 4 * (1 + 1e-6):
        raise InputError(
            source,
            "",
            "its first frame is not a woven fabric, so that the thickness of its bars is unknown",
            "give the whole results of a run, from its first output on",
        )
    return Shape(diameter, width, offset)


def _continuous(orientation: Array) -> Array:
    """The same rotations with signs such that no quaternion jumps; each of length 1."""
    unit = orientation / np.linalg.norm(orientation, axis=2, keepdims=True)
    turn = np.where(np.sum(unit[1:] * unit[:-1], axis=2) < 0.0, -1.0, 1.0)
    unit[1:] *= np.cumprod(turn, axis=0)[:, :, None]
    return np.asarray(unit)


def _fields(shown: xr.Dataset, name: str, link_length: Array) -> Iterator[Field]:
    coils = 2 * link_length.shape[1]
    for quantity, (unit, factor, shift) in _FIELDS.items():
        own = [f"{name}.{quantity}"] if f"{name}.{quantity}" in shown else []
        others = [str(v) for v in shown.data_vars if str(v).endswith(f".{quantity}")]
        for variable in [*own, *others]:
            values = shown[variable]
            if values.ndim == 2 and values.shape[1] == coils:
                yield Field(quantity, unit, factor * values.values.astype(np.float64) + shift)
                break
    yield Field("link length", "mm", 1e3 * np.repeat(link_length, 2, axis=1))


def _curves(shown: xr.Dataset, name: str) -> Iterator[Curve]:
    """Supply, temperature, curvature and length, whatever of them a run has."""
    times = np.asarray(shown["time"].values, dtype=np.float64)
    voltage = _driven(shown)
    if voltage is not None:
        values = shown[voltage].values.reshape(len(times), -1)
        for k in range(values.shape[1]):
            yield Curve("Supply voltage", "V", f"string {k + 1}" if values.shape[1] > 1 else "", times, values[:, k])
    for ending, plot, unit in ((".supply_current", "Supply current", "A"), (".supply_power", "Supply power", "W")):
        for variable in [v for v in shown.data_vars if str(v).endswith(ending) and shown[v].ndim == 1][:1]:
            yield Curve(plot, unit, "", times, shown[variable].values)
    for variable in [v for v in shown.data_vars if str(v).endswith(".temperature") and shown[v].ndim == 2][:1]:
        kelvin = shown[variable].values - _ZERO
        yield Curve("Coil temperature", "°C", "", times, kelvin.mean(axis=1), kelvin.min(axis=1), kelvin.max(axis=1))
    for quantity, plot, unit, factor in (
        ("max_curvature", "Maximum curvature", "1/m", 1.0),
        ("fabric_length", "Fabric length", "mm", 1e3),
    ):
        if f"{name}.{quantity}" in shown:
            yield Curve(plot, unit, "", times, factor * shown[f"{name}.{quantity}"].values)


def _is_finite(curve: Curve) -> bool:
    return all(np.isfinite(v).all() for v in (curve.values, curve.lower, curve.upper) if v is not None)


def _left_out(fields: list[Field], curves: list[Curve]) -> Iterator[str]:
    names = [q.name for q in fields if not np.isfinite(q.values).all()]
    names += dict.fromkeys(c.plot for c in curves if not _is_finite(c))
    if names:
        yield f"not shown, as it is not finite at every time: {', '.join(names)}"


def _driven(shown: xr.Dataset) -> str | None:
    """The voltage that is applied: of a component without coils, as circuits and actuators have."""
    ending = "voltage"
    for variable in map(str, shown.data_vars):
        component, _, quantity = variable.partition(".")
        if quantity == ending and "coil" not in "".join(map(str, shown[variable].dims)):
            others = [str(v) for v in shown.data_vars if str(v).startswith(f"{component}.")]
            if not any("coil" in "".join(map(str, shown[v].dims)) for v in others):
                return variable
    return None


def _notes(results: xr.Dataset, names: list[str], kept: Integers, starts: int) -> Iterator[str]:
    status = str(results.attrs.get("status", "complete"))
    if status != "complete":
        yield f"the run did not reach its end: {status}"
    if starts > 1:
        yield f"of {starts} starts start {int(results['start'])} is shown, the nearest to the median curvature"
    if len(names) > 1:
        yield f"of {len(names)} fabrics only `{names[0]}` is shown"
    if len(kept) < results.sizes["time"]:
        yield f"{len(kept)} of {results.sizes['time']} output times are shown"
