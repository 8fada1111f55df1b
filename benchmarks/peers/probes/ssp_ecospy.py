"""ecos: import of SSP 1.0 and 2.0, with a parameter set."""

from __future__ import annotations

from pathlib import Path

from ecospy import EcosLib, EcosSimulation

from benchmarks.peers.probes.finding import report
from benchmarks.peers.probes.ssp_file import write


def probe(work: Path) -> str:
    """Height of the chassis after 1.5 s, and the mass that it was given (200 kg in the package, 400 kg in the FMU)."""
    EcosLib.set_log_level("off")
    found = []
    for version in ("1.0", "2.0"):
        try:
            with EcosSimulation(ssp_path=str(write(work, version)[1]), step_size=1e-3) as simulation:
                simulation.init(parameter_set="mass")
                simulation.step(1500)
                found.append(
                    f"SSP {version}: z = {simulation.get_real('chassis::z'):.6f} m, "
                    f"mass {simulation.get_real('chassis::mass'):g} kg"
                )
        except Exception as error:  # the finding is that it refuses
            found.append(f"SSP {version}: {str(error)[:120]}")
    return "; ".join(found)


if __name__ == "__main__":
    report(probe)
