"""`python -m benchmarks.play_rate [--screenshot DIR]`: pictures a second of `cosim play` in headless Chromium.

Software renderer (SwiftShader), 1000 x 700. Fabrics of formulas with 1000 frames, of 18 and of 288 links; the
page plays
for a few seconds and counts its own pictures. Needs Chromium on the PATH.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from pathlib import Path

from chainmail.play.film import Film
from chainmail.play.page import page
from tests.play.browser import Browser, chromium
from tests.play.films import fabric

_COUNT = """new Promise((done) => { player.play(true); let count = 0, first = 0;
    const next = (now) => { first = first || now; count += 1;
        if (now - first > 5000) { player.play(false); done(1000 * (count - 1) / (now - first)); }
        else { requestAnimationFrame(next); } };
    setTimeout(() => requestAnimationFrame(next), 1500); })"""


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.play_rate", description=__doc__)
    parser.add_argument("--screenshot", type=Path)
    given = parser.parse_args()
    if chromium() is None:
        raise SystemExit("there is no Chromium on the PATH (Debian: apt-get install chromium)")
    print(f"load {os.getloadavg()[0]:.1f}")
    print("| links x frames | page [MB] | ready [s] | pictures a second | canvas |")
    print("|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder, Browser() as browser:
        for rows, per_row in ((6, 3), (32, 9)):
            file = Path(folder) / f"{rows}.html"
            file.write_text(page(Film((fabric(rows, per_row, frames=1000, duration=20.0),))), encoding="utf-8")
            begin = time.monotonic()
            browser.open(file, 1000, 700)
            ready = time.monotonic() - begin
            rate = browser.evaluate(_COUNT)
            canvas = browser.evaluate("`${player.scene.canvas.width} x ${player.scene.canvas.height}`")
            size = file.stat().st_size / 1e6
            print(f"| {rows * per_row} x 1000 | {size:.2f} | {ready:.2f} | {rate:.0f} | {canvas} |", flush=True)
            if given.screenshot is not None:
                given.screenshot.mkdir(parents=True, exist_ok=True)
                browser.picture(given.screenshot / f"{rows * per_row}.png")


if __name__ == "__main__":
    main()
