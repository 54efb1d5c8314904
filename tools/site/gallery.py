"""The gallery: solved machines, each solved again at every build by the code that its page shows.

An entry is a file in ``docs/gallery/``. It has a heading, a one-line description, its group, a problem, and the JSON
pointers to the numbers that its page shows. All numbers on a page come from the answer, and the library draws and
animates the design.
"""

from __future__ import annotations

import io
import json
import os
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from tools.site.http_reference import guide
from tools.site.pages import check_anchor

GROUPS = {
    "bodies": "Bodies that are carried",
    "paths": "Points on a path",
    "functions": "Outputs that follow their inputs",
    "strokes": "Strokes, dwells and steps",
    "gears": "Gears",
    "cams": "Cams",
    "forces": "Masses and springs",
}
"""Headings of the groups of entries, in the order of the page."""

FOLDER = "gallery"
PROCESSES = 2
SHOWN = ("svg", "gif")
"""File formats that a page shows, if they are available for its mechanism."""

WIDTH = 96
STILL_WIDTH = 480


@dataclass(frozen=True)
class Entry:
    """A machine of the gallery: its problem and the texts of its page.

    Attributes
    ----------
    name : str
        Name of its file and of its page, without suffix.
    title, line : str
        Heading, and a one-sentence description.
    group : str
        One of :data:`GROUPS`.
    problem : dict
        Problem as JSON-like data.
    numbers : dict
        JSON pointers into the answer, by the labels of the numbers there.
    """

    name: str
    title: str
    line: str
    group: str
    problem: dict[str, Any]
    numbers: dict[str, str]


def entries(folder: Path) -> list[Entry]:
    """Return all entries of a folder, sorted by group and then by name.

    Raises
    ------
    TypeError
        If a file has missing or unknown fields.
    """
    listed = [Entry(path.stem, **json.loads(path.read_text("utf-8"))) for path in sorted(folder.glob("*.json"))]
    order = list(GROUPS)
    return sorted(listed, key=lambda entry: (order.index(entry.group), entry.name))


def at(answer: Any, pointer: str) -> Any:
    """Return the value at a JSON pointer into an answer; raise LookupError if there is none."""
    for key in pointer.split("/")[1:]:
        answer = answer[int(key)] if isinstance(answer, list) else answer[key]
    return answer


def written(source: Path, folder: Path, told: Callable[[str], None] = print) -> list[tuple[str, str]]:
    """Solve all entries and write their pages below a folder; return titles and paths there for the navigation."""
    listed = entries(source)
    (folder / FOLDER).mkdir(parents=True, exist_ok=True)
    with ProcessPoolExecutor(PROCESSES, mp_context=get_context("spawn")) as pool:
        for entry in pool.map(_made, listed, [folder] * len(listed)):
            told(f"gallery: {entry}")
    (folder / FOLDER / "index.md").write_text(_index(listed, folder), encoding="utf-8")
    return [("", f"{FOLDER}/index.md"), *((entry.title, f"{FOLDER}/{entry.name}.md") for entry in listed)]


def _made(entry: Entry, folder: Path) -> str:
    """Solve an entry, write its page, and return its name; runs in a worker process."""
    place = folder / FOLDER / entry.name
    place.mkdir(parents=True, exist_ok=True)
    os.chdir(place)
    known: dict[str, Any] = {"print": lambda *_: None}
    solving = solving_code(entry)
    exec(compile(solving, f"{entry.name}.py", "exec"), known)  # so the page shows exactly the code that was run
    result = known["result"]
    if not result.designs or not result.designs[0].passed:
        raise ValueError(f"{entry.name}: no design passed: {result.summary}")
    forms = [form for form in SHOWN if form in result.designs[0].forms]
    drawing = drawing_code(entry, forms)
    exec(compile(drawing, f"{entry.name}.py", "exec"), known)
    Path("problem.json").write_text(laid_out(entry.problem, json.dumps) + "\n", encoding="utf-8")
    answer = json.loads(result.to_json())
    Path("answer.json").write_text(json.dumps(answer, indent=1), encoding="utf-8")
    if "gif" in forms:
        Path("still.png").write_bytes(_still(Path(f"{entry.name}.gif")))
    page = folder / FOLDER / f"{entry.name}.md"
    page.write_text(_page(entry, solving + drawing, answer, forms), encoding="utf-8")
    return entry.name


def solving_code(entry: Entry) -> str:
    """Return the Python code that solves an entry."""
    lines = [
        "from mechsynth import solve",
        "",
        f"problem = {laid_out(entry.problem, repr)}",
        f"result = solve(problem, label={_quoted(entry.title)})",
        "print(result.summary)",
    ]
    return "\n".join(lines) + "\n"


def drawing_code(entry: Entry, forms: Iterable[str]) -> str:
    """Return the Python code that follows the solution and writes the page's drawings to the current folder."""
    return "".join(f'result.designs[0].to_{form}("{entry.name}.{form}")\n' for form in forms)


def shell_code(entry: Entry, forms: Iterable[str]) -> str:
    """Return shell commands that solve an entry and fetch its drawings from a running service."""
    body = laid_out({"problem": entry.problem, "label": entry.title}, json.dumps)
    drawings = [f'curl -s "$SERVICE/v1/jobs/$JOB/designs/0.{form}" -o {entry.name}.{form}' for form in forms]
    lines = [
        "SERVICE=http://127.0.0.1:8000",
        "JOB=$(curl -s $SERVICE/v1/jobs -H 'Content-Type: application/json' -H 'Prefer: wait=30' -d '",
        f"{body}' | python3 -c 'import json, sys; print(json.load(sys.stdin)[\"id\"])')",
        'curl -s "$SERVICE/v1/jobs/$JOB"',
        *drawings,
    ]
    return "\n".join(lines) + "\n"


