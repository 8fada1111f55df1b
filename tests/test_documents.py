"""The documents: links lead somewhere, footnotes are there, examples of scenarios give the numbers beside them."""

import math
import re
from pathlib import Path

import pytest
import typer

from benchmarks.models.build import build
from cosim.assemble import assemble
from cosim.cli import app, validate
from cosim.run import run
from cosim.scenario import parse_scenario

ROOT = Path(__file__).resolve().parents[1]
#: Folders of the project that hold documents; what is built, installed or run lies elsewhere.
FOLDERS = (
    "benchmarks",
    "chainmail",
    "circuit",
    "cosim",
    "diagnosis",
    "docs",
    "evaluation",
    "fmus",
    "mechanics",
    "scenarios",
    "templates",
    "tests",
)
DOCUMENTS = sorted([*ROOT.glob("*.md"), *(p for f in FOLDERS for p in (ROOT / f).rglob("*.md"))])
_FENCE = re.compile(r"^```(?P<info>[^\n]*)\n(?P<text>.*?)^```", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"\[[^\]]*\]\((?P<target>[^)\s]+)\)")


def prose(path):
    """Text without code, in which brackets are no links."""
    return re.sub(r"`[^`\n]*`", "", _FENCE.sub("", path.read_text(encoding="utf-8")))


def anchors(path):
    """Names by which GitHub links to headings: lower case, without punctuation, blanks as hyphens."""
    headings = re.findall(r"^#+ (.*)$", _FENCE.sub("", path.read_text(encoding="utf-8")), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", h.strip().lower()).replace(" ", "-") for h in headings}


def broken_links(path):
    """Relative links of a document whose file or heading does not exist."""
    found = []
    for match in _LINK.finditer(prose(path)):
        target = match["target"]
        if re.match(r"[a-z]+:", target):
            continue  # another site
        name, _, anchor = target.partition("#")
        file = (path.parent / name) if name else path
        if not file.exists() or (anchor and anchor not in anchors(file)):
            found.append(target)
    return found


def example(name):
    """Text of the fenced example of docs/scenarios.md that is called `name`."""
    page = (ROOT / "docs" / "scenarios.md").read_text(encoding="utf-8")
    (text,) = [m["text"] for m in _FENCE.finditer(page) if m["info"].split() == ["yaml", name]]
    return text


@pytest.fixture
def in_project(monkeypatch):
    """The working folder in which the examples find their FMUs."""
    build()
    monkeypatch.chdir(ROOT)


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_every_relative_link_leads_to_a_file_or_heading(path):
    assert broken_links(path) == []


def test_a_broken_link_would_be_seen(tmp_path):
    page = """# A page, of mine
`[no](link)` [a](https://b.c) [x](there.md) [y](#other)
[z](here.md#a-page-of-mine) ![p](p.png)
```
[w](nowhere.md)
```
"""
    (tmp_path / "here.md").write_text(page)
    assert broken_links(tmp_path / "here.md") == ["there.md", "#other", "p.png"]


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_every_footnote_that_is_referred_to_is_there_once(path):
    text = prose(path)
    defined = re.findall(r"^\[\^(\w+)\]:", text, re.MULTILINE)
    assert len(set(defined)) == len(defined)
    assert set(re.findall(r"\[\^(\w+)\](?!:)", text)) <= set(defined)


@pytest.mark.usefixtures("in_project")
def test_two_fmus_of_both_versions_swing_as_the_page_says():
    found = run(parse_scenario(example("two_masses.yaml"), ROOT / "two_masses.yaml"))
    # Two modes, in phase with 2 pi and against each other with 6 pi, of amplitude 1/2 each (benchmarks/two_mass.py).
    in_phase, against = (0.5 * math.cos(k * math.pi * 0.8) for k in (2, 6))
    left, right = (float(found[f"{side}.displacement"][-1]) for side in ("left", "right"))
    assert (left, right) == pytest.approx((in_phase + against, in_phase - against), abs=1.1e-4)  # "0.1 mm away"
    assert (round(left, 4), round(right, 4)) == (-0.2499, 0.5589)


@pytest.mark.usefixtures("in_project")
def test_fmi_3_arrays_are_connected_array_to_array_and_by_element():
    found = run(parse_scenario(example("arrays.yaml"), ROOT / "arrays.yaml"))
    end = {name: found[f"{name}.y"].values[-1].tolist() for name in ("first", "second", "third")}
    # y[k] = gain u[k] + k offset, then gain 1 and offset 0; the last one takes 10 y[3] - 1 and keeps its start value.
    assert end == {"first": [7.0, 8.0, 9.0], "second": [7.0, 8.0, 9.0], "third": [89.0, 8.0]}


@pytest.mark.usefixtures("in_project")
def test_the_fabric_of_the_page_is_valid():
    assembly = assemble(parse_scenario(example("own_fabric.yaml"), ROOT / "scenarios" / "own_fabric.yaml"))
    links = assembly.system.units["fabric"].variables["link_length"].size
    assembly.system.terminate()
    assert links == 10 * (3 + 2)  # every row: three links of one orientation, two of the other between them


@pytest.mark.usefixtures("in_project")
def test_validate_lists_algebraic_loops(tmp_path, capsys):
    part = "{kind: fmu, fmu: build/benchmark_models/feedthrough_fmi3.fmu, parameters: {gain: 0.5, offset: 1}}"
    text = f"""title: A ring
time: {{stop: 1 s, macro_step: 1 s, output_step: 1 s}}
components:
  a: {part}
  b: {part}
connections: [a.y -> b.u, b.y -> a.u]
"""
    (tmp_path / "ring.yaml").write_text(text)
    validate(str(tmp_path / "ring.yaml"))
    printed = capsys.readouterr().out.splitlines()
    assert printed[0].endswith("a (2 variables), b (2 variables); 2 connections")
    assert len(printed) == 3  # the last one is the size of the run
    assert printed[1].startswith("  algebraic loop ")
    assert "a.y -> b.u" in printed[1]
    assert "b.y -> a.u" in printed[1]


def _options(command, path):
    """Every option of a command and of those below it."""
    for name, inner in getattr(command, "commands", {}).items():
        yield from _options(inner, [*path, name])
    for parameter in command.params:
        yield from ((" ".join(path), o) for o in (*parameter.opts, *parameter.secondary_opts) if o.startswith("--"))


def test_every_option_stands_in_a_document():
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    text = "\n".join(p.read_text(encoding="utf-8") for p in pages)
    every = set(_options(typer.main.get_command(app), ["cosim"]))
    usual = {"--help", "--version", "--install-completion", "--show-completion"}
    assert len(every) > 100
    assert [(c, o) for c, o in sorted(every) if o not in usual and not re.search(rf"{o}(?![\w-])", text)] == []


def test_every_page_stands_in_the_index_and_in_the_site():
    site, index = ((ROOT / f).read_text(encoding="utf-8") for f in ("mkdocs.yml", "docs/README.md"))
    pages = [p.name for p in (ROOT / "docs").glob("*.md") if p.name != "README.md"]
    assert [p for p in pages if f": {p}" not in site or f"({p}" not in index] == []
