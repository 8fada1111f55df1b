"""A film as GIF or MP4, drawn without a browser."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

from chainmail.play.camera import VIEWS, reach_of
from chainmail.play.film import Film
from chainmail.play.output import output
from chainmail.play.page import ranges_of
from chainmail.play.palette import palette
from chainmail.play.picture import Painter, Style, fields_of
from cosim.unit.errors import InputError

#: Pictures a second. GIF counts hundredths of a second.
GIF_RATE, MP4_RATE = 12.5, 25.0
#: Wall time that a film lasts where no speed is given [s]: at most.
_LASTS = 12.0
_SPEEDS = (0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 10.0, 20.0, 50.0, 100.0)
#: More pictures are not made.
_MOST = 5000
#: Height for each width.
_ASPECT = 0.62
#: Colours of a GIF.
_COLOURS = 96
#: Plots under the picture, where the run has them.
_STRIPS = ("Supply voltage", "Maximum curvature")

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class MovieStyle:
    """What a user chooses.

    Args:
        quantity: That the colours show; empty: the first that there is.
        view: One of `VIEWS`.
        speed: Simulated seconds a second; None: such that the film lasts 12 s at most.
        width: Of the picture [px].
    """

    quantity: str = ""
    view: str = "oblique"
    speed: float | None = None
    width: int = 560


def write_gif(film: Film, path: Path, style: MovieStyle, on_progress: Progress | None = None) -> int:
    """Write an animated GIF that repeats; returns the number of its pictures.

    Raises:
        InputError: A choice does not exist, or the file cannot be written.
    """
    painter, times = _painter(film, style), moments(film, style.speed, GIF_RATE)
    common = _common_palette([painter.at(t) for t in times[:: max(1, len(times) // 8)]])
    pictures = _pictures(painter, times, on_progress)
    first, *others = (p.quantize(palette=common, dither=Image.Dither.NONE) for p in pictures)
    with output(path) as partial:
        first.save(
            partial,
            format="GIF",
            save_all=True,
            append_images=others,
            loop=0,
            optimize=False,
            duration=round(1000 / GIF_RATE),
        )
    return len(times)


def write_mp4(film: Film, path: Path, style: MovieStyle, on_progress: Progress | None = None) -> int:
    """Write an MP4 (H.264) that presentation programs play; returns the number of its pictures.

    Raises:
        InputError: imageio-ffmpeg is not installed, a choice does not exist, or the file cannot be written.
    """
    try:
        import imageio_ffmpeg  # late: an extra
    except ImportError as error:
        raise InputError(
            "--mp4",
            "",
            "MP4 needs the package imageio-ffmpeg, which is not installed",
            "pip install 'active-chainmail[video]', or give --gif",
        ) from error
    painter, times = _painter(film, style), moments(film, style.speed, MP4_RATE)
    with output(path) as partial:
        writer = imageio_ffmpeg.write_frames(
            str(partial),
            painter.style.size,
            fps=MP4_RATE,
            codec="libx264",
            pix_fmt_out="yuv420p",
            macro_block_size=2,
            output_params=["-crf", "20", "-f", "mp4", "-movflags", "+faststart"],
            ffmpeg_log_level="error",
        )
        writer.send(None)
        try:
            for picture in _pictures(painter, times, on_progress):
                writer.send(np.ascontiguousarray(picture))
        finally:
            writer.close()
    return len(times)


def moments(film: Film, speed: float | None, rate: float) -> list[float]:
    """Simulated times of the pictures [s], the last one that of the last frame.

    Args:
        film: What.
        speed: Simulated seconds a second; None: the slowest usual one at which the film lasts 12 s at most.
        rate: Pictures a second.

    Raises:
        InputError: There are too many.
    """
    begin = min(float(f.times[0]) for f in film.fabrics)
    end = max(float(f.times[-1]) for f in film.fabrics)
    usual = next((s for s in _SPEEDS if (end - begin) / s <= _LASTS), (end - begin) / _LASTS)
    step = (usual if speed is None else speed) / rate
    if (end - begin) / step > _MOST:
        raise InputError(
            "--speed",
            "",
            f"{speed:g} makes {(end - begin) / step:.0f} pictures, more than {_MOST}",
            "give a larger speed",
        )
    return [*(begin + k * step for k in range(math.ceil((end - begin) / step - 1e-9))), end]


def _pictures(painter: Painter, times: Sequence[float], on_progress: Progress | None) -> Iterator[Image.Image]:
    for number, time in enumerate(times):
        yield painter.at(time)
        if on_progress is not None:
            on_progress(number + 1, len(times))


def _painter(film: Film, style: MovieStyle) -> Painter:
    quantities = fields_of(film)
    if style.quantity and style.quantity not in quantities:
        raise InputError(
            "--colour",
            "",
            f"this run has no `{style.quantity}` of its coils or links",
            f"give one of: {', '.join(quantities)}",
        )
    if style.view not in VIEWS:
        raise InputError("--view", "", f"there is no view `{style.view}`", f"give one of: {', '.join(VIEWS)}")
    titles = {curve.plot for curve in film.fabric.curves}
    height = 2 * round(_ASPECT * style.width / 2)
    chosen = style.quantity or next(iter(quantities))
    shown = Style((2 * (style.width // 2), height), style.view, chosen, tuple(t for t in _STRIPS if t in titles))
    return Painter(film, reach_of(film), ranges_of(film.fabrics), shown)


def _common_palette(pictures: Sequence[Image.Image]) -> Image.Image:
    """One palette for all pictures, from some of them: what stands still then stays equal from picture to picture.

    The colours of the bar lie beside them, so that they are kept although few pixels have them.
    """
    width, height = pictures[0].size
    sheet = Image.new("RGB", (width, height * (len(pictures) + 1)))
    for number, picture in enumerate(pictures):
        sheet.paste(picture, (0, number * height))
    sheet.paste(Image.fromarray(palette()[None].copy()).resize((width, height)), (0, len(pictures) * height))
    return sheet.quantize(_COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
