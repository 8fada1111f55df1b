"""Every cell of the notebooks runs, in order, and they say what they should."""

import json
from pathlib import Path

import matplotlib
import pytest

NOTEBOOKS = Path(__file__).resolve().parents[1] / "docs" / "notebooks"


def executed(name: str, monkeypatch: pytest.MonkeyPatch) -> dict[str, object]:
    """Names that the cells of a notebook leave."""
    matplotlib.use("Agg")
    monkeypatch.setattr("matplotlib.pyplot.show", lambda: None)
    space: dict[str, object] = {"__name__": "__main__"}
    for number, cell in enumerate(json.loads((NOTEBOOKS / name).read_text(encoding="utf-8"))["cells"]):
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), f"{name}, cell {number}", "exec"), space)
    return space


def test_notebooks_are_kept_without_outputs_and_are_in_the_navigation():
    found = sorted(NOTEBOOKS.glob("*.ipynb"))
    assert [p.name for p in found] == ["own_fabric.ipynb", "own_recording.ipynb"]
    navigation = (NOTEBOOKS.parents[1] / "mkdocs.yml").read_text(encoding="utf-8")
    for path in found:
        content = json.loads(path.read_text(encoding="utf-8"))
        assert content["nbformat"] == 4
        assert not any(cell.get("outputs") for cell in content["cells"])
        assert f"notebooks/{path.stem}.md" in navigation


def test_the_fabric_of_the_notebook_is_one_of_its_own(monkeypatch, capsys):
    space = executed("own_fabric.ipynb", monkeypatch)
    printed = capsys.readouterr().out
    assert "did you mean `rows`?" in printed
    assert space["reached"] == pytest.approx(space["expected"], abs=0.1)  # degC; equation (4)
    assert "12 links; length by row at the end [cm]: [3.0" in printed
    matplotlib.pyplot.close("all")


@pytest.mark.slow
def test_the_recording_of_the_notebook_is_explained_by_a_loss_that_the_model_lacks(monkeypatch, capsys):
    space = executed("own_recording.ipynb", monkeypatch)
    printed = capsys.readouterr().out
    assert "No serious doubt" in printed
    diagnosis = space["found"].diagnosis
    assert diagnosis.accepted
    assert "radiation" in {diagnosis.accepted[0].effect, *diagnosis.accepted[0].ambiguous_with}
