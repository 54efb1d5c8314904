"""The names of the library are those of the API, whole."""

import subprocess
import sys
from pathlib import Path

import pytest

import mechsynth
from mechsynth import kinds, parts
from mechsynth.statements import build_statement
from synthesis.model.mechanism_types import collect_models
from synthesis.registry import KINDS, list_examples, parse_problem

ROOT = Path(__file__).parents[2]
MADE = {"GearTrainUnit", "PlanetaryUnit"}
"""Models that are made of others when they are imported, which no type checker sees."""


def class_of(kind):
    return getattr(mechsynth, "".join(word.capitalize() for word in kind.split("_")))


def stated(model, seen):
    """All models that a statement can hold."""
    for field in model.model_fields.values():
        for part in collect_models(field.annotation):
            if part not in seen:
                seen.add(part)
                stated(part, seen)
    return seen


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_is_a_class_that_states_its_kind(kind):
    of_kind = class_of(kind)
    assert of_kind.__name__ in kinds.__all__
    assert of_kind.model_fields.keys() == KINDS[kind].problem.model_fields.keys()
    for example in list_examples(kind):
        fields = {name: value for name, value in example.items() if name != "kind"}
        statement = build_statement(of_kind.model_validate(fields))
        assert statement["kind"] == kind
        assert parse_problem(statement) == parse_problem(example)


def test_every_part_of_a_statement_has_a_name():
    problems = {kind.problem for kind in KINDS.values()}
    every = set().union(*(stated(problem, set()) for problem in problems)) - problems
    named = [getattr(parts, name) for name in parts.__all__]
    unnamed = {model.__name__ for model in every - set(named)}
    assert unnamed == MADE, "list them in mechsynth/parts.py"
    assert len(set(named)) == len(named)
    assert all(getattr(parts, name).__name__ == name for name in parts.__all__)


def test_what_is_promised_is_there():
    assert all(hasattr(mechsynth, name) for name in mechsynth.__all__)
    assert len(kinds.__all__) == len(KINDS)
    assert {"solve", "Client", "AsyncClient", *kinds.__all__} <= set(mechsynth.__all__)


def checked(folder, program):
    """What a strict type checker says of a program, without this project's settings and plugins."""
    (folder / "program.py").write_text(program)
    (folder / "settings.ini").write_text("[mypy]\nstrict = True\nfollow_imports = silent\n")
    command = [sys.executable, "-m", "mypy", "--config-file", "settings.ini", "--cache-dir", "cache", "program.py"]
    done = subprocess.run(command, cwd=folder, env={"MYPYPATH": str(ROOT), "PATH": ""}, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


@pytest.mark.campaign
def test_a_program_that_uses_the_library_is_strictly_typed(tmp_path):
    program = Path(__file__).with_name("program.py").read_text()
    assert checked(tmp_path, program) == (0, "Success: no issues found in 1 source file\n")
    wrong = program.replace("positions=places", "positons=places")
    assert wrong != program
    status, said = checked(tmp_path, wrong)
    assert status == 1
    assert 'Unexpected keyword argument "positons" for "Motion"' in said
