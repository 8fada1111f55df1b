"""The page: exactness of what it carries, size, and that nothing in a title can break out."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

from chainmail.play.codec import decode
from chainmail.play.film import Film, Finding, Marks, Point, Shape, Track
from chainmail.play.page import LARGEST_ERROR, page
from tests.diagnosis.test_report import Page

from .films import SHAPE, corners, fabric


def content(text):
    """What the page carries: its table, and its decoded blocks."""
    film = json.loads(re.search(r'id="film">(.*?)</script>', text, re.DOTALL)[1])
    data = re.search(r'id="data">(.*?)</script>', text, re.DOTALL)[1]
    return film, decode(data, film["blocks"])


def poses(text, number=0):
    """Positions, quaternions and distances of bars of a fabric, as the page has them."""
    film, blocks = content(text)
    entry = film["fabrics"][number]
    links = entry["links"]
    position = blocks[entry["position"]].T.reshape(-1, links, 3)
    orientation = blocks[entry["orientation"]].T.reshape(-1, links, 4)
    return position, orientation / np.linalg.norm(orientation, axis=2, keepdims=True), blocks[entry["distance"]].T


@pytest.mark.parametrize("scale", [1.0, 0.3, 8.0])
def test_no_point_of_a_link_is_off_by_more_than_10_um(scale):
    # jitter and motion on top of every kind of rotation, links of 1 to 27 cm
    given = fabric(frames=120, seed=3)
    turns = np.random.default_rng(4).normal(size=(120, given.links, 4)).cumsum(axis=0)
    for frame in range(1, 120):  # without jumps of sign, as readers of results make them
        turns[frame] *= np.where((turns[frame] * turns[frame - 1]).sum(axis=1) < 0, -1, 1)[:, None]
    given = replace(
        given,
        shape=Shape(scale * SHAPE.bar_diameter, scale * SHAPE.outer_width, scale * SHAPE.length_offset),
        position=scale * given.position,
        link_length=scale * given.link_length,
        orientation=turns / np.linalg.norm(turns, axis=2, keepdims=True),
    )
    position, orientation, distance = poses(page(Film((given,))))
    there = corners(given.shape, given.position, given.orientation, given.bar_distance)
    error = np.linalg.norm(corners(given.shape, position, orientation, distance) - there, axis=-1)
    assert 0.2 * LARGEST_ERROR < error.max() < LARGEST_ERROR


def test_quantities_are_exact_to_one_of_256_colours():
    given = fabric()
    film, blocks = content(page(Film((given,))))
    for entry, quantity in zip(film["fabrics"][0]["fields"], given.fields, strict=True):
        found = blocks[entry["block"]].T
        assert np.abs(found - quantity.values).max() <= 0.5001 / 255 * np.ptp(quantity.values) + 1e-7


def test_eighteen_links_of_1000_frames_take_less_than_700_kb():
    size = len(page(Film((fabric(frames=1000, duration=20.0),))))
    assert 50_000 < size < 700_000


@pytest.mark.slow
def test_288_links_of_1000_frames_take_less_than_2_mb():
    size = len(page(Film((fabric(rows=32, per_row=9, frames=1000, duration=20.0),))))
    assert 500_000 < size < 2_000_000


def test_a_page_asks_for_nothing_from_elsewhere():
    text = page(Film((fabric(),)))
    assert "default-src 'none'" in text
    assert not re.search(r"(src|href)\s*=|@import|url\(|https?://", text)


def test_titles_cannot_become_markup():
    bad = "</script><script>alert(1)</script><b>&\"'"
    given = replace(fabric(frames=3), title=bad)
    marks = Marks(bad, (Point("marker", 1, (None, None, Track(np.arange(9.0), np.zeros(9)))),), (), (bad,))
    text = page(Film((given,), (marks,), (Finding(bad, bad, (1,), (), ((0.0, 1.0),), True),), (bad,)))
    assert "<script>alert" not in text
    assert text.count("</script>") == 3
    told = Page(text)
    assert not told.open
    assert told.names.count("script") == 3
    assert "b" not in told.names
    assert told.text.count(bad) == 2  # of the window and above the page; the rest is JSON
    assert content(text)[0]["fabrics"][0]["title"] == bad


def test_one_frame_is_a_page_too():
    position, _, _ = poses(page(Film((fabric(frames=1),))))
    assert position.shape == (1, 18, 3)


def test_colours_of_several_runs_share_one_scale():
    cold, hot = fabric(), fabric(seed=1)
    hot = replace(hot, fields=tuple(replace(q, values=q.values + 10) for q in hot.fields))
    film, _ = content(page(Film((cold, hot))))
    told = film["ranges"]["temperature"]
    assert told["low"] == cold.fields[0].values.min()
    assert told["high"] == hot.fields[0].values.max()
