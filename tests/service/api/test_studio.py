"""The studio's page as it is served: whole, of its type, under its policy, and without a word to another host."""

import posixpath
import re
from pathlib import Path

import pytest

import service
from service.api.pages.studio_bundle import BundleError, build_bundles, name_bundle
from service.api.pages.studio_page import POLICY, load_studio_files
from tests.support.loops import check_each

FOLDER = Path(service.__file__).parent / "studio"
NAMES = sorted(
    name
    for path in FOLDER.rglob("*")
    if path.is_file() and not (name := str(path.relative_to(FOLDER))).startswith("types/")
)
VENDORED = [name for name in NAMES if name.startswith("vendor/")]
OWN = [name for name in NAMES if not name.startswith(("vendor/", "messages/"))]
NAMESPACE = "http://www.w3.org/2000/svg"
# Types are named in comments alone: no browser requests them.
IMPORTED = re.compile(r'(?:from ?|import\()"((?!\.\.?/types/)\.\.?/[^"]+)"')
STATIC = re.compile(r'^import .*?from ?"(\.\.?/[^"]+)"', re.MULTILINE | re.DOTALL)
TYPES = {".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml",
         ".json": "application/json", ".LICENSE": "text/plain"}  # fmt: skip


def path_of(name):
    return "/" if name == "index.html" else f"/studio/{name}"


def test_every_file_of_the_folder_is_served():
    made = {name for name in load_studio_files() if name.endswith(".bundle.js")}
    assert sorted(set(load_studio_files()) - made) == NAMES
    assert made == {"studio.bundle.js", "assembly/assembly_scene.bundle.js"}
    assert not [name for name in load_studio_files() if name.startswith("types/")]


def test_a_file_is_served_with_its_type_and_the_policy(client):
    def check(name):
        answer = client.get(path_of(name))
        assert answer.status_code == 200
        if name != "index.html":
            assert answer.content == (FOLDER / name).read_bytes()
        assert answer.headers["content-type"].split(";")[0] == TYPES[Path(name).suffix]
        assert answer.headers["content-security-policy"] == POLICY
        assert answer.headers["x-content-type-options"] == "nosniff"
        again = client.get(path_of(name), headers={"If-None-Match": answer.headers["etag"]})
        assert (again.status_code, again.content) == (304, b"")

    check_each(NAMES, check)


def test_the_policy_allows_nothing_inline_and_no_other_host():
    rules = dict(rule.split(" ", 1) for rule in POLICY.split("; "))
    assert rules["default-src"] == "'none'"
    assert rules["script-src"] == rules["style-src"] == rules["connect-src"] == "'self'"
    assert "unsafe" not in POLICY
    assert "http" not in POLICY


def test_no_file_names_another_host():
    def check(name):
        text = (FOLDER / name).read_text().replace(NAMESPACE, "")
        assert not re.findall(r"(?:https?:)?//[\w-]+\.\w+", text)

    check_each(OWN, check)


def test_every_file_that_is_referred_to_exists(client):
    referred = {}
    for name in OWN:
        text = (FOLDER / name).read_text()
        linked = re.findall(r'(?:src|href)="(/[^"]*)"', text)
        for target in (*(f"/studio/{one}" for one in list_imports(name, IMPORTED)), *linked):
            referred.setdefault(target, []).append(name)
        if name == "index.html":
            assert linked
            assert not re.search(r"<style|style=|\son\w+=|<script(?![^>]*src=)", text), "inline code or styles"

    def check(target, names):
        assert client.get(target).status_code == 200, names

    check_each(referred.items(), check)


def list_imports(module, statement):
    """Return the paths that a module imports by such statements."""
    found = statement.findall((FOLDER / module).read_text())
    return [posixpath.normpath(posixpath.join(posixpath.dirname(module), specifier)) for specifier in found]


def follow_imports(statement):
    """Return the module of the page, those it imports by such statements, those that these import, and so on."""
    seen, new = set(), {"studio.js"}
    while new:
        seen |= new
        new = {target for name in new for target in list_imports(name, statement)} - seen
    return seen


def test_every_module_is_needed():
    assert follow_imports(IMPORTED) == {name for name in NAMES if name.endswith(".js")}


