"""The page in a real browser: decoded poses, picture, controls. Chromium draws with its software renderer."""

import base64
import io
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from chainmail.play.film import Film, Finding, Marks, Point, Track
from chainmail.play.links import markers, pose_at
from chainmail.play.page import LARGEST_ERROR, page

from .browser import NAMES, Browser, chromium
from .films import corners, fabric

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(chromium() is None, reason=f"there is no Chromium ({', '.join(NAMES)})"),
]


@pytest.fixture(scope="module")
def browser():
    with Browser() as opened:
        yield opened


@pytest.fixture(scope="module")
def film():
    given = fabric(frames=60, seed=2)
    ghost = replace(fabric(frames=30, duration=2.5, seed=3), title="shorter")
    simulated = [markers(given, pose_at(given, t)) for t in given.times]
    tracks = [Track(given.times, np.array([m[5, axis] for m in simulated]) + 0.001 * axis) for axis in (1, 2)]
    marks = Marks("camera", (Point("marker", 6, (None, *tracks)),), notes=("a note",))
    finding = Finding("coil 21 is open", "coil[4,3]", (10,), (20,), ((2.0, 4.0),), True)
    return Film((given, ghost), (marks,), (finding,))


@pytest.fixture(scope="module")
def loaded(browser, film, tmp_path_factory):
    path = tmp_path_factory.mktemp("pages") / "film.html"
    path.write_text(page(film))
    browser.events.clear()
    browser.open(path)
    return browser


@pytest.fixture
def opened(loaded):
    """The page as it is when it opens."""
    loaded.evaluate("player.play(false), player.fabrics.forEach((f, k) => { f.look = k ? 'ghost' : 'colour'; })")
    loaded.evaluate("player.row = player.place = 0; player.camera.view('oblique'); player.seek(0)")
    return loaded


def picture(browser):
    """The canvas as it is drawn now, shape (rows, columns, 3)."""
    text = browser.evaluate("(player.draw(), player.scene.canvas.toDataURL('image/png').split(',')[1])")
    with Image.open(io.BytesIO(base64.b64decode(text))) as found:
        return np.asarray(found.convert("RGB")).astype(int)


def covered(browser):
    """Share of the canvas that something is drawn on."""
    shown = picture(browser)
    return float((np.abs(shown - shown[0, -1]).max(axis=2) > 12).mean())


def test_it_opens_without_errors_and_asks_for_nothing(opened):
    assert opened.evaluate("document.documentElement.dataset.failed") is None
    assert opened.evaluate("document.getElementById('failure').hidden")
    assert opened.faults() == []


def test_the_browser_has_every_pose_to_10_um(opened, film):
    given = film.fabric
    numbers = opened.evaluate("""(() => { const f = player.fabrics[0], out = new Float64Array(8 * f.links);
        return Array.from(f.times, (_, k) => Array.from(posesAt(f, { i: k, j: k, share: 0 }, out))); })()""")
    found = np.array(numbers).reshape(60, given.links, 8)
    there = corners(given.shape, given.position, given.orientation, given.bar_distance)
    here = corners(given.shape, found[..., :3], found[..., 3:7], found[..., 7])
    assert np.linalg.norm(here - there, axis=-1).max() < LARGEST_ERROR
    times = opened.evaluate("Array.from(player.fabrics[0].times)")
    np.testing.assert_allclose(times, given.times, atol=1e-6)


def test_it_has_the_markers_of_the_simulation(opened, film):
    found = opened.evaluate("(player.seek(3), player.draw(), markersOf(player.fabrics[0], player.fabrics[0].poses))")
    np.testing.assert_allclose(found, markers(film.fabric, pose_at(film.fabric, 3.0)), atol=LARGEST_ERROR)


def test_recorded_markers_are_told_apart_from_simulated_ones(opened):
    (pair,) = opened.evaluate("(player.seek(3), player.draw(), player.pairs(player.marks[0]))")
    # 1 mm along y and 2 mm along z, less what steps of the page take
    assert pair["apart"] == pytest.approx(np.hypot(0.001, 0.002), abs=4e-5)
    assert "1 points, 2.2" in opened.evaluate("document.getElementById('legend').textContent")


def test_a_fabric_is_drawn_and_moves(opened):
    opened.evaluate("player.fabrics[1].look = 'hidden'")
    first = picture(opened)
    assert 0.05 < covered(opened) < 0.8
    opened.evaluate("player.seek(4)")
    assert (np.abs(picture(opened) - first).max(axis=2) > 25).mean() > 0.02


