"""A kernel on disk is the kernel of the sources as they stand now, those in other files too."""

import os
import subprocess
import sys
from pathlib import Path

from kinematics.compiling import digest, sources

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
    for name, text in {"__init__": "", "inner": INNER, "middle": MIDDLE, "outer": OUTER}.items():
        (package / f"{name}.py").write_text(text.format(compiler=compiler, constant=constant))
    paths = os.pathsep.join([str(folder), str(ROOT)])
    environment = {key: value for key, value in os.environ.items() if key != "NUMBA_CACHE_DIR"}
    environment |= {"PYTHONPATH": paths, "PYTHONDONTWRITEBYTECODE": "1"}
    ended = subprocess.run(
        [sys.executable, "-c", RUN], env=environment, cwd=folder, capture_output=True, text=True, check=True
    )
    return [int(word) for word in ended.stdout.split()]


def test_a_kernel_follows_the_files_that_it_inlines(tmp_path: Path) -> None:
    assert _run(tmp_path, "kinematics.compiling", 1) == [20, 0]
    assert _run(tmp_path, "kinematics.compiling", 1) == [20, 1]
    assert _run(tmp_path, "kinematics.compiling", 2) == [30, 0]


def test_the_compiler_alone_does_not(tmp_path: Path) -> None:
    assert _run(tmp_path, "numba", 1) == [20, 0]
    assert _run(tmp_path, "numba", 2) == [20, 1]  # the reason for the digest; where it fails, the digest can go


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
    names = [file.stem for file in sources(tmp_path, package / "first.py")]
    assert names == ["__init__", "first", "fourth", "last", "second", "third"]
    assert digest(tmp_path, package / "first.py") != digest(tmp_path, package / "third.py")


def test_every_kernel_of_the_project_is_compiled_so() -> None:
    files = [file for package in ("kinematics", "synthesis") for file in (ROOT / package).rglob("*.py")]
    direct = {file.relative_to(ROOT) for file in files if "from numba import njit" in file.read_text()}
    assert direct == {Path("kinematics/compiling.py")}
