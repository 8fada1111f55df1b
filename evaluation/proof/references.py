"""Computes the reference of a case, in whatever process it is asked for."""

from __future__ import annotations

import io
import tempfile
import time as clock
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from diagnosis.judge.diagnosis import ChannelFit
from diagnosis.models.coil_network.translate import NoCoilNetwork
from diagnosis.search.search import recalibrate
from evaluation.proof.answer import read_answer
from evaluation.proof.isolated import Files, write_files
from evaluation.proof.oracle import (
    about_truth,
    floor,
    held_out_fits,
    judging_samples,
    noises,
    oracle_fit,
    read_data,
    read_judge,
)
from evaluation.proof.reference import Reference


def make_reference(case: str, files: Files, answer: Files, has_baselines: bool) -> Reference:
    """What the data of a case allow.

    Args:
        case: Its name.
        files: Its scenario, task and recordings.
        answer: `<case>.json` and `<case>.npz`, and the recordings of the twin in `<case>_twin/` where there is one.
        has_baselines: Whether other methods are tried too.
    """
    with tempfile.TemporaryDirectory(prefix="cosim_prove_") as name:
        write_files(files, Path(name) / case)
        write_files(answer, Path(name) / "answers")
        if read_answer(Path(name) / "answers" / f"{case}.json").sabotage is not None:
            return Reference(case, failure="no reference: the recordings are not of the scenario's experiment")
        try:
            found = _reference(Path(name) / case, Path(name) / "answers", has_baselines)
            return _with_twin(found, Path(name) / case, Path(name) / "answers" / f"{case}_twin")
        except NoCoilNetwork as reason:
            return _of_noise(Path(name) / case, Path(name) / "answers", f"no reference: {reason}")


def _reference(folder: Path, answers: Path, has_baselines: bool) -> Reference:
    begin = clock.perf_counter()
    answer = read_answer(answers / f"{folder.name}.json")
    data = read_data(folder)
    base = recalibrate(data.model)
    known = oracle_fit(data, answer, base)
    points = {"recalibrated": base.point} | ({"oracle": known.point} if known else {})
    fits = held_out_fits(data, points)
    samples = judging_samples(data)
    clean = np.load(io.BytesIO((answers / f"{folder.name}.npz").read_bytes()))
    about = about_truth(folder, data.judge, clean)
    found = Reference(
        folder.name,
        samples=samples,
        recalibrated=_mean(fits, samples, "recalibrated"),
        oracle=_mean(fits, samples, "oracle") if known else None,
        floor=floor(about),
        noises=noises(about),
        training_gain=base.cost - known.cost if known else None,
        seconds={"oracle": clock.perf_counter() - begin},
    )
    if has_baselines:
        from evaluation.proof.baselines import baselines  # needs scikit-learn and pysindy

        values, terms, seconds = baselines(data, base)
        found = replace(found, baselines=values, terms=terms, seconds={**found.seconds, **seconds})
    return found


def _of_noise(folder: Path, answers: Path, failure: str) -> Reference:
    """What is known of a rig for which there is no model that knows the effect: the noise of its readings."""
    clean = np.load(io.BytesIO((answers / f"{folder.name}.npz").read_bytes()))
    about = about_truth(folder, read_judge(folder), clean)
    samples = {channel: count for channel, (*_, count) in about.items()}
    return Reference(folder.name, samples=samples, floor=floor(about), noises=noises(about), failure=failure)


def _with_twin(found: Reference, case: Path, recordings: Path) -> Reference:
    """The same with what the recalibrated model of the twin leaves in the twin's held-out recordings, if there are any.

    Args:
        found: Without it.
        case: Has the scenario and the task, which are the twin's too.
        recordings: The twin's, by the names of the case's.
    """
    if not recordings.is_dir():
        return found
    begin = clock.perf_counter()
    for name in ("scenario.yaml", "task.yaml"):
        (recordings / name).write_bytes((case / name).read_bytes())
    data = read_data(recordings)
    fits = held_out_fits(data, {"twin": recalibrate(data.model).point})
    value = _mean(fits, judging_samples(data), "twin")
    return replace(found, twin=value, seconds={**found.seconds, "twin": clock.perf_counter() - begin})


def _mean(fits: list[ChannelFit], samples: Mapping[str, int], stage: str) -> float:
    counts = np.array([samples[f.channel] for f in fits], dtype=np.float64)
    return float(counts @ np.array([f.chi_square[stage] for f in fits]) / counts.sum())
