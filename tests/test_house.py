"""The house is built as docs/development/adding-a-kind.md says, where the contracts in pyproject.toml cannot say it."""

from __future__ import annotations

import ast
import importlib
import importlib.util
import re
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import get_args

import pytest

from service.render import FORMS_BY_TYPE, list_forms
from synthesis.analyses import FAMILIES
from synthesis.model.kind import Kind
from synthesis.model.mechanism_types import collect_models
from synthesis.registry import KINDS
from tests.support.loops import check_each

ROOT = Path(__file__).parents[1]
FOLDERS = sorted(folder for folder in (ROOT / "synthesis" / "kinds").iterdir() if (folder / "__init__.py").exists())

MOST_EDITED = 5
"""Files outside its own folder that a new kind may take, documentation apart."""


OURS = {"benchmarks", "kinematics", "mechsynth", "service", "synthesis", "tests", "tools"}
HEAVY = {"numba", "scipy", "cvxpy", "highspy", "ezdxf", "PIL"}


IMPORT = re.compile(r"^[ \t]*((?:from [.\w]+ import (?:\([^)]*\)|[^\n(]+))|import [^\n]+)$", re.MULTILINE)


@cache
def imports(path: Path) -> frozenset[str]:
    """The modules and names that a file imports, wherever in it; its other statements are not parsed."""
    found: set[str] = set()
    for statement in IMPORT.findall(path.read_text("utf-8")):
        try:
            (node,) = ast.parse(statement).body
        except SyntaxError:  # a sentence that begins with one of these words
            continue
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {f"{node.module}.{alias.name}" for alias in node.names}
    return frozenset(found)


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_every_kind_has_its_statement_answer_solver_proof_and_declaration(folder: Path) -> None:
    assert {"problem.py", "design.py", "solver.py"} <= {path.name for path in folder.glob("*.py")}
    assert [*folder.glob("verification.py"), *folder.glob("verification/[!_]*.py")]
    kind = KINDS[folder.name]
    assert isinstance(kind, Kind)
    assert kind.name == folder.name
    assert kind.problem.__module__ == f"synthesis.kinds.{folder.name}.problem"
    assert kind.result.__module__ == f"synthesis.kinds.{folder.name}.design"
    assert kind.examples
    assert all(statement["kind"] == kind.name for statement in kind.examples)


def test_every_kind_is_offered() -> None:
    assert sorted(KINDS) == [folder.name for folder in FOLDERS]


@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda kind: kind.name)
def test_every_mechanism_is_drawn_and_analysed(kind: Kind) -> None:
    """What has neither files nor a family of its own is a linkage, and is drawn and driven by its skeleton."""
    designs = collect_models(kind.result.model_fields["designs"].annotation)
    for model in (model for design in designs for model in collect_models(design.model_fields["mechanism"].annotation)):
        for mechanism in get_args(model.model_fields["type"].annotation):
            assert mechanism in kind.mechanisms
            assert "svg" in list_forms(mechanism)
            assert (mechanism in FAMILIES and mechanism in FORMS_BY_TYPE) or "skeleton" in model.model_fields


def test_kinematics_needs_no_library_but_numpy_numba_and_the_catalogues() -> None:
    known = {*sys.stdlib_module_names, "numpy", "numba", "fluent", "kinematics"}
    foreign = {
        (path.name, name)
        for path in (ROOT / "kinematics").rglob("*.py")
        for name in imports(path)
        if name.split(".")[0] not in known
    }
    assert foreign == set()


def test_kinds_are_known_by_name_where_they_are_listed_drawn_built_and_simulated_only() -> None:
    """What goes over all kinds asks the registry."""
    allowed = (
        "synthesis/kinds/",
        "synthesis/registry.py",
        "service/render/",
        "service/parts/",
        "service/simulation/trains.py",
    )
    files = [path for package in ("synthesis", "service") for path in (ROOT / package).rglob("*.py")]
    knowing = {
        place
        for path in files
        if not (place := path.relative_to(ROOT).as_posix()).startswith(allowed)
        and any(name.startswith("synthesis.kinds") for name in imports(path))
    }
    assert knowing == set()


NAMED_IN = (
    "synthesis/*.py",
    "synthesis/results/**/*.py",
    "synthesis/model/**/*.py",
    "synthesis/verification/**/*.py",
    "synthesis/manufacture/**/*.py",
    "synthesis/fit/**/*.py",
    "synthesis/numerics/**/*.py",
    "service/**/*.py",
)
"""Code that asks :class:`Kind` for all that it needs of a kind."""

HOMONYMS = {
    # A block of a request for an analysis.
    "motion": {
        "synthesis/results/forces.py",
        "service/answers/forces.py",
        "service/client/synchronous.py",
        "service/simulation/course.py",
        "service/warm_analysis.py",
        # The example of the documentation.
        "service/api/routes/batch_schemas.py",
        "service/api/routes/batches.py",
    },
    # The place of an error in a body, the address of a request, or an element of SVG.
    "path": {
        "service/api/http/problem_details.py",
        "service/client/values.py",
        "service/command/local.py",
        "service/jobs/faults.py",
        "service/observability/telemetry.py",
        "service/outlines/answer.py",
        "service/outlines/svg.py",
        "synthesis/model/text_messages.py",
    },
    # A result of an analysis of forces.
    "flywheel": {"synthesis/model/dynamics/request.py"},
    # Types of mechanisms that can be simulated.
    "gear_train": {"service/simulation/query.py"},
    "planetary_train": {"service/simulation/query.py"},
    "train_series": {"service/simulation/query.py"},
    "gearbox": {"service/simulation/query.py"},
    "layshaft_gearbox": {"service/simulation/query.py"},
}
"""Files in which the name of a kind stands as a string that means something else."""


