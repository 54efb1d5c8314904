"""Names, folders and sentences of the product follow the style that docs/decisions/0083 records."""

from __future__ import annotations

import ast
import re
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGES = ("kinematics", "synthesis", "service", "mechsynth")
MAX_MODULES = 20
"""Modules of a folder that a reader can survey at once."""

MAX_DIALECT_RATE = 8.0
"""Hits of DIALECT_PHRASES per 1000 lines of prose: some are correct English."""

VAGUE = {
    "told", "made", "held", "found", "put", "taken", "kept", "placed", "stated", "asked", "met", "seen",
    "drawn", "driven", "moved", "turned", "given", "done", "gone", "of", "at", "by", "on", "in", "to", "along",
    "beside", "within", "without", "apart", "around", "under", "towards", "across", "nearly", "surely", "such",
    "so", "much", "many", "most", "least", "whole", "every", "any", "one", "other", "once", "again", "anew",
    "alike", "even", "handy",
}  # fmt: skip
"""Words that say nothing about what a function returns; alone they are no name."""

DIALECT = {"told", "tell", "tells", "unstated", "asked", "looked", "lacking", "nearly", "roomy", "anew", "hopeless"}
"""Words that stand in no name."""

PARTICIPLES = {
    "told", "made", "held", "found", "drawn", "driven", "met", "left", "seen", "kept", "begun", "taken",
    "given", "written", "chosen", "broken", "brought", "caught", "gone", "laid", "lent", "lost", "sent",
    "shaken", "sold", "sought", "spent", "stolen", "struck", "swept", "thrown", "wound", "woven", "bent",
}  # fmt: skip
NOT_PARTICIPLES = {
    "need",
    "seed",
    "feed",
    "speed",
    "embed",
    "exceed",
    "proceed",
    "shed",
    "thread",
    "bleed",
    "weed",
    "reversed",
    "sorted",
}

DIALECT_PHRASES = re.compile(
    r"\b(told|tells|unstated|nobody|whoever|whatever|beside (?:it|them|this|that|one another)|asked for|called for"
    r"|looked (?:at|for|after)|what (?:comes|becomes) of)\b"
)


@pytest.fixture(scope="module")
def trees() -> list[tuple[Path, ast.Module]]:
    files = [path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py"))]
    return [(path, ast.parse(path.read_text("utf-8"))) for path in files if "migrations" not in path.parts]


def words(name: str) -> list[str]:
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower().strip("_").split("_")


def is_participle(word: str) -> bool:
    return word in PARTICIPLES or (len(word) > 4 and word.endswith("ed") and word not in NOT_PARTICIPLES)


def is_property(node: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    names = {getattr(mark, "attr", getattr(mark, "id", "")) for mark in node.decorator_list}
    return bool(names & {"property", "cached_property", "computed_field"})


def test_functions_are_named_by_what_they_do_or_return(trees: list[tuple[Path, ast.Module]]) -> None:
    wrong = []
    for path, tree in trees:
        for node in ast.walk(tree):
            if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) or node.name.startswith("__"):
                continue
            parts = words(node.name)
            named_by_mood = parts[0] in VAGUE if len(parts) == 1 else set(parts) & DIALECT
            if named_by_mood or (is_participle(parts[0]) and not is_property(node)):
                wrong.append(f"{path.relative_to(ROOT)}:{node.lineno} {node.name}")
    assert wrong == []


def test_constants_name_a_quantity(trees: list[tuple[Path, ast.Module]]) -> None:
    wrong = []
    for path, tree in trees:
        for node in tree.body:
            targets = node.targets if isinstance(node, ast.Assign) else []
            for name in (part for target in targets for part in ast.walk(target) if isinstance(part, ast.Name)):
                parts = words(name.id)
                if name.id.isupper() and (parts[0] in {"most", "least", "fewest"} or set(parts) & DIALECT):
                    wrong.append(f"{path.relative_to(ROOT)}:{node.lineno} {name.id}")
    assert wrong == []


def test_folders_can_be_surveyed() -> None:
    folders: Counter[Path] = Counter()
    for package in PACKAGES:
        for path in (ROOT / package).rglob("*"):
            if path.suffix in {".py", ".js"} and "vendor" not in path.parts:
                folders[path.parent] += 1
    crowded = {folder.relative_to(ROOT).as_posix(): count for folder, count in folders.items() if count > MAX_MODULES}
    assert crowded == {}


def test_prose_is_plain(trees: list[tuple[Path, ast.Module]]) -> None:
    lines, hits = 0, []
    for path, tree in trees:
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value:
                lines += node.value.count("\n") + 1
                hits += [f"{path.relative_to(ROOT)}:{node.lineno} {hit}" for hit in DIALECT_PHRASES.findall(node.value)]
    assert 1000.0 * len(hits) / lines < MAX_DIALECT_RATE, hits
