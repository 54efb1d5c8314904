"""The instructions of the container file, and what its first stage does, done in folders of this machine.

Not every machine can build an image. The first stage needs nothing of its base image but Python with pip, so its
commands run here too, in a folder that stands for the root.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from fnmatch import fnmatch
from pathlib import Path

ROOT = Path(__file__).parents[2]
CONTAINER = ROOT / "docs" / "operations" / "deploy" / "Dockerfile"

Instruction = tuple[str, str]


def read_instructions() -> list[Instruction]:
    """Return the words and the rests of all instructions, in order."""
    lines = re.sub(r"^#.*\n", "", CONTAINER.read_text("utf-8"), flags=re.MULTILINE).replace("\\\n", " ")
    return [(word, rest) for word, _, rest in (line.partition(" ") for line in lines.splitlines()) if word]


def read_stage(number: int) -> list[Instruction]:
    """Return the instructions of a stage, counted from 0; the last one is what the image has."""
    every = read_instructions()
    starts = [k for k, (word, _) in enumerate(every) if word == "FROM"]
    return every[starts[number] : [*starts, len(every)][number + 1] if number >= 0 else None]


def is_let_through(source: str) -> bool:
    """Return whether .dockerignore lets a file or a folder of the project into the context."""
    patterns = (ROOT / ".dockerignore").read_text("utf-8").splitlines()
    return any(fnmatch(source, line[1:]) for line in patterns if line.startswith("!"))


def run_first_stage(root: Path) -> Path:
    """Run the first stage below a folder, and return the environment that it makes for the image."""
    build, base = root / "build", root / "base" / "bin"
    build.mkdir(parents=True)
    _make_base(base)
    environment = {
        name: value for name, value in os.environ.items() if not name.startswith(("MECHSYNTH_", "PYTHON", "VIRTUAL_"))
    }
    environment |= {"PATH": f"{base}:{os.environ['PATH']}", "EXTRAS": ""}
    for word, rest in read_stage(0)[1:]:
        if word == "COPY":
            *sources, target = rest.split()
            for source in filter(is_let_through, sources):
                copied = build / (source if target == "./" else target)
                if (ROOT / source).is_dir():
                    shutil.copytree(ROOT / source, copied, ignore=shutil.ignore_patterns("__pycache__"))
                else:
                    shutil.copy(ROOT / source, copied)
        elif word == "RUN":
            command = rest.replace("/opt/", f"{root}/opt/")
            done = subprocess.run(command, shell=True, cwd=build, env=environment, capture_output=True, text=True)
            assert done.returncode == 0, f"{command}\n{done.stdout}{done.stderr}"
        else:
            assert (word, rest) in (("ARG", "EXTRAS="), ("WORKDIR", "/build")), f"{word} {rest} is not known here"
    return root / "opt" / "mechsynth"


def _make_base(programs: Path) -> None:
    """Make an environment that stands for the base image: Python and pip, and no package."""
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", programs.parent], check=True)
    # Some systems have no ensurepip, so the system's pip installs into it.
    pip = programs / "pip"
    outer = getattr(sys, "_base_executable", sys.executable)
    pip.write_text(f'#!/bin/sh\nexec {outer} -m pip --python {programs}/python "$@"\n')
    pip.chmod(0o755)
