"""A kernel on disk is the kernel of the sources as they stand now, those in other files too."""

import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numba import types

from kinematics.compiling import compute_digest, find_sources, njit

ROOT = Path(__file__).resolve().parents[2]

INNER = """
from {compiler} import njit

@njit(cache=True)
def part(x):
    return x + {constant}
"""
OUTER = """
from {compiler} import njit
from synthesis.middle import part

@njit(cache=True)
def whole(x):
    return 10 * part(x)
"""
MIDDLE = "from synthesis.inner import part\n\n__all__ = ['part']\n"
RUN = "from synthesis.outer import whole; print(whole(1), sum(whole.stats.cache_hits.values()))"


def _run(folder: Path, compiler: str, constant: int) -> list[int]:
    """What the kernel gives where the file that it inlines has `constant`, and whether it came from the disk."""
    package = folder / "synthesis"
    package.mkdir(parents=True, exist_ok=True)
    (folder / "pyproject.toml").touch()
    for name, text in {"__init__": "", "inner": INNER, "middle": MIDDLE, "outer": OUTER}.items():
        (package / f"{name}.py").write_text(text.format(compiler=compiler, constant=constant))
    paths = os.pathsep.join([str(folder), str(ROOT)])
    environment = {key: value for key, value in os.environ.items() if key != "NUMBA_CACHE_DIR"}
    environment |= {"PYTHONPATH": paths, "PYTHONDONTWRITEBYTECODE": "1"}
    ended = subprocess.run(
        [sys.executable, "-c", RUN], env=environment, cwd=folder, capture_output=True, text=True, check=True
    )
    return [int(word) for word in ended.stdout.split()]


@pytest.mark.slow
def test_a_kernel_follows_the_files_that_it_inlines(tmp_path: Path) -> None:
    assert _run(tmp_path, "kinematics.compiling", 1) == [20, 0]
    assert _run(tmp_path, "kinematics.compiling", 1) == [20, 1]
    assert _run(tmp_path, "kinematics.compiling", 2) == [30, 0]


@pytest.mark.slow
def test_the_compiler_alone_does_not(tmp_path: Path) -> None:
    assert _run(tmp_path, "numba", 1) == [20, 0]
    assert _run(tmp_path, "numba", 2) == [20, 1]  # the reason for the digest; where it fails, the digest can go


TYPED = """
from typing import NamedTuple

from kinematics.compiling import njit


class {name}(NamedTuple):
    size: float


@njit(cache=True)
def double(limits):
    return 2 * limits.size


print(int(double({name}(3.0))), sum(double.stats.cache_hits.values()))
"""


def _run_typed(folder: Path, name: str) -> str:
    """Run a kernel whose argument has a class of this name; print its value and its hits in the cache."""
    folder.joinpath("pyproject.toml").touch()
    folder.joinpath("typed.py").write_text(TYPED.format(name=name))
    environment = {key: value for key, value in os.environ.items() if key != "NUMBA_CACHE_DIR"}
    environment |= {"PYTHONPATH": os.pathsep.join([str(folder), str(ROOT)]), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-c", "import typed"]
    return subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True, check=True).stdout


@pytest.mark.slow
def test_a_renamed_argument_type_is_compiled_again(tmp_path: Path) -> None:
    assert _run_typed(tmp_path, "Limit") == "6 0\n"
    assert _run_typed(tmp_path, "Limit") == "6 1\n"
    assert _run_typed(tmp_path, "Bound") == "6 0\n"


def test_sources_are_reached_through_packages_and_lists_of_names(tmp_path: Path) -> None:
    package = tmp_path / "kinematics" / "part"
    package.mkdir(parents=True)
    texts = {
        package / "__init__.py": "from kinematics.part.last import A",
        package / "first.py": "from kinematics.part import (\n    second,\n    third as other,\n)\n",
        package / "second.py": "def late():\n    from synthesis.far import B\n",
        package / "third.py": "import kinematics.part.fourth\nimport math\n",
        package / "fourth.py": "",
        package / "last.py": "",
        package / "unrelated.py": "from kinematics.part import first",
    }
    for file, text in texts.items():
        file.write_text(text)
    names = [file.stem for file in find_sources(tmp_path, package / "first.py")]
    assert names == ["__init__", "first", "fourth", "last", "second", "third"]
    assert compute_digest(tmp_path, package / "first.py") != compute_digest(tmp_path, package / "third.py")


