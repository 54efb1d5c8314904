"""All files of an assembly in one zip.

================  =======================================================  =========================
file              what it is                                               for which process
================  =======================================================  =========================
README.txt        what is in it, and how it is put together                all
bom.csv           what is made and bought                                  all
assembly.svg      the planes as an exploded side view, to scale            all
dxf/NAME.dxf      outlines of plates and blocks, with their holes          all
assembly.step     all parts at their places, with names and colours        all, where CAD is installed
step/NAME.step    each item that is not bought                             mill
stl/, 3mf/        each item, lying as it is printed                        print
================  =======================================================  =========================
"""

from __future__ import annotations

import io
import zipfile
from typing import Any

from service.parts import cad
from service.parts.bom import bill, millimetres
from service.parts.dxf import cutting
from service.parts.extra import installed
from service.parts.items import Item, items
from service.parts.made import made
from service.parts.model import FLAT, Assembly
from service.parts.sheet import assembly_sheet
from service.parts.sizes import PartsQuery, Process

MADE_AT = (2000, 1, 1, 0, 0, 0)
"""Stands in the zip as the time of its making: what is in it depends on the design alone."""


def package(design: Any, problem: Any, query: PartsQuery, title: str) -> bytes:
    """The zip of a design's parts.

    Raises
    ------
    NotMade
        Where there are no such parts.
    """
    assembly = made(design, problem, query)
    listed = items(assembly)
    files: dict[str, bytes] = {
        "bom.csv": bill(listed).encode(),
        "assembly.svg": assembly_sheet(assembly, listed, title).encode(),
    }
    for item in listed:
        if item.part.sort in FLAT:
            files[f"dxf/{item.name}.dxf"] = cutting(item.part, f"{title}: {item.name}").encode()
    if installed():
        files |= _solids(assembly, listed, query.process)
    files = {"README.txt": _read_me(assembly, listed, query.process, title, files).encode()} | files
    return zipped(files)


def zipped(files: dict[str, bytes]) -> bytes:
    """Files by their names as a zip."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name, MADE_AT), content, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def _solids(assembly: Assembly, listed: list[Item], process: Process) -> dict[str, bytes]:
    solids = [cad.solid(part) for part in assembly.parts]
    files = {"assembly.step": cad.step(solids, "assembly")}
    if process == "mill":
        files |= {
            f"step/{item.name}.step": cad.step([cad.lying(item)], item.name)
            for item in listed
            if not item.part.standard or item.part.sort == "pin"
        }
    if process == "print":
        lying = {item.name: cad.lying(item) for item in listed}
        files |= {f"stl/{name}.stl": cad.stl(shape) for name, shape in lying.items()}
        files |= {f"3mf/{name}.3mf": cad.three_mf(shape, name) for name, shape in lying.items()}
    return files


_HOLDING: dict[Process, str] = {
    "print": "A pin is put in from below, head first on the base's side, and its cap is pressed or glued on above.",
    "laser": "A pin is held by a retaining ring in the groove at either end.",
    "mill": "A pin is held by a retaining ring in the groove at either end.",
}


def _read_me(assembly: Assembly, listed: list[Item], process: Process, title: str, files: dict[str, bytes]) -> str:
    plates = {part.planes[0]: [] for part in assembly.parts if part.sort in FLAT}  # type: dict[int, list[str]]
    for part in assembly.parts:
        if part.sort in FLAT:
            plates[part.planes[0]].append(part.name)
    lines = [
        title,
        "",
        f"{len(assembly.parts)} parts of {len(listed)} kinds (bom.csv), all lengths in millimetres.",
        f"Put together from below{_thickness(assembly)}:",
        *(f"  {_plane(plane, assembly)}: {', '.join(names)}" for plane, names in sorted(plates.items())),
        _HOLDING[process],
        "Washers and spacers fill the gaps between the planes; assembly.svg shows where they lie.",
        *assembly.notes,
        "",
        "Files:",
        *(f"  {name}" for name in sorted(files)),
    ]
    if "assembly.step" not in files:
        lines += ["", "There are no solids: the service runs without its extra `cad`."]
    return "\n".join(lines) + "\n"


def _plane(plane: int, assembly: Assembly) -> str:
    if plane == 0:
        return "base"
    return "second base" if plane > assembly.planes else f"plane {plane}"


def _thickness(assembly: Assembly) -> str:
    """What plates have in common, where they do."""
    found = {millimetres(part.bodies[0].high - part.bodies[0].low) for part in assembly.parts if part.sort in FLAT}
    return f", a plate of {found.pop()} mm in each plane" if len(found) == 1 else ""