def laid_out(value: Any, literal: Callable[[Any], str], indent: str = "") -> str:
    """Format a value as JSON or Python code, on one line if it fits.

    ``literal`` formats numbers, booleans and null: ``json.dumps`` gives JSON, ``repr`` gives Python.
    """
    flat = _flat(value, literal)
    if len(indent) + len(flat) <= WIDTH or not isinstance(value, dict | list) or not value:
        return flat
    inner = indent + "  "
    if isinstance(value, dict):
        members = [f"{json.dumps(key)}: {laid_out(member, literal, inner)}" for key, member in value.items()]
        opening, closing = "{}"
    else:
        members = [laid_out(member, literal, inner) for member in value]
        opening, closing = "[]"
    joined = f",\n{inner}".join(members)
    return f"{opening}\n{inner}{joined}\n{indent}{closing}"


def _quoted(text: str) -> str:
    """Return a text as a string literal that is valid in both JSON and Python."""
    return json.dumps(text, ensure_ascii=False)


def _flat(value: Any, literal: Callable[[Any], str]) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)}: {_flat(member, literal)}" for key, member in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(_flat(member, literal) for member in value) + "]"
    return _quoted(value) if isinstance(value, str) else literal(value)


def _still(animation: Path) -> bytes:
    """Return the first frame of an animation as PNG."""
    from PIL import Image

    with Image.open(animation) as frames:
        frames.seek(0)
        still = frames.convert("RGB")
    still.thumbnail((STILL_WIDTH, STILL_WIDTH))
    out = io.BytesIO()
    still.quantize(64).save(out, "PNG", optimize=True)
    return out.getvalue()


def _page(entry: Entry, code: str, answer: Any, forms: list[str]) -> str:
    name, best = entry.name, answer["designs"][0]
    numbers = "".join(f"| {label} | {shown(at(answer, place))} |\n" for label, place in entry.numbers.items())
    checks = "".join(
        f"| [`{check['name']}`](../reference/checks.md#{check_anchor(check['name'])}) "
        f"| {shown(check.get('value', True))} | {shown(check.get('limit'))} |\n"
        for check in best["verification"]["checks"]
    )
    several = f", and {len(answer['designs']) - 1} more" if len(answer["designs"]) > 1 else ""
    drawn = f"[![{entry.title}, labelled]({name}/{name}.svg){{ .drawn }}]({name}/{name}.svg)\n"
    if "gif" in forms:
        still = f"![{entry.title}]({name}/still.png){{ .drawn .calm }}"
        first = f"{still}![{entry.title}, moving]({name}/{name}.gif){{ .drawn .lively }}\n"
        last = f"## Drawing\n\n{drawn}"
    else:
        first, last = drawn, ""
    return (
        f"# {entry.title}\n\n{entry.line}\n\n{first}\n"
        f"{answer['summary']}\n\n"
        f"| the best design{several} | `{best['mechanism']['type']}` |\n|---|---|\n{numbers}\n"
        f"It was driven from its dimensions alone, and all its checks passed.\n\n"
        f"| check | value | limit |\n|---|---|---|\n{checks}\n"
        f"## Statement\n\n"
        f"Its fields are those of [`{entry.problem['kind']}`](../{guide(entry.problem['kind'])}); the whole answer is "
        f"[answer.json]({name}/answer.json).\n\n"
        f'=== "Python"\n\n{_fenced("python", code)}\n'
        f'=== "HTTP"\n\n{_fenced("sh", shell_code(entry, forms))}\n'
        f'=== "JSON"\n\n{_fenced("json", laid_out(entry.problem, json.dumps))}\n'
        f"{last}"
    )


def _fenced(language: str, code: str) -> str:
    lines = [f"```{language}", *code.rstrip("\n").split("\n"), "```"]
    return "".join(f"    {line}".rstrip() + "\n" for line in lines)


def shown(value: Any) -> str:
    """Format a value of an answer for reading, with numbers to six digits."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "kept" if value else "not kept"
    if isinstance(value, list):
        return ", ".join(shown(member) for member in value)
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _index(listed: list[Entry], folder: Path) -> str:
    """Return the index page, which shows all machines by group."""
    text = [
        f"---\nhide: [toc]\n---\n# Gallery\n\n{len(listed)} machines, each stated as a problem, solved and driven by "
        "the program that its page shows when this site was built. Point at one to see it move.\n\n"
    ]
    for group, title in GROUPS.items():
        text.append(f'## {title}\n\n<div class="machines" markdown>\n\n')
        text += [_card(entry, folder) for entry in listed if entry.group == group]
        text.append("</div>\n\n")
    return "".join(text)


def _card(entry: Entry, folder: Path) -> str:
    name = entry.name
    if (folder / FOLDER / name / "still.png").exists():
        pictures = (
            f"![]({name}/still.png){{ .still loading=lazy }}"
            f"![{entry.title}, moving]({name}/{name}.gif){{ .moving loading=lazy }}"
        )
    else:
        pictures = f"![{entry.title}]({name}/{name}.svg){{ .still loading=lazy }}"
    return f'<div class="machine" markdown>\n[{pictures}**{entry.title}**]({name}.md)\n{entry.line}\n</div>\n\n'
