"""Bundles of the page's modules, so that a browser needs one request instead of one for each module.

A module becomes a function that is called at once and returns its exports; its imports are taken from the returned
values of the modules before it::

    import { el } from "./dom.js";                    const $grid = (() => {
    export function grid(view) { ... }       becomes  const { el } = $dom;
                                                      function grid(view) { ... }
                                                      return { grid };
                                                      })();

This is correct for modules of the form that the page uses, and any other form is refused: imports and exports begin a
line and name their bindings, exported bindings are never reassigned, and no modules import each other. A module with a
top-level ``await`` becomes an async function that is awaited. Nothing is minified, so that positions in browser
messages can be found in the sources.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from graphlib import CycleError, TopologicalSorter

BUNDLE_SUFFIX = ".bundle.js"
"""Suffix of a bundle's name, which replaces ``.js`` of its first module."""

_IMPORT = re.compile(
    r'^import (?:\{ (?P<names>[^}]+) \}|\* as (?P<all>\w+)) from "\./(?P<module>[\w./]+)";$', re.MULTILINE
)
_EXPORT = re.compile(r"^export (?=(?:async )?(?:function|class|const) (\w+))", re.MULTILINE)
_OTHER_STATEMENT = re.compile(r"^(?:import|export)\b.*$", re.MULTILINE)
_AWAITING_CONST = re.compile(r"^(?:export )?const \w+ = (?:.* )?await ", re.MULTILINE)
"""A module with a top-level ``await``."""
_LAZY_IMPORT = re.compile(r'import\("\./(\w+)\.js"\)(?=[,;)\]])')
"""A dynamic import, which begins a bundle of its own. Types in comments have another form."""


class BundleError(Exception):
    """The modules cannot be bundled; the message has the reason."""


def build_bundles(modules: Mapping[str, str], first: str) -> dict[str, str]:
    """Return the bundle that begins with the module ``first``, and all bundles imported dynamically, by name.

    Parameters
    ----------
    modules
        The text of each module by name, such as ``dom.js``. Imports of other modules are kept as they are.

    Raises
    ------
    BundleError
        If a module has an unsupported import or export, or modules import each other.
    """
    made: dict[str, str] = {}
    wanted = [first]
    while wanted:
        begins = wanted.pop()
        if name_bundle(begins) in made:
            continue
        order = _sort_modules(modules, begins)
        wanted += [f"{later}.js" for name in order for later in _LAZY_IMPORT.findall(modules[name])]
        made[name_bundle(begins)] = _join_modules(modules, order)
    return made


def name_bundle(module: str) -> str:
    """Return the name of the bundle that begins with a module.

    >>> name_of("studio.js")
    'studio.bundle.js'
    """
    return module.removesuffix(".js") + BUNDLE_SUFFIX


def _sort_modules(modules: Mapping[str, str], first: str) -> list[str]:
    needs: dict[str, list[str]] = {}
    new = [first]
    while new:
        name = new.pop()
        if name not in needs:
            imported = [found["module"] for found in _IMPORT.finditer(modules[name])]
            needs[name] = [one for one in imported if one in modules]
            new += needs[name]
    try:
        return list(TopologicalSorter(needs).static_order())
    except CycleError as error:
        raise BundleError(f"these modules import each other: {', '.join(error.args[1])}") from None


def _join_modules(modules: Mapping[str, str], order: list[str]) -> str:
    outside: dict[str, None] = {}

    def replace_import(found: re.Match[str]) -> str:
        if found["module"] not in modules:
            outside[found.group()] = None
            return ""
        what = found["all"] or f"{{ {found['names'].replace(' as ', ': ')} }}"
        return f"const {what} = {_name_variable(found['module'])};"

    parts: list[str] = []
    exported: list[str] = []
    for name in order:
        exported = _EXPORT.findall(modules[name])
        text = _EXPORT.sub("", _IMPORT.sub(replace_import, modules[name]))
        if other := _OTHER_STATEMENT.search(text):
            raise BundleError(f"{name}: unsupported import or export: {other.group()}")
        text = _LAZY_IMPORT.sub(lambda found: f'import("./{found[1]}{BUNDLE_SUFFIX}")', text)
        made = "await (async () =>" if _AWAITING_CONST.search(text) else "(() =>"
        parts.append(f"const {_name_variable(name)} = {made} {{\n{text}return {{ {', '.join(exported)} }};\n}})();\n")
    # The last module in order is the first one of the bundle; the bundle has the same exports.
    parts.append(f"export const {{ {', '.join(exported)} }} = {_name_variable(order[-1])};\n")
    return "\n".join([*outside, *parts])


def _name_variable(module: str) -> str:
    return f"${module.removesuffix('.js')}"