def test_a_cut_shows_one_row_alone(opened):
    opened.evaluate("player.fabrics[1].look = 'hidden'")
    whole = covered(opened)
    opened.evaluate("player.row = 3")
    assert 0.01 < covered(opened) < 0.5 * whole
    assert opened.evaluate("player.fabrics[0].count") == 3
    opened.evaluate("player.place = 2")
    opened.evaluate("player.draw()")
    assert opened.evaluate("player.fabrics[0].count") == 1


def test_a_ghost_is_there_only_while_it_has_a_time(opened):
    opened.evaluate("player.seek(2)")
    with_ghost = covered(opened)
    opened.evaluate("player.fabrics[1].look = 'hidden'")
    assert with_ghost > covered(opened)
    opened.evaluate("player.fabrics[1].look = 'ghost'; player.seek(4)")
    later = covered(opened)
    opened.evaluate("player.fabrics[1].look = 'hidden'")
    assert later == covered(opened)


def test_a_ghost_in_the_same_place_does_not_tint(opened):
    opened.evaluate("player.seek(0); player.camera.view('side'); player.row = 1")  # held: both are there for all times
    together = picture(opened)
    opened.evaluate("player.fabrics[1].look = 'hidden'")
    assert (np.abs(picture(opened) - together).max(axis=2) > 20).mean() < 1e-3


def test_a_finding_is_marked_and_can_be_gone_to(opened):
    def magenta():
        red, green, blue = picture(opened).transpose(2, 0, 1)
        return int(((red > 150) & (green < 40) & (blue > 70)).sum())

    opened.evaluate("player.fabrics[1].look = 'hidden'")
    assert magenta() > 100
    opened.press("#findings input")
    assert magenta() == 0
    opened.press("#findings input")
    opened.press("#findings button")
    assert opened.evaluate("player.time") == 2.0
    assert "coil 21 is open" in opened.evaluate("document.getElementById('findings').textContent")


def test_the_arm_of_a_coil_concerned_is_striped(opened):
    opened.evaluate("player.fabrics[1].look = 'hidden'; player.row = 4; player.place = 2; player.camera.view('top')")
    opened.evaluate("player.camera.zoom = 2")
    striped = picture(opened)
    opened.evaluate("player.film.findings[0].coils = []")
    plain = picture(opened)
    opened.evaluate("player.film.findings[0].coils = [20]")
    changed = np.abs(striped - plain).max(axis=2) > 30
    assert changed.sum() > 100
    red, green, blue = striped[changed].T
    assert ((red > green + 60) & (blue > green + 20)).all()


def test_points_of_links_that_are_cut_away_are_not_drawn(opened):
    def shown():
        return opened.evaluate("player.pairs(player.marks[0]).filter((p) => player.isShown(p.row, p.place)).length")

    opened.evaluate("(player.seek(3), player.draw())")
    assert shown() == 1
    assert opened.evaluate("player.pairs(player.marks[0]).map((p) => [p.row, p.place])") == [[3, 3]]
    opened.evaluate("player.row = 2")
    assert shown() == 0


def test_a_picture_that_the_driver_lost_comes_back(opened):
    whole = covered(opened)
    opened.evaluate("window.lost = player.scene.gl.getExtension('WEBGL_lose_context'), lost.loseContext()")
    opened.until("player.scene === null")
    opened.evaluate("lost.restoreContext()")
    opened.until("player.scene !== null")
    assert covered(opened) == pytest.approx(whole, abs=1e-3)


def test_colours_follow_the_chosen_quantity(opened):
    opened.evaluate("player.fabrics[1].look = 'hidden'; player.seek(2.5)")
    assert opened.evaluate("document.getElementById('high').textContent").endswith("°C")
    warm = picture(opened)
    opened.evaluate("""(() => { const q = document.getElementById('quantity'); q.value = 'tension';
        q.dispatchEvent(new Event('change')); })()""")
    assert (np.abs(picture(opened) - warm).max(axis=2) > 30).mean() > 0.02
    assert opened.evaluate("document.getElementById('high').textContent").endswith(" N")
    opened.evaluate("""(() => { const q = document.getElementById('quantity'); q.value = 'temperature';
        q.dispatchEvent(new Event('change')); })()""")


def test_it_plays_stops_and_begins_again(opened):
    opened.evaluate("player.speed = 10")
    opened.press("#play")
    assert opened.evaluate("document.getElementById('play').textContent") == "Pause"
    opened.until("player.time > 1")
    opened.until("!player.isPlaying")
    assert opened.evaluate("player.time") == 5.0
    opened.press("#play")
    opened.until("player.time < 4")
    opened.press("#play")
    assert not opened.evaluate("player.isPlaying")