def test_what_goes_over_all_kinds_names_none_in_a_string() -> None:
    """What is known of a kind stands in its folder, as a field of its :class:`Kind`."""
    drawn_and_built = ("service/render/", "service/parts/", "service/simulation/trains.py")
    files = {path for pattern in NAMED_IN for path in ROOT.glob(pattern)}
    named: dict[str, set[str]] = {}
    for path in files:
        place = path.relative_to(ROOT).as_posix()
        if place.startswith(drawn_and_built):
            continue
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value in KINDS:
                named.setdefault(node.value, set()).add(place)
    assert len(files) > 200
    assert named == HOMONYMS


def test_the_page_names_no_more_files_that_a_kind_edits_than_it_may_take() -> None:
    page = (ROOT / "docs" / "development" / "adding-a-kind.md").read_text("utf-8")
    table = page.split("## What is edited elsewhere")[1].split("\n\n")[1]
    rows = re.findall(r"^\| `([^`]+)` \|[^|]*\|([^|]*)\|([^|]*)\|$", table, re.MULTILINE)
    assert all((ROOT / file).is_file() for file, *_ in rows)
    for_linkages, for_others = (
        [mark for mark in column if "✓" in mark] for column in list(zip(*rows, strict=True))[1:]
    )
    assert 0 < len(for_linkages) <= MOST_EDITED
    assert 0 < len(for_others) <= MOST_EDITED


ASKED_BY_NAME = {
    # The value is whatever a client wrote, before it is a model, or the annotation of a field.
    "synthesis/analyses/input_motion.py",
    "synthesis/kinds/dwell/problem.py",
    "synthesis/kinds/train_series/units.py",
    "synthesis/model/dimension.py",
    # Subclasses declare these fields, each with a type of its own.
    "synthesis/model/problem.py",
    "synthesis/model/gears/stages.py",
}
"""Modules that ask for an attribute of which the value may know nothing."""


def calls(path: Path, *names: str) -> list[ast.Call]:
    """The calls of functions and methods with these names in a file."""
    text = path.read_text("utf-8")
    if not any(f"{name}(" in text for name in names):
        return []
    return [
        node
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Call)
        and (
            (isinstance(node.func, ast.Name) and node.func.id in names)
            or (isinstance(node.func, ast.Attribute) and node.func.attr in names)
        )
    ]


def test_problems_and_designs_are_asked_by_their_models_and_protocols() -> None:
    """``getattr`` with a fixed name and a default hides what a value must have; its type says so."""
    asking = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "synthesis").rglob("*.py")
        for call in calls(path, "getattr")
        if isinstance(call.args[1], ast.Constant) or (len(call.args) > 2 and ast.unparse(call.args[0]) == "problem")
    }
    assert asking == ASKED_BY_NAME


def test_designs_are_sorted_in_one_module() -> None:
    """A key that reads the metrics or the checks of a design belongs to sort_designs or select_best."""
    sorting = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "synthesis").rglob("*.py")
        if "key=" in path.read_text("utf-8")
        for call in calls(path, "sorted", "sort", "min", "max")
        for keyword in call.keywords
        if keyword.arg == "key" and re.search(r"\bdesign\b|\.metrics\b|\.verification\b", ast.unparse(keyword.value))
    }
    assert sorting == {"synthesis/results/ranking.py"}


def test_one_module_decides_what_is_measured() -> None:
    """The measurements of finished designs are imported by the module that decides on them, and for limits by those
    that search below them."""
    measuring = {"forces.add_forces", "layout.add_layout", "manufacture.add_manufacture", "manufacture.check_yield"}
    importing = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "synthesis").rglob("*.py")
        if imports(path) & {f"synthesis.results.{name}" for name in measuring}
    }
    assert importing == {"synthesis/results/measurement.py"}


@pytest.mark.slow
@pytest.mark.parametrize("module", ["synthesis.registry", "service.server.app"])
def test_who_parses_problems_waits_for_no_solver(module: str) -> None:
    """Compiled kernels and solvers are imported by those who solve, in processes of their own."""
    program = f"import sys, {module}; print(*({HEAVY} & set(sys.modules)))"
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=ROOT)
    assert run.stdout.split() == []


def test_no_test_imports_another_test_or_a_benchmark() -> None:
    """Shared code is in tests/support, or in a module of a folder of tests that is no test itself."""
    wrong = {
        (path.relative_to(ROOT).as_posix(), name)
        for path in (ROOT / "tests").rglob("*.py")
        for name in imports(path)
        if name.startswith("benchmarks") or (name.startswith("tests.") and re.search(r"\.test_", name))
    }
    assert wrong == set()


def test_no_benchmark_imports_a_test() -> None:
    wrong = {
        (path.relative_to(ROOT).as_posix(), name)
        for path in (ROOT / "benchmarks").rglob("*.py")
        for name in imports(path)
        if name.startswith("tests.") and re.search(r"\.test_", name)
    }
    assert wrong == set()


@pytest.mark.slow
def test_what_a_benchmark_imports_is_there() -> None:
    def check(path: Path) -> None:
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module and node.module.partition(".")[0] in OURS:
                module = importlib.import_module(node.module)
                for alias in node.names:
                    known = hasattr(module, alias.name) or importlib.util.find_spec(f"{node.module}.{alias.name}")
                    assert known, f"no {alias.name} in {node.module}"

    check_each(sorted((ROOT / "benchmarks").rglob("*.py")), check)