def test_the_page_asks_for_one_module_and_may_keep_what_it_asks_for_by_its_version(client):
    page = client.get("/").text
    linked = re.findall(r'(?:src|href)="(/studio/[^"]*)"', page)
    assert [one for one in linked if ".js?" in one] == [f"/studio/studio.bundle.js?v={versions()['studio.bundle.js']}"]
    for target in linked:
        answer = client.get(target)
        assert answer.headers["cache-control"] == "public, max-age=31536000, immutable"
        assert answer.headers.get("content-encoding") == "gzip" or len(answer.content) < 2000
        again = client.get(target, headers={"If-None-Match": answer.headers["etag"], "Accept-Encoding": "identity"})
        assert (again.status_code, again.content) == (304, b"")
        plain = client.get(target.split("?")[0] + "?v=0123456789abcdef", headers={"Accept-Encoding": "identity"})
        assert plain.headers["cache-control"] == "no-cache"
        assert "content-encoding" not in plain.headers
        assert plain.content == answer.content


def versions():
    return {name: file.version for name, file in load_studio_files().items()}


def test_a_bundle_has_each_module_once_after_those_that_it_imports():
    bundle = load_studio_files()[name_bundle("studio.js")].content.decode()
    modules = follow_imports(STATIC)
    begun = re.findall(r"^const \$([\w$]+) = (?:await \(async |\()\(\) => \{$", bundle, re.MULTILINE)
    order = [f"{name.replace('$', '/')}.js" for name in begun]
    assert sorted(order) == sorted(modules)
    for name in modules:
        for needed in list_imports(name, STATIC):
            assert order.index(needed) < order.index(name)


def test_a_bundle_exports_what_its_first_module_does_and_leaves_what_is_of_others():
    own = {
        "a.js": 'import * as b from "./b/b.js";\nimport { C } from "./vendor/c.js";\nexport const a = b.b(C);\n',
        "b/b.js": 'import {\n  e as f,\n} from "../e.js";\nexport async function b() {\n  await import("./d.js");\n}\n',
        "b/d.js": 'import { C } from "../vendor/c.js";\nexport class D {}\nexport function d() {}\n',
        "e.js": "export const e = await fetch(1);\n",
    }
    made = build_bundles(own, "a.js")
    assert "const $e = await (async () => {\nconst e = await fetch(1);" in made["a.bundle.js"]
    assert sorted(made) == ["a.bundle.js", "b/d.bundle.js"]
    assert made["a.bundle.js"].startswith('import { C } from "./vendor/c.js";\n')
    assert made["a.bundle.js"].endswith("export const { a } = $a;\n")
    assert "const { e: f } = $e;\nasync function b() {" in made["a.bundle.js"]
    assert 'await import("./b/d.bundle.js");' in made["a.bundle.js"]
    assert "const b = $b$b;" in made["a.bundle.js"]
    assert made["b/d.bundle.js"].startswith('import { C } from "../vendor/c.js";\n')
    assert made["b/d.bundle.js"].endswith("export const { D, d } = $b$d;\n")


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"a.js": 'import { b } from "./b.js";\n', "b.js": 'import { a } from "./a.js";\n'}, "import each other"),
        ({"a.js": "export let a = 1;\n"}, "a.js: a bundle cannot contain the line: export let a = 1;"),
        ({"a.js": 'import "./b.js";\n', "b.js": ""}, "cannot contain the line"),
        ({"a.js": "export default class A {}\n"}, "cannot contain the line"),
    ],
)
def test_what_a_bundle_would_change_the_meaning_of_is_refused(wrong, told):
    with pytest.raises(BundleError, match=told):
        build_bundles(wrong, "a.js")


def test_what_is_of_others_has_its_licence_and_only_its_names_are_ours():
    """As `make vendor` has it: its modules import one another by file, and nothing else."""
    assert "MIT License" in (FOLDER / "vendor" / "three.LICENSE").read_text()
    modules = {name.removeprefix("vendor/") for name in VENDORED if name.endswith(".js")}
    for name in modules:
        text = re.sub(r"/\*.*?\*/", "", (FOLDER / "vendor" / name).read_text(), flags=re.DOTALL)
        assert set(re.findall(r'from ?["\']([^"\']+)["\']', text)) <= {f"./{one}" for one in modules}
        assert not re.search(r"\beval\(|new Function\(|import\(", text)


@pytest.mark.parametrize("path", ["/studio/", "/studio/nope.js", "/studio/index.html", "/studio/..%2fapp.py"])
def test_nothing_else_is_served(client, path):
    answer = client.get(path)
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "application/problem+json"
