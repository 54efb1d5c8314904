"""All files of an assembly in one zip.

================  =======================================================  =========================
file              what it is                                               for which process
================  =======================================================  =========================
README.txt        what is in it, and how it is put together                all
bom.csv           what is made and bought                                  all
assembly.svg      the planes as an exploded side view, to scale;           all
                  views from above and from the front where shafts cross
isometric.svg     a picture of it, as built and with its planes apart;     all
                  from two sides where shafts cross
dxf/NAME.dxf      outlines of plates and blocks, with their holes          all
assembly.step     all parts at their places, with names and colours        all, where CAD is installed
step/NAME.step    each item that is not bought                             mill
stl/, 3mf/        each item, lying as it is printed                        print
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
"""Stands in the zip as the time of its making: what is in it depends on the design alone."""


def package(assembly: Assembly, process: Process, title: str, at: float) -> bytes:
    """The zip of an assembly's parts.

    Parameters
    ----------
    assembly : Assembly
    process : {"print", "laser", "mill"}
        For which it was made.
    title : str
        Without characters that XML forbids.
    at : float
        Input at which its picture shows it, radians or millimetres along the slide.
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
    files = {"README.txt": _read_me(assembly, listed, process, title, files).encode()} | files
    return zipped(files)


def part_file(item: Item, form: PartFile, title: str) -> bytes:
    """A file of one item: the outline that is cut, or the solid as it is printed; all but ``dxf`` need the extra."""
    if form == "dxf":
        return cutting(item.part, f"{title}: {item.name}").encode()
    lying = cad.lying(cad.solid(item.part), item.part)
    if form == "step":
        return cad.step([lying], item.name)
    mesh = cad.surface(lying)
    return cad.stl(mesh) if form == "stl" else cad.three_mf(mesh, item.name)


def zipped(files: dict[str, bytes]) -> bytes:
    """Files by their names as a zip."""
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
            if not item.part.standard or item.part.sort == "pin"
        }
    if process == "print":
        meshes = {name: cad.surface(shape) for name, shape in lying.items()}
        files |= {f"stl/{name}.stl": cad.stl(mesh) for name, mesh in meshes.items()}
        files |= {f"3mf/{name}.3mf": cad.three_mf(mesh, name) for name, mesh in meshes.items()}
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
        *_order(assembly, plates),
        _HOLDING[process],
        *assembly.notes,
        "",
        "Files:",
        *(f"  {name}" for name in sorted(files)),
    ]
    if "assembly.step" not in files:
        lines += ["", "There are no solids: the service runs without its extra `cad`."]
    return "\n".join(lines) + "\n"


def _order(assembly: Assembly, plates: dict[int, list[str]]) -> list[str]:
    """How it is put together."""
    if not assembly.parallel:
        told = [f"  {', '.join(names)}" for _, names in sorted(plates.items())]
        return ["Put together shaft by shaft, then set into the base:", *told,
                "Spacers fill the gaps on the shafts; assembly.svg shows where they lie."]  # fmt: skip
    return [
        f"Put together from below{_thickness(assembly)}:",
        *(f"  {assembly.plane_name(plane)}: {', '.join(names)}" for plane, names in sorted(plates.items())),
        "Washers and spacers fill the gaps between the planes; assembly.svg shows where they lie.",
    ]


def _thickness(assembly: Assembly) -> str:
    """What plates have in common, where they do."""
    found = {millimetres(part.bodies[0].high - part.bodies[0].low) for part in assembly.parts if part.sort in FLAT}
    return f", a plate of {found.pop()} mm in each plane" if len(found) == 1 else ""
