"""The site that ``make docs`` makes: every link of it holds, and what it shows has run."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

from synthesis.registry import KINDS, parse_problem
from tests.support.service.api_document import read_api_document
from tools.site import gallery, http_reference
from tools.site.__main__ import ROOT, main
from tools.site.docstrings import as_markdown
from tools.site.pages import TASKS, check_anchor

ENTRIES = gallery.entries(ROOT / "docs" / "gallery")


def of_the_site(test):
    """Whichever test comes first has the whole site made, which takes a minute on two quiet processors."""
    return pytest.mark.site(pytest.mark.timeout(900)(test))


class Page(HTMLParser):
    """What a page links to, what it loads, and the places that it has."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.places: set[str] = {""}
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        stated = dict(attributes)
        self.places |= {value for name in ("id", "name") if (value := stated.get(name))}
        if tag == "a" and (link := stated.get("href")) is not None:
            self.links.append(link)
        elif (source := stated.get("src") or (stated.get("href") if tag == "link" else None)) is not None:
            self.loaded.append(source)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The whole site, and beside it the pages that it was made of."""
    out = tmp_path_factory.mktemp("out")
    assert main(out) == 0, "mkdocs has warned of something"
    return out


@pytest.fixture(scope="module")
def pages(made: Path) -> dict[Path, Page]:
    return {path: Page(path.read_text("utf-8")) for path in sorted((made / "site").rglob("*.html"))}


@of_the_site
def test_every_link_of_the_site_leads_somewhere(made: Path, pages: dict[Path, Page]) -> None:
    assert len(pages) > 150
    broken = []
    for path, page in pages.items():
        if path.name == "404.html":  # its links are from the root of whatever server it is on
            continue
        for link in [*page.links, *page.loaded]:
            parts = urlsplit(link)
            if parts.scheme:
                continue
            to = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not to.exists() or (to.suffix == ".html" and unquote(parts.fragment) not in pages[to].places):
                broken.append((str(path.relative_to(made)), link))
    assert broken == []


@of_the_site
def test_nothing_is_loaded_from_elsewhere(made: Path, pages: dict[Path, Page]) -> None:
    foreign = {source for page in pages.values() for source in page.loaded if urlsplit(source).netloc}
    assert foreign == set()
    sheets = [path.read_text("utf-8") for path in (made / "site").rglob("*.css")]
    assert sheets
    assert not [
        found for sheet in sheets for found in re.findall(r"(?:url\(|@import )[\"']?(?:https?:)?//[^)\"']+", sheet)
    ]
    assert {urlsplit(link).netloc for page in pages.values() for link in page.links} <= {
        "",
        "doi.org",
        "127.0.0.1:8000",
        # The programs that exported models are for.
        "app.pmksplus.com",
        "mujoco.readthedocs.io",
    }


@of_the_site
@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.name)
def test_what_the_page_of_a_machine_tells_is_what_its_run_answered(made: Path, entry: gallery.Entry) -> None:
    folder = made / "site" / "gallery" / entry.name
    answer = json.loads((folder / "answer.json").read_text("utf-8"))
    best = answer["designs"][0]
    page = (made / "pages" / "gallery" / f"{entry.name}.md").read_text("utf-8")
    assert best["verification"]["passed"]
    assert answer["summary"] in page
    rows = dict(re.findall(r"^\| ([^|]+) \| ([^|]+) \|$", page, re.MULTILINE))
    for label, place in entry.numbers.items():
        value = gallery.at(answer, place)
        if isinstance(value, float):
            assert float(rows[label]) == pytest.approx(value, rel=1e-5)
        else:
            assert rows[label] == str(value).strip("[]")
    for check in best["verification"]["checks"]:
        assert f"| [`{check['name']}`](../reference/checks.md#{check_anchor(check['name'])}) |" in page
    drawn = (folder / f"{entry.name}.svg").read_text("utf-8")
    assert f"{entry.title}, design 1" in drawn.replace("&#x27;", "'").replace("&amp;", "&")
    assert json.loads((folder / "problem.json").read_text("utf-8")) == entry.problem


@of_the_site
def test_machines_that_move_are_shown_moving(made: Path) -> None:
    moving = {path.parent.name for path in (made / "site" / "gallery").rglob("*.gif")}
    still = {entry.name for entry in ENTRIES} - moving
    without = {"rotor", "flywheel", "engine", "ratchet"}
    types = {name: json.loads((made / "site" / "gallery" / name / "answer.json").read_text("utf-8")) for name in still}
    assert {answer["designs"][0]["mechanism"]["type"] for answer in types.values()} == without
    assert all(path.read_bytes().startswith(b"GIF89a") for path in (made / "site" / "gallery").rglob("*.gif"))


@of_the_site
def test_notebooks_have_run(made: Path) -> None:
    notebooks = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
    assert notebooks
    for path in notebooks:
        cells = json.loads(path.read_text("utf-8"))["cells"]
        assert not [cell for cell in cells if cell.get("outputs")], "outputs come from the run"
        page = (made / "site" / "notebooks" / f"{path.stem}.html").read_text("utf-8")
        assert page.count('class="output"') >= 2
        assert "<svg" in page


def test_every_page_has_its_place_in_the_nav() -> None:
    template = (ROOT / "tools" / "site" / "mkdocs.yml").read_text("utf-8")
    listed = re.findall(r"- (?:[^:\n]+: )?(\S+\.md)$", template, re.MULTILINE)
    docs = ROOT / "docs"
    pages = {path.relative_to(docs).as_posix() for path in docs.rglob("*.md")}
    assert set(listed) - {TASKS} == {page for page in pages if not page.startswith(("decisions/", "gallery/"))}
    assert len(set(listed)) == len(listed)


def test_there_is_a_machine_of_every_kind() -> None:
    assert {entry.problem["kind"] for entry in ENTRIES} == set(KINDS)
    assert len(ENTRIES) >= 40
    assert {entry.group for entry in ENTRIES} == set(gallery.GROUPS)
    assert len({entry.title for entry in ENTRIES}) == len(ENTRIES)


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.name)
def test_a_machine_is_stated_the_same_over_http_in_python_and_as_json(entry: gallery.Entry) -> None:
    parse_problem(entry.problem).require_consistent()
    assert entry.numbers
    assert all(place.startswith("/designs/0/") for place in entry.numbers.values())
    shell = gallery.shell_code(entry, ["svg", "gif"])
    (body,) = re.findall(r"-d '\n(.*?)' \| python3", shell, re.DOTALL)
    assert json.loads(body) == {"problem": entry.problem, "label": entry.title}
    known: dict[str, object] = {}
    exec(gallery.solving_code(entry).split("result = ")[0], known)
    assert known["problem"] == entry.problem


@pytest.mark.slow
def test_the_reference_has_every_operation_every_model_and_every_field_once() -> None:
    document = read_api_document()
    pages = http_reference.http_reference(document)
    whole = "\n".join(pages.values())
    for name, model in document["components"]["schemas"].items():
        (section,) = re.findall(rf"^#+ {name} {{ #model-\S+ }}\n(.*?)(?=^#|\Z)", whole, re.MULTILINE | re.DOTALL)
        assert re.findall(r"^\| `([^`]+)` \|", section, re.MULTILINE) == list(model.get("properties", {}))
    for path, methods in document["paths"].items():
        for method in methods:
            assert whole.count(f"```http\n{method.upper()} {path}\n```") == 1
    assert {f"{kind}.md" for kind in KINDS} <= pages.keys()


def test_values_are_laid_out_as_they_are() -> None:
    value = {"a": [1.5, None, True, "it's"], "b": [{"c": [float(n) for n in range(60)]}], "empty": [], "none": {}}
    assert json.loads(gallery.laid_out(value, json.dumps)) == value
    assert eval(gallery.laid_out(value, repr)) == value
    assert max(map(len, gallery.laid_out(value, json.dumps).split("\n"))) <= gallery.WIDTH


def test_docstrings_become_markdown() -> None:
    text = "Solve, as :func:`~a.b.solve` does, with ``x``.\n\n>>> f(1)\n[2]\n\nMore."
    expected = "Solve, as `a.b.solve` does, with `x`.\n\n```python\n>>> f(1)\n[2]\n```\n\nMore."
    assert as_markdown(text) == expected
