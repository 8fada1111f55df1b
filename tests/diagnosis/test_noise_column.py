"""A recording may state the noise of every reading."""

import numpy as np
import pandas as pd
import pytest
import yaml

from cosim.unit.errors import InputError
from diagnosis.recording.recording import load_recording
from diagnosis.recording.usage import usage


def recording(path, deviations, **keys):
    times = np.arange(20.0)
    table = {"time": times, "z": times, "s": deviations}
    pd.DataFrame(table).to_csv(path / "data.csv", index=False)
    channel = {"column": "z", "unit": "mm", "factor": 2.0, "noise_column": "s", **keys}
    content = {"title": "t", "table": "data.csv", "channels": {"marker[1].z": channel}}
    (path / "recording.yaml").write_text(yaml.safe_dump(content))
    return path


def test_its_rms_is_the_noise_and_vague_readings_are_left_out(tmp_path):
    noise = np.where(np.arange(20) % 2, 0.1, 0.2)
    noise[[4, 9]] = 5.0
    found = load_recording(recording(tmp_path, noise))
    channel = found.channels["marker[1].z"]
    kept = np.delete(noise, [4, 9])
    assert channel.deviation == pytest.approx(2e-3 * np.sqrt(np.mean(kept**2)))  # factor 2, mm
    assert channel.dropped["uncertain"] == 2
    assert len(channel.values) == 18
    assert "2 far less certain than the others" in str(usage(found)[0])


@pytest.mark.parametrize("wrong", [0.0, -1.0, np.nan])
def test_a_deviation_that_is_none_is_refused(tmp_path, wrong):
    noise = np.full(20, 0.1)
    noise[7] = wrong
    with pytest.raises(InputError, match="row 8"):
        load_recording(recording(tmp_path, noise))


def test_two_noises_are_refused(tmp_path):
    with pytest.raises(InputError, match="not both"):
        load_recording(recording(tmp_path, np.full(20, 0.1), noise="1 mm"))
