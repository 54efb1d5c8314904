"""From a clean clone to the first verified answer: ``make demo``, and once more, with times, sizes and the load.

Each run clones the last commit into a folder of its own, without a virtual environment and without compiled kernels.
Packages come from wherever pip and uv find them; uv's own cache is left out with ``--cold``.

    python -m benchmarks.first_run --runs 3
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
ASKED_S = 60.0
ASKED_AGAIN_S = 10.0


@dataclass(frozen=True)
class Timed:
    """What a command took: by the clock and of the processors, with the load averages of a minute around it."""

    wall_s: float
    cpu_s: float
    load: tuple[float, float]


def timed(command: list[str], folder: Path, environment: dict[str, str]) -> Timed:
    """Run a command to its end.

    Raises
    ------
    subprocess.CalledProcessError
        When it fails.
    """
    before, load, began = _children_s(), os.getloadavg()[0], time.monotonic()
    subprocess.run(command, cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL)
    return Timed(time.monotonic() - began, _children_s() - before, (load, os.getloadavg()[0]))


def megabytes(folder: Path) -> float:
    """What the files of a folder take on the disk."""
    blocks = {(found := path.lstat()).st_ino: found.st_blocks for path in folder.rglob("*")}
    return sum(blocks.values()) * 512 / 1e6


def first_run(python: str, cold: bool) -> None:
    """One clean clone, printed as a line."""
    with tempfile.TemporaryDirectory(prefix="first-run-") as temporary:
        clone = Path(temporary) / "clone"
        subprocess.run(["git", "clone", "--quiet", str(ROOT), str(clone)], check=True)
        kept = {key: value for key, value in os.environ.items() if not key.startswith(("PYTHON", "NUMBA", "MECHSYNTH"))}
        environment = kept | ({"UV_NO_CACHE": "1", "PIP_NO_CACHE_DIR": "1"} if cold else {})
        command = ["make", "demo", f"PYTHON={python}"]
        packages = timed(["make", ".venv/.serving", f"PYTHON={python}"], clone, environment)
        first = timed(command, clone, environment)
        again = timed(command, clone, environment)
        if not (clone / "var" / "demo.svg").exists():
            raise SystemExit("there is no drawing")
        kernels = sum(file.stat().st_size for file in clone.rglob("*.nb[ci]") if ".venv" not in file.parts) / 1e6
        print(
            f"{packages.wall_s:9.1f} {packages.cpu_s:6.1f} {first.wall_s:9.1f} {first.cpu_s:6.1f} "
            f"{packages.wall_s + first.wall_s:9.1f} {again.wall_s:9.1f} {again.cpu_s:6.1f} "
            f"{megabytes(clone / '.venv'):8.0f} {kernels:8.1f}   {packages.load[0]:.1f} … {again.load[1]:.1f}",
            flush=True,
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--python", default=getattr(sys, "_base_executable", sys.executable))
    parser.add_argument("--cold", action="store_true", help="do not use the caches of pip and uv")
    options = parser.parse_args()
    print(f"{os.cpu_count()} processors; asked for: {ASKED_S:g} s the first time, {ASKED_AGAIN_S:g} s the second")
    print(" packages    cpu     first    cpu       all     again    cpu  .venv/MB  kernels   load (s, s of cpu, MB)")
    for _ in range(options.runs):
        first_run(options.python, options.cold)


def _children_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    main()