def test_every_kernel_of_the_project_is_compiled_so() -> None:
    files = [file for package in ("kinematics", "synthesis") for file in (ROOT / package).rglob("*.py")]
    direct = {file.relative_to(ROOT) for file in files if "from numba import njit" in file.read_text()}
    assert direct == {Path("kinematics/compiling.py")}


@pytest.mark.slow
def test_what_is_installed_keeps_its_kernels_in_the_users_cache_folder(tmp_path: Path) -> None:
    installed, home = tmp_path / "site-packages", tmp_path / "home"
    package = installed / "synthesis"
    package.mkdir(parents=True)
    for name, text in {"__init__": "", "inner": INNER, "middle": MIDDLE, "outer": OUTER}.items():
        (package / f"{name}.py").write_text(text.format(compiler="kinematics.compiling", constant=1))
    environment = {key: value for key, value in os.environ.items() if key not in ("NUMBA_CACHE_DIR", "XDG_CACHE_HOME")}
    environment |= {"HOME": str(home), "PYTHONPATH": os.pathsep.join([str(installed), str(ROOT)])}
    subprocess.run([sys.executable, "-c", RUN], env=environment, cwd=tmp_path, capture_output=True, check=True)
    assert not [*installed.rglob("*.nbi")]
    assert [file.name.split("-")[0] for file in home.rglob("outer*.nbi")] == ["outer.whole"]


VECTOR = types.Array(types.float64, 1, "C")
HALF = types.float64(types.float64)
SUM = types.float64(VECTOR)


def test_a_declared_kernel_is_compiled_when_it_is_first_used_and_as_declared() -> None:
    half = njit(HALF)(lambda x: x / 2)
    assert half.signatures == []
    assert half(3) == 1.5
    assert half.signatures == [HALF.args]
    with pytest.raises(TypeError, match="No matching definition"):
        half(1j)
    assert half.signatures == [HALF.args]


def test_a_declared_kernel_is_used_by_kernels_as_a_function_and_as_an_argument() -> None:
    total, unused = njit(SUM)(lambda x: x.sum()), njit(SUM)(lambda x: x.max())
    calls = njit(lambda x: total(x) + 1.0)
    twice = njit(types.float64(types.FunctionType(SUM), VECTOR))(lambda f, x: 2.0 * f(x))
    assert calls(np.ones(3)) == 4.0
    assert twice(total, np.ones(4)) == 8.0
    passed_first = njit(SUM)(lambda x: x.min())
    assert twice(passed_first, np.ones(4)) == 2.0
    assert total.signatures == passed_first.signatures == [SUM.args]
    assert unused.signatures == []


def test_a_kernel_has_its_own_rules_whatever_kernel_calls_it_first() -> None:
    ratio = njit()(lambda x, y: x / y)
    calls = njit(error_model="python")(lambda x, y: ratio(x, y))
    assert calls(1.0, 0.0) == math.inf
    assert ratio.targetoptions["fastmath"] is False


def test_no_kernel_may_round_otherwise_than_by_the_rules() -> None:
    with pytest.raises(ValueError, match="IEEE 754"):
        njit(fastmath={"contract"})


@pytest.mark.slow
def test_no_kernel_is_compiled_by_importing_solvers(tmp_path: Path) -> None:
    """Whoever solves one kind of problem does not wait for the kernels of what the solver does not call."""
    program = (
        "from numba.core import event\n"
        "from synthesis.registry import KINDS\n"
        "import importlib, pkgutil, kinematics, synthesis\n"
        "class Compiled(event.Listener):\n"
        "    def on_start(self, started): raise SystemExit(f'compiled: {started.data[\"dispatcher\"]}')\n"
        "    def on_end(self, ended): pass\n"
        "event.register('numba:compile', Compiled())\n"
        "for package in (kinematics, synthesis):\n"
        "    for module in pkgutil.walk_packages(package.__path__, f'{package.__name__}.'):\n"
        "        importlib.import_module(module.name)\n"
    )
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": str(ROOT)}
    ended = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
