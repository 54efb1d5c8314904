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

from service.parts.assembly.bill_of_materials import format_millimetres, write_bill
from service.parts.assembly.items import Item, list_items
from service.parts.assembly.model import SHEET_SORTS, Assembly
from service.parts.assembly.sizes import PartFile, Process
from service.parts.drawings.assembly_sheet import draw_assembly_sheet
from service.parts.drawings.assembly_sheet_crossed import draw_crossing_sheet
from service.parts.drawings.depth_buffer import draw_rendered_sheet
from service.parts.drawings.dxf import write_cutting_dxf
from service.parts.drawings.isometric import draw_isometric_sheet
from service.parts.export import cad
from service.parts.export.cad_available import is_installed
from service.parts.export.viewer_model import list_files

CREATION_TIME = (2000, 1, 1, 0, 0, 0)
"""Fixed creation time in the zip, so that it depends on the design alone."""


def write_package(assembly: Assembly, process: Process, title: str, at: float) -> bytes:
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
    listed = list_items(assembly)
    files: dict[str, bytes] = {
        "bom.csv": write_bill(listed).encode(),
        "assembly.svg": (draw_assembly_sheet if assembly.parallel else draw_crossing_sheet)(
            assembly, listed, title
        ).encode(),
    }
    files["isometric.svg"] = (draw_isometric_sheet if assembly.parallel else draw_rendered_sheet)(
        assembly, title, at
    ).encode()
    for item in listed:
        if "dxf" in list_files(item.part):
            files[f"dxf/{item.name}.dxf"] = write_item_file(item, "dxf", title)
    if is_installed():
        files |= _write_solids(assembly, listed, process)
    # The README lists all files and comes first in the zip.
    files = {"README.txt": _write_read_me(assembly, listed, process, title, files).encode()} | files
    return zip_files(files)


def write_item_file(item: Item, form: PartFile, title: str) -> bytes:
    """Write a file of one item: its cutting outline, or its solid in printing position.

    Only ``dxf`` is available without the extra ``cad``.
    """
    if form == "dxf":
        return write_cutting_dxf(item.part, f"{title}: {item.name}").encode()
    lying = cad.lay_flat(cad.make_solid(item.part), item.part)
    if form == "step":
        return cad.write_step([lying], item.name)
    mesh = cad.triangulate(lying)
    return cad.write_stl(mesh) if form == "stl" else cad.write_3mf(mesh, item.name)


def zip_files(files: dict[str, bytes]) -> bytes:
    """Pack files by name into a zip."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name, CREATION_TIME), content, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def _write_solids(assembly: Assembly, listed: list[Item], process: Process) -> dict[str, bytes]:
    made = cad.make_solids(assembly)
    solids = {part.name: shape for part, shape in zip(assembly.parts, made, strict=True)}
    files = {"assembly.step": cad.write_step(cad.place_solids(assembly, made, assembly.motion.reference), "assembly")}
    lying = {item.name: cad.lay_flat(solids[item.part.name], item.part) for item in listed}
    if process == "mill":
        files |= {
            f"step/{item.name}.step": cad.write_step([lying[item.name]], item.name)
            for item in listed
            # Pins are cut from standard bars, so they need a file.
            if not item.part.standard or item.part.sort == "pin"
        }
    if process == "print":
        meshes = {name: cad.triangulate(shape) for name, shape in lying.items()}
        files |= {f"stl/{name}.stl": cad.write_stl(mesh) for name, mesh in meshes.items()}
        files |= {f"3mf/{name}.3mf": cad.write_3mf(mesh, name) for name, mesh in meshes.items()}
    return files


_PIN_INSTRUCTIONS: dict[Process, str] = {
    "print": "Insert each pin from below, with its head on the base's side, and press or glue its cap on above.",
    "laser": "Each pin is held by retaining rings in the grooves at both ends.",
    "mill": "Each pin is held by retaining rings in the grooves at both ends.",
}


def _write_read_me(
    assembly: Assembly, listed: list[Item], process: Process, title: str, files: dict[str, bytes]
) -> str:
    plates = {part.planes[0]: [] for part in assembly.parts if part.sort in SHEET_SORTS}  # type: dict[int, list[str]]
    for part in assembly.parts:
        if part.sort in SHEET_SORTS:
            plates[part.planes[0]].append(part.name)
    lines = [
        title,
        "",
        f"{len(assembly.parts)} parts, {len(listed)} different items (bom.csv); all lengths in millimetres.",
        *_list_instructions(assembly, plates),
        _PIN_INSTRUCTIONS[process],
        *assembly.notes,
        "",
        "Files:",
        *(f"  {name}" for name in sorted(files)),
    ]
    if "assembly.step" not in files:
        lines += ["", "Solids are not included: the service runs without its extra `cad`."]
    return "\n".join(lines) + "\n"


def _list_instructions(assembly: Assembly, plates: dict[int, list[str]]) -> list[str]:
    """Return the assembly instructions."""
    if not assembly.parallel:
        plate_lines = [f"  {', '.join(names)}" for _, names in sorted(plates.items())]
        return ["Assemble each shaft, then set the shafts into the base:", *plate_lines,
                "Spacers fill the gaps on the shafts; assembly.svg shows their positions."]  # fmt: skip
    return [
        f"Assemble from below{_describe_thickness(assembly)}:",
        *(f"  {assembly.name_plane(plane)}: {', '.join(names)}" for plane, names in sorted(plates.items())),
        "Washers and spacers fill the gaps between the planes; assembly.svg shows their positions.",
    ]


def _describe_thickness(assembly: Assembly) -> str:
    """Return the common thickness of all plates as words, if they have one."""
    found = {
        format_millimetres(part.bodies[0].high - part.bodies[0].low)
        for part in assembly.parts
        if part.sort in SHEET_SORTS
    }
    return f", a plate of {found.pop()} mm in each plane" if len(found) == 1 else ""
