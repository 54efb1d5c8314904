"""Several modules of the page as one, so that a browser asks once and not once for each.

A module becomes a function that is called at once and returns what the module exports; what it imports is taken from
what the modules before it have returned::

    import { el } from "./dom.js";                    const $grid = (() => {
    export function grid(view) { ... }       becomes  const { el } = $dom;
                                                      function grid(view) { ... }
                                                      return { grid };
                                                      })();

This is right for modules as the page has them, and anything else is refused: imports and exports stand at the beginning
of a line and name what they take and give, what is exported is never assigned anew, and no two modules import each
other. A module that waits for something before it has what it exports becomes a function that is waited for.
Nothing is made shorter: what a browser says of the bundle can be found in the sources.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from graphlib import CycleError, TopologicalSorter

SUFFIX = ".bundle.js"
"""Of the name of a bundle, in place of ``.js`` of its first module."""

_IMPORT = re.compile(
    r'^import (?:\{ (?P<names>[^}]+) \}|\* as (?P<all>\w+)) from "\./(?P<module>[\w./]+)";$', re.MULTILINE
)
_EXPORT = re.compile(r"^export (?=(?:async )?(?:function|class|const) (\w+))", re.MULTILINE)
_OTHER = re.compile(r"^(?:import|export)\b.*$", re.MULTILINE)
_WAITS = re.compile(r"^(?:export )?const \w+ = (?:.* )?await ", re.MULTILINE)
"""A module that waits at its outermost level."""
_LATER = re.compile(r'import\("\./(\w+)\.js"\)(?=[,;)\]])')
"""A module that is asked for when it is needed; it begins a bundle of its own. Types in comments look otherwise."""


class BundleError(Exception):
    """Modules cannot be put together; the message says why."""


def bundles(modules: Mapping[str, str], first: str) -> dict[str, str]:
    """The bundle that begins with the module ``first``, and those that it and they ask for later, by their names.

    Parameters
    ----------
    modules
        The text of each module by its name, as ``dom.js``. Whatever else is imported is left where it is.

    Raises
    ------
    BundleError
        Where a module imports or exports in a way that this does not know, or modules import each other.
    """
    made: dict[str, str] = {}
    wanted = [first]
    while wanted:
        begins = wanted.pop()
        if name_of(begins) in made:
            continue
        order = _order(modules, begins)
        wanted += [f"{later}.js" for name in order for later in _LATER.findall(modules[name])]
        made[name_of(begins)] = _joined(modules, order)
    return made


def name_of(module: str) -> str:
    """The name of the bundle that begins with a module.

    >>> name_of("studio.js")
    'studio.bundle.js'
    """
    return module.removesuffix(".js") + SUFFIX


def _order(modules: Mapping[str, str], first: str) -> list[str]:
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


def _joined(modules: Mapping[str, str], order: list[str]) -> str:
    outside: dict[str, None] = {}

    def taken(found: re.Match[str]) -> str:
        if found["module"] not in modules:
            outside[found.group()] = None
            return ""
        what = found["all"] or f"{{ {found['names'].replace(' as ', ': ')} }}"
        return f"const {what} = {_variable(found['module'])};"

    parts: list[str] = []
    exported: list[str] = []
    for name in order:
        exported = _EXPORT.findall(modules[name])
        text = _EXPORT.sub("", _IMPORT.sub(taken, modules[name]))
        if other := _OTHER.search(text):
            raise BundleError(f"{name}: bundles know no such line: {other.group()}")
        text = _LATER.sub(lambda found: f'import("./{found[1]}{SUFFIX}")', text)
        made = "await (async () =>" if _WAITS.search(text) else "(() =>"
        parts.append(f"const {_variable(name)} = {made} {{\n{text}return {{ {', '.join(exported)} }};\n}})();\n")
    # The last one is what the bundle begins with, and the bundle exports what that does.
    parts.append(f"export const {{ {', '.join(exported)} }} = {_variable(order[-1])};\n")
    return "\n".join([*outside, *parts])


def _variable(module: str) -> str:
    return f"${module.removesuffix('.js')}"
