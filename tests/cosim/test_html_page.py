"""Templates of pages: values are escaped once, control characters vanish, and what is missing is an error."""

from __future__ import annotations

from pathlib import Path

import pytest
from jinja2 import TemplateNotFound, UndefinedError
from markupsafe import Markup

from cosim.html_page import environment


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "page.html.j2").write_text('<b title="{{ text }}">{{ text }}</b>{{ markup }}')
    return tmp_path


def test_text_is_escaped_once_and_markup_passes(folder: Path) -> None:
    page = environment(folder).get_template("page.html.j2").render(text="<i>&\"'\x1b[0m", markup=Markup("<br>"))
    text = "&lt;i&gt;&amp;&#34;&#39; [0m"
    assert page == f'<b title="{text}">{text}</b><br>'


def test_a_value_that_is_missing_is_an_error(folder: Path) -> None:
    with pytest.raises(UndefinedError, match="'markup' is undefined"):
        environment(folder).get_template("page.html.j2").render(text="a")


def test_the_first_folder_counts_and_others_are_not_searched(folder: Path) -> None:
    other = folder / "other"
    other.mkdir()
    (other / "page.html.j2").write_text("other")
    assert environment(other, folder).get_template("page.html.j2").render() == "other"
    with pytest.raises(TemplateNotFound):
        environment(other).get_template("none.html.j2")
