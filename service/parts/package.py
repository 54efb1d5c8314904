"""All files of an assembly in one zip.

================  =======================================================  =========================
file              content                                                  process
================  =======================================================  =========================
README.txt        list of contents and assembly instructions               all
bom.csv           items to make and to buy                                 all
assembly.svg      the planes as an exploded side view, to scale;           all
                  views from above and from the front for crossing shafts
isometric.svg     a picture, assembled and exploded;                       all
                  from two sides for crossing shafts
dxf/NAME.dxf      outlines of plates and blocks, with their holes          all
assembly.step     all parts at their places, with names and colours        all, if CAD is installed
step/NAME.step    each item that is not bought                             mill
stl/, 3mf/        each item, in printing position                          print
================  =======================================================  =========================
"""

from __future__ import annotations

import io
import zipfile

from service.parts import cad
from service.parts.bom import bill, millimetres
from service.parts.crossed_sheet import crossed_sheet
from service.parts.dxf import cutting
from service.parts.extra import installed
from service.parts.isometric import isometric_sheet
from service.parts.items import Item, items
from service.parts.model import FLAT, Assembly
from service.parts.painted import painted_sheet
from service.parts.sheet import assembly_sheet
from service.parts.sizes import PartFile, Process
from service.parts.viewed import files_of

MADE_AT = (2000, 1, 1, 0, 0, 0)
"""Fixed creation time in the zip, so that it depends on the design alone."""


def package(assembly: Assembly, process: Process, title: str, at: float) -> bytes:
    """Write the zip of an assembly's parts.

    Parameters
    ----------
    assembly : Assembly
    process : {"print", "laser", "mill"}
        Process of the parts.
    title : str
        Title without characters that XML forbids.
    at : float
        Input shown in the picture, radians or millimetres along the slide.
    """
    listed = items(assembly)
    files: dict[str, bytes] = {
        "bom.csv": bill(listed).encode(),
        "assembly.svg": (assembly_sheet if assembly.parallel else crossed_sheet)(assembly, listed, title).encode(),
    }
    files["isometric.svg"] = (isometric_sheet if assembly.parallel else painted_sheet)(assembly, title, at).encode()
    for item in listed:
        if "dxf" in files_of(item.part):
            files[f"dxf/{item.name}.dxf"] = part_file(item, "dxf", title)
    if installed():
        files |= _solids(assembly, listed, process)
    # The README lists all files and comes first in the zip.
    files = {"README.txt": _read_me(assembly, listed, process, title, files).encode()} | files
    return zipped(files)


def part_file(item: Item, form: PartFile, title: str) -> bytes:
    """Write a file of one item: its cutting outline, or its solid in printing position; only ``dxf`` works without the
    extra.
    """
    if form == "dxf":
        return cutting(item.part, f"{title}: {item.name}").encode()
    lying = cad.lying(cad.solid(item.part), item.part)
    if form == "step":
        return cad.step([lying], item.name)
    mesh = cad.surface(lying)
    return cad.stl(mesh) if form == "stl" else cad.three_mf(mesh, item.name)


def zipped(files: dict[str, bytes]) -> bytes:
    """Pack files by name into a zip."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name, MADE_AT), content, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def _solids(assembly: Assembly, listed: list[Item], process: Process) -> dict[str, bytes]:
    made = cad.solids_of(assembly)
    solids = {part.name: shape for part, shape in zip(assembly.parts, made, strict=True)}
    files = {"assembly.step": cad.step(cad.placed(assembly, made, assembly.motion.reference), "assembly")}
    lying = {item.name: cad.lying(solids[item.part.name], item.part) for item in listed}
    if process == "mill":
        files |= {
            f"step/{item.name}.step": cad.step([lying[item.name]], item.name)
            for item in listed
            # Pins are cut from standard bars, so they need a file.
            if not item.part.standard or item.part.sort == "pin"
        }
    if process == "print":
        meshes = {name: cad.surface(shape) for name, shape in lying.items()}
        files |= {f"stl/{name}.stl": cad.stl(mesh) for name, mesh in meshes.items()}
        files |= {f"3mf/{name}.3mf": cad.three_mf(mesh, name) for name, mesh in meshes.items()}
    return files


_HOLDING: dict[Process, str] = {
    "print": "Insert each pin from below, with its head on the base's side, and press or glue its cap on above.",
    "laser": "Each pin is held by retaining rings in the grooves at both ends.",
    "mill": "Each pin is held by retaining rings in the grooves at both ends.",
}


def _read_me(assembly: Assembly, listed: list[Item], process: Process, title: str, files: dict[str, bytes]) -> str:
    plates = {part.planes[0]: [] for part in assembly.parts if part.sort in FLAT}  # type: dict[int, list[str]]
    for part in assembly.parts:
        if part.sort in FLAT:
            plates[part.planes[0]].append(part.name)
    lines = [
        title,
        "",
        f"{len(assembly.parts)} parts, {len(listed)} different items (bom.csv); all lengths in millimetres.",
        *_order(assembly, plates),
        _HOLDING[process],
        *assembly.notes,
        "",
        "Files:",
        *(f"  {name}" for name in sorted(files)),
    ]
    if "assembly.step" not in files:
        lines += ["", "Solids are not included: the service runs without its extra `cad`."]
    return "\n".join(lines) + "\n"


def _order(assembly: Assembly, plates: dict[int, list[str]]) -> list[str]:
    """Return the assembly instructions."""
    if not assembly.parallel:
        told = [f"  {', '.join(names)}" for _, names in sorted(plates.items())]
        return ["Assemble each shaft, then set the shafts into the base:", *told,
                "Spacers fill the gaps on the shafts; assembly.svg shows their positions."]  # fmt: skip
    return [
        f"Assemble from below{_thickness(assembly)}:",
        *(f"  {assembly.plane_name(plane)}: {', '.join(names)}" for plane, names in sorted(plates.items())),
        "Washers and spacers fill the gaps between the planes; assembly.svg shows their positions.",
    ]


def _thickness(assembly: Assembly) -> str:
    """Return the common thickness of all plates as words, if they have one."""
    found = {millimetres(part.bodies[0].high - part.bodies[0].low) for part in assembly.parts if part.sort in FLAT}
    return f", a plate of {found.pop()} mm in each plane" if len(found) == 1 else ""