def test_slider_plots_and_keys_move_the_time(opened, film):
    opened.evaluate("(() => { const s = document.getElementById('slider'); s.value = 1.5; s.oninput(); })()")
    assert opened.evaluate("player.time") == 1.5
    opened.press("#plots canvas")  # its middle, less the room of the numbers
    assert 2.0 < opened.evaluate("player.time") < 2.6
    opened.evaluate("player.seek(0)")
    for kind in ("keyDown", "keyUp"):
        opened.call("Input.dispatchKeyEvent", type=kind, key="ArrowRight", code="ArrowRight")
    assert opened.evaluate("player.time") == pytest.approx(film.fabric.times[1], abs=1e-6)


def test_a_drag_turns_the_view_and_the_wheel_zooms(opened):
    before = opened.evaluate("[player.camera.azimuth, player.camera.elevation]")
    for kind, x in (("mousePressed", 300), ("mouseMoved", 360), ("mouseReleased", 360)):
        opened.call("Input.dispatchMouseEvent", type=kind, x=x, y=300, button="left", buttons=1, clickCount=1)
    after = opened.evaluate("[player.camera.azimuth, player.camera.elevation]")
    assert after[0] < before[0]
    assert after[1] == before[1]
    opened.call("Input.dispatchMouseEvent", type="mouseWheel", x=300, y=300, deltaX=0, deltaY=-200)
    assert opened.evaluate("player.camera.zoom") == pytest.approx(np.exp(0.3))


@pytest.mark.parametrize("size", [(1400, 900), (900, 600), (390, 844)])
def test_nothing_hangs_over_at_any_size(opened, size, tmp_path):
    opened.size(*size)
    shown = opened.picture(tmp_path / "page.png")
    with Image.open(shown) as taken:
        assert taken.size == size
    assert opened.evaluate("document.documentElement.scrollWidth") <= size[0]
    for part in ("#picture", "#play", "#slider", "#clock"):
        left, right, bottom = opened.evaluate(
            f"(() => {{ const b = document.querySelector('{part}').getBoundingClientRect();"
            " return [b.left, b.right, b.bottom]; })()"
        )
        assert left >= 0
        assert right <= size[0]
        assert bottom <= size[1]
    opened.size(1000, 700)


def test_the_controls_are_linked_to_a_page_that_a_notebook_holds(browser, film, tmp_path):
    from chainmail.play.notebook import Player

    path = tmp_path / "notebook.html"
    path.write_text(f"<!doctype html><body>{Player(page(film), 500)._repr_html_()}</body>")
    browser.call("Page.navigate", url=path.as_uri())
    inside = "document.querySelector('iframe')?.contentDocument?.documentElement?.dataset"
    browser.until(f"location.href.endsWith('notebook.html') && ({inside}?.ready || {inside}?.failed)")
    assert browser.evaluate(f"{inside}.failed") is None
    assert browser.evaluate("document.querySelector('iframe').contentWindow.player.fabrics.length") == 2


def test_without_webgl_the_plots_are_shown_and_the_page_says_why(browser, film, tmp_path):
    path = tmp_path / "plain.html"
    hide = (
        "<script>HTMLCanvasElement.prototype.getContext = ((own) => function (kind, ...rest) {"
        " return kind === 'webgl2' ? null : own.call(this, kind, ...rest); })(HTMLCanvasElement.prototype.getContext);"
    )
    path.write_text(page(film).replace("<script>", f"{hide}</script>\n<script>", 1))
    browser.open(path)
    assert "this browser has no WebGL 2" in browser.evaluate("document.getElementById('failure').textContent")
    assert browser.evaluate("document.querySelectorAll('.plot').length") == 3
    assert browser.evaluate("(player.seek(1), player.draw(), document.getElementById('clock').textContent)") == "1.00 s"


def test_one_frame_can_be_looked_at(browser, tmp_path):
    path = tmp_path / "still.html"
    path.write_text(page(Film((fabric(frames=1),))))
    browser.open(path)
    assert covered(browser) > 0.05
    assert browser.evaluate("(player.play(true), player.seek(3), player.draw(), player.time)") == 0.0


def test_damaged_data_are_told(browser, film, tmp_path):
    path = tmp_path / "damaged.html"
    text = page(film)
    at = text.index('id="data">') + 400
    path.write_text(text[:at] + "AAAAAAAA" + text[at + 8 :])
    browser.open(path)
    assert "This page cannot be shown" in browser.evaluate("document.getElementById('failure').textContent")
