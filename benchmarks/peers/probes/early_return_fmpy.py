"""FMPy's simulate_fmu: an FMI 3.0 FMU whose event lies inside a communication step; is the event time hit?"""

from __future__ import annotations

from pathlib import Path

from fmpy import simulate_fmu

from benchmarks.peers.probes.finding import fmu, report


def probe(work: Path) -> str:
    """The ground steps at 0.25 s, the step is 0.1 s; one FMU, as simulate_fmu takes no more."""
    del work
    result = simulate_fmu(
        str(fmu("ground_fmi3")),
        stop_time=0.5,
        output_interval=0.1,
        step_size=0.1,
        start_values={"step_time": 0.25},
        output=["z"],
        early_return_allowed=True,
        use_event_mode=True,
    )
    return f"event at 0.25 s; points {[round(float(t), 6) for t in result['time']]}"


if __name__ == "__main__":
    report(probe)
