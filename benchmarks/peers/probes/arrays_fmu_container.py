"""fmucontainer: array to array."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

from benchmarks.peers.probes.finding import fmu, report


def probe(work: Path) -> str:
    """It answers with a container, or says why not."""
    for name in ("first", "second"):
        shutil.copy(fmu("vector_gain_fmi3"), work / f"{name}.fmu")
    (work / "c.json").write_text(
        json.dumps(
            {
                "name": "c.fmu",
                "step_size": 0.1,
                "auto_link": False,
                "auto_input": False,
                "auto_output": False,
                "fmu": ["first.fmu", "second.fmu"],
                "link": [["first.fmu", "y", "second.fmu", "u"]],
                "output": [["second.fmu", "y", "y"]],
            }
        )
    )
    tool = Path(sys.executable).parent / "fmucontainer"
    done = subprocess.run(
        [tool, "-container", "c.json", "-fmu-directory", work, "-fmi", "3"],
        cwd=work,
        capture_output=True,
        text=True,
        check=False,
    )
    made = "made a container" if (work / "c.fmu").is_file() else "made no container"
    return f"{made}; {(done.stdout + done.stderr).strip().splitlines()[-1][:200]}"


if __name__ == "__main__":
    report(probe)
