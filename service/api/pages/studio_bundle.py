"""Bundle the modules of the page, so that a browser sends one request and not one for each module.

Each module becomes a function that is called at once and returns the exports of the module. Imports become references
to the values returned by the functions of earlier modules. In ``canvas/grid.js``::

    import { el } from "../core/dom.js";              const $canvas$grid = (() => {
    export function grid(view) { ... }       becomes  const { el } = $core$dom;
                                                      function grid(view) { ... }
                                                      return { grid };
                                                      })();

This keeps the meaning only of modules written as ours are, and anything else is refused: imports and exports begin a
line and name every binding, exported bindings are never reassigned, and no two modules import each other. A module with
a top-level ``await`` becomes an async function that is awaited. The bundle is not minified: an error message of a
browser can be found in the sources.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Mapping
from graphlib import CycleError, TopologicalSorter

SUFFIX = ".bundle.js"
"""Ending of the name of a bundle, in place of the ``.js`` of its first module."""

_IMPORT = re.compile(
    r'^import (?:\{\s+(?P<names>[^}]+?),?\s+\}|\* as (?P<namespace>\w+)) from "(?P<specifier>\.\.?/[\w./]+)";$',
    re.MULTILINE,
)
_EXPORT = re.compile(r"^export (?=(?:async )?(?:function|class|const) (\w+))", re.MULTILINE)
_UNSUPPORTED_STATEMENT = re.compile(r"^(?:import|export)\b.*$", re.MULTILINE)
_TOP_LEVEL_AWAIT = re.compile(r"^(?:export )?const \w+ = (?:.* )?await ", re.MULTILINE)

# A dynamic import. The types in comments have the same form, but a bracket, a space or a dot follows them.
_DYNAMIC_IMPORT = re.compile(r'import\("(\.\.?/[\w./]+\.js)"\)(?=[,;)\]])')


class BundleError(Exception):
    """The modules cannot be bundled; the message says why."""


def build_bundles(modules: Mapping[str, str], first: str) -> dict[str, str]:
    """Bundle the module ``first`` with its imports, and likewise every module that is imported dynamically.

    Parameters
    ----------
    modules
        The text of each module by its path, such as ``core/dom.js``. Imports of other modules stay imports.
    first
        The path of the module that the page loads.

    Returns
    -------
    dict[str, str]
        The text of each bundle by its path.

    Raises
    ------
    BundleError
        If a module imports or exports in an unsupported way, or if modules import each other.
    """
    bundles: dict[str, str] = {}
    pending = [first]
    while pending:
        entry = pending.pop()
        if name_bundle(entry) in bundles:
            continue
        order = _sort_by_imports(modules, entry)
        pending += [_resolve(name, found) for name in order for found in _DYNAMIC_IMPORT.findall(modules[name])]
        bundles[name_bundle(entry)] = _concatenate(modules, order)
    return bundles


def name_bundle(module: str) -> str:
    """Return the path of the bundle that starts at a module.

    >>> name_bundle("assembly/assembly_scene.js")
    'assembly/assembly_scene.bundle.js'
    """
    return module.removesuffix(".js") + SUFFIX


def _sort_by_imports(modules: Mapping[str, str], entry: str) -> list[str]:
    """List the entry and all that it imports, each module after its own imports."""
    imports: dict[str, list[str]] = {}
    pending = [entry]
    while pending:
        name = pending.pop()
        if name not in imports:
            targets = [_resolve(name, match["specifier"]) for match in _IMPORT.finditer(modules[name])]
            imports[name] = [target for target in targets if target in modules]
            pending += imports[name]
    try:
        return list(TopologicalSorter(imports).static_order())
    except CycleError as error:
        raise BundleError(f"these modules import each other: {', '.join(error.args[1])}") from None


def _concatenate(modules: Mapping[str, str], order: list[str]) -> str:
    """Write the modules as functions, one after the other; the last one is the entry."""
    entry = order[-1]
    external: dict[str, None] = {}  # a dictionary keeps the order of the imports
    parts: list[str] = []
    exports: list[str] = []
    for name in order:
        exports = _EXPORT.findall(modules[name])
        body = _EXPORT.sub("", _replace_imports(modules, name, entry, external))
        if unsupported := _UNSUPPORTED_STATEMENT.search(body):
            raise BundleError(f"{name}: a bundle cannot contain the line: {unsupported.group()}")
        call = "await (async () =>" if _TOP_LEVEL_AWAIT.search(body) else "(() =>"
        parts.append(f"const {_variable(name)} = {call} {{\n{body}return {{ {', '.join(exports)} }};\n}})();\n")
    parts.append(f"export const {{ {', '.join(exports)} }} = {_variable(entry)};\n")
    return "\n".join([*external, *parts])


def _replace_imports(modules: Mapping[str, str], name: str, entry: str, external: dict[str, None]) -> str:
    """Replace the imports of a module by references, and collect in ``external`` those of modules outside."""

    def refer(match: re.Match[str]) -> str:
        target = _resolve(name, match["specifier"])
        if target not in modules:
            external[match.group().replace(match["specifier"], _specifier(entry, target))] = None
            return ""
        bindings = match["namespace"] or f"{{ {match['names'].replace(' as ', ': ')} }}"
        return f"const {bindings} = {_variable(target)};"

    def load_bundle(match: re.Match[str]) -> str:
        return f'import("{_specifier(entry, name_bundle(_resolve(name, match[1])))}")'

    return _DYNAMIC_IMPORT.sub(load_bundle, _IMPORT.sub(refer, modules[name]))


def _resolve(importer: str, specifier: str) -> str:
    """Return the path of the module that a specifier names, seen from the module that imports it."""
    return posixpath.normpath(posixpath.join(posixpath.dirname(importer), specifier))


def _specifier(importer: str, target: str) -> str:
    """Return the relative specifier by which a module imports another one.

    >>> _specifier("assembly/assembly_scene.js", "vendor/three.module.min.js"), _specifier("studio.js", "core/dom.js")
    ('../vendor/three.module.min.js', './core/dom.js')
    """
    path = posixpath.relpath(target, posixpath.dirname(importer) or ".")
    return path if path.startswith(".") else f"./{path}"


def _variable(module: str) -> str:
    """Return the name of the variable that holds the exports of a module."""
    return f"${module.removesuffix('.js').replace('/', '$')}"
