"""The assembly as solids: STEP (AP242), STL, 3MF and glTF, by build123d on Open CASCADE, and lib3mf.

Only this module needs the extra ``cad``; :mod:`service.parts.export.cad_available` tests whether it is installed. STL
and 3MF share one triangulation, which Open CASCADE keeps with the solid. Arcs stay arcs, holes cylinders and curves
B-splines; the mesh formats approximate them by polygons within :data:`DEFLECTION`. A twisted prism is swept along its
axis with an auxiliary helix; bodies with cuts are cut by the kernel; a mesh remains triangles.
"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Sequence
from functools import cache, lru_cache
from itertools import pairwise
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from service.parts.assembly.model import Assembly, Frame, Part
from service.parts.geometry.cut_solids import ConeCut, Cut, CutBody
from service.parts.geometry.regions import Disc, Loop, Outline, Region, find_arc_middle, move_outline
from service.parts.geometry.solids import Body, Mesh, Prism, TaperedBody, TwistedPrism
from service.parts.geometry.splines import Curve

if TYPE_CHECKING:
    from build123d import Edge, Face, Location, Shape, Solid, Wire
    from lib3mf.Lib3MF import Wrapper
    from OCP.TopoDS import TopoDS_Edge

DEFLECTION, MAX_FACET_ANGLE = 0.02, 0.1
"""Maximum distance of a mesh from the part, millimetres, and angle between neighbouring facets, radians."""

CONE_EXTENSION = 0.05
"""Extension of a cone to an apex beyond the body that it is intersected with, as a share of its height."""

MERGE_DISTANCE = 1e-6
"""Distance within which corners of neighbouring faces are merged, millimetres."""

PERPENDICULAR_TOLERANCE = 1e-7
"""Cosine up to which two directions count as perpendicular."""

CREATION_TIME = "2000-01-01T00:00:00"
"""Fixed creation time in STEP files: a design has none, and files must be reproducible."""

AP242_NUMBER, SCHEMA_NAME = 5, b"AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }"
"""Number of the schema in the library, and its name in a file."""


def make_solid(part: Part) -> Solid:
    """Return a part at its place in the reference configuration, as one solid without seams between its bodies."""
    import build123d as b3d

    pieces = [_make_body(body) for body in part.bodies]
    whole = pieces[0].fuse(*pieces[1:]).clean() if len(pieces) > 1 else pieces[0]
    (made,) = whole.solids()
    made.label = part.name
    made.color = b3d.Color(*(int(part.colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5)))
    return made


@lru_cache(maxsize=1)
def make_solids(assembly: Assembly) -> tuple[Solid, ...]:
    """Return the solids of all parts; those of the last assembly are cached for its other files."""
    return tuple(make_solid(part) for part in assembly.parts)


def place_solids(assembly: Assembly, solids: Sequence[Solid], input_: float) -> list[Solid]:
    """Move the solids of all parts from the reference configuration to their places at an input."""
    import build123d as b3d

    state = assembly.motion.compute_state(np.array([input_]))
    moved = []
    for part, shape in zip(assembly.parts, solids, strict=True):
        at = assembly.motion.compute_placement(part.carrier, state)
        turn, shift = complex(at.turn[0]), complex(at.shift[0])
        place = b3d.Location((shift.real, shift.imag, 0.0), (0.0, 0.0, float(np.degrees(np.angle(turn)))))
        if at.frame is not None:
            place = _locate_frame(at.frame) * place
        moved.append(_move_solid(shape, place))
    return moved


def write_step(solids: Sequence[Solid], name: str) -> bytes:
    """Write solids as one STEP assembly with their names and colours."""
    import build123d as b3d
    from OCP.Interface import Interface_Static
    from OCP.STEPCAFControl import STEPCAFControl_Controller

    STEPCAFControl_Controller.Init_s()
    # The writer's controller must be initialized before this setting.
    Interface_Static.SetIVal_s("write.step.schema", AP242_NUMBER)
    whole = b3d.Compound(children=list(solids), label=name)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "assembly.step"
        b3d.export_step(whole, path, timestamp=CREATION_TIME)
        written = path.read_bytes()
    # build123d writes the header before it knows the schema.
    return re.sub(
        rb"FILE_SCHEMA\(\(.*?\)\);", b"FILE_SCHEMA(('" + SCHEMA_NAME + b"'));", written, count=1, flags=re.DOTALL
    )


class Surface(NamedTuple):
    """The triangles of a solid: corners, shape (n, 3), and their indices, shape (m, 3), facing outwards."""

    corners: NDArray[np.float64]
    triangles: NDArray[np.int64]


def triangulate(shape: Solid) -> Surface:
    """Return the closed surface of a solid; adjacent faces share their corners."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.TopAbs import TopAbs_Orientation
    from OCP.TopLoc import TopLoc_Location

    BRepMesh_IncrementalMesh(shape.wrapped, DEFLECTION, False, MAX_FACET_ANGLE, False)
    corners: list[tuple[float, float, float]] = []
    triangles: list[tuple[int, int, int]] = []
    for face in shape.faces():
        place = TopLoc_Location()
        facets = BRep_Tool.Triangulation_s(face.wrapped, place)
        if facets is None:  # a sliver thinner than the deflection
            continue
        to, before = place.Transformation(), len(corners) - 1
        for k in range(1, facets.NbNodes() + 1):
            node = facets.Node(k).Transformed(to)
            corners.append((node.X(), node.Y(), node.Z()))
        # Triangles of reversed faces are oriented inwards.
        turned = face.wrapped.Orientation() == TopAbs_Orientation.TopAbs_REVERSED
        for k in range(1, facets.NbTriangles() + 1):
            one, two, three = facets.Triangle(k).Get()
            triangles.append((before + one, before + three, before + two) if turned else
                             (before + one, before + two, before + three))  # fmt: skip
    return _merge_corners(np.array(corners), np.array(triangles))


def _merge_corners(corners: NDArray[np.float64], triangles: NDArray[np.int64]) -> Surface:
    """Merge coincident corners, and drop triangles that degenerate."""
    # Merging is transitive: corners connected by short distances become one.
    near = cKDTree(corners).query_pairs(MERGE_DISTANCE, output_type="ndarray")
    joined = coo_array((np.ones(len(near), bool), (near[:, 0], near[:, 1])), shape=(len(corners), len(corners)))
    _, labels = connected_components(joined, directed=False)
    _, first = np.unique(labels, return_index=True)
    numbered = labels[triangles]
    real = (numbered != np.roll(numbered, 1, axis=1)).all(axis=1)
    return Surface(corners[first], numbered[real])


def write_stl(mesh: Surface) -> bytes:
    """Write a surface as a binary STL file."""
    at = mesh.corners[mesh.triangles]
    normals = np.cross(at[:, 1] - at[:, 0], at[:, 2] - at[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    records = np.zeros(len(at), [("normal", "<f4", 3), ("at", "<f4", (3, 3)), ("spare", "<u2")])
    records["normal"], records["at"] = normals / np.where(lengths > 0.0, lengths, 1.0), at
    return b"binary STL, millimetres".ljust(80) + len(at).to_bytes(4, "little") + records.tobytes()


def write_3mf(mesh: Surface, name: str) -> bytes:
    """Write a surface as a 3MF file."""
    library, lib3mf = _load_lib3mf()
    model = library.CreateModel()
    model.SetUnit(lib3mf.ModelUnit.MilliMeter)
    made = model.AddMeshObject()
    made.SetName(name)
    made.SetPartNumber(name)
    made.SetType(lib3mf.ObjectType.Model)
    places = np.ascontiguousarray(mesh.corners, np.float32)
    numbers = np.ascontiguousarray(mesh.triangles, np.uint32)
    made.SetGeometry(
        (lib3mf.Position * len(places)).from_buffer(places), (lib3mf.Triangle * len(numbers)).from_buffer(numbers)
    )
    model.AddBuildItem(made, library.GetIdentityTransform())
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "part.3mf"
        model.QueryWriter("3mf").WriteToFile(str(path))
        return path.read_bytes()


@cache
def _load_lib3mf() -> tuple[Wrapper, ModuleType]:
    """Load the library once; return it and its names."""
    from lib3mf import Lib3MF

    return Lib3MF.Wrapper(str(Path(Lib3MF.__file__).with_name("lib3mf"))), Lib3MF


def write_glb(solids: Sequence[Solid], name: str) -> bytes:
    """Write solids as one binary glTF file: metres, with y upwards along the shafts."""
    import build123d as b3d

    whole = b3d.Compound(children=list(solids), label=name)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "assembly.glb"
        b3d.export_gltf(whole, path, binary=True, linear_deflection=DEFLECTION, angular_deflection=MAX_FACET_ANGLE)
        return path.read_bytes()


def lay_flat(shape: Solid, part: Part) -> Solid:
    """Return the solid of a part in printing position: along x, on the plate, its lowest face down."""
    import build123d as b3d

    back = float(np.degrees(np.angle(part.along.conjugate())))
    turned = _move_solid(shape, b3d.Location((0.0, 0.0, 0.0), (0.0, 0.0, back)))
    low = turned.bounding_box().min
    return _move_solid(turned, b3d.Location((-low.X, -low.Y, -low.Z)))


def _move_solid(shape: Solid, place: Location) -> Solid:
    """Return a solid in another place with the same faces; build123d's own move would copy it with its whole tree."""
    import build123d as b3d

    moved = b3d.Solid(shape.wrapped.Moved(place.wrapped))
    moved.label, moved.color = shape.label, shape.color
    return moved


def _locate_frame(frame: Frame) -> Location:
    """Return the location of a frame at the first input."""
    import build123d as b3d

    origin, axes = frame.origin.reshape(-1, 3)[0], frame.axes.reshape(-1, 3, 3)[0]
    return b3d.Location(b3d.Plane(tuple(origin), x_dir=tuple(axes[:, 0]), z_dir=tuple(axes[:, 2])))


def _make_body(body: Body) -> Shape:
    """Return a body at its height."""
    import build123d as b3d

    if isinstance(body, Prism):
        return b3d.extrude(_make_face(body.region), amount=body.high - body.low, dir=(0, 0, 1)).moved(
            _shift_up(body.low)
        )
    if isinstance(body, TaperedBody):
        return _make_tapered(body)
    if isinstance(body, CutBody):
        return _make_cut_body(body)
    if isinstance(body, TwistedPrism):
        along = (0.0, 0.0, body.high - body.low)
        middle = (body.centre.real, body.centre.imag, 0.0)
        outer = _make_wire(body.section.outer)
        swept = b3d.Solid.extrude_linear_with_rotation(outer, middle, along, float(np.degrees(body.twist)))
        for hole in body.section.holes:
            swept = swept.cut(b3d.extrude(_make_face(Region(hole)), amount=along[2], dir=(0, 0, 1)))
        return swept.moved(_shift_up(body.low))
    return _build_mesh_solid(body)


def _make_tapered(body: TaperedBody) -> Solid:
    """Make a tapered body, such as a bevel gear.

    The faces of one pitch of the teeth are built and copied around the axis. Discs close the ends, and a tube closes
    the bore. The shell is sewn from these faces and simplified to as few faces as possible.
    """
    import build123d as b3d
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeSolid, BRepBuilderAPI_Sewing
    from OCP.BRepLib import BRepLib
    from OCP.TopoDS import TopoDS

    _, inner, *_, upper, _ = body.profile
    (bore,) = body.section.holes
    pitch = 360.0 / body.teeth
    sewing = BRepBuilderAPI_Sewing(MERGE_DISTANCE)
    faces = _make_pitch_faces(body)
    for k in range(body.teeth):
        turn = b3d.Location((0.0, 0.0, 0.0), (0.0, 0.0, k * pitch))
        for face in faces:
            sewing.Add(face.wrapped.Moved(turn.wrapped))
    first = _find_pitch_start(body)
    for end in (inner, upper):
        plane = b3d.Plane((0.0, 0.0, end.imag))
        arcs = [
            b3d.Edge.make_circle(end.real, plane, first + k * pitch, first + (k + 1) * pitch) for k in range(body.teeth)
        ]
        sewing.Add(b3d.Face(b3d.Wire(arcs), [_make_wire(bore).moved(_shift_up(end.imag))]).wrapped)
    plug = b3d.extrude(_make_face(Region(bore)), amount=upper.imag - inner.imag, dir=(0, 0, 1)).moved(
        _shift_up(inner.imag)
    )
    for side in plug.faces().sort_by(b3d.Axis.Z)[1:-1]:
        sewing.Add(side.wrapped)
    sewing.Perform()
    closed = BRepBuilderAPI_MakeSolid(TopoDS.Shell(sewing.SewedShape())).Solid()
    BRepLib.OrientClosedSolid_s(closed)
    return b3d.Solid(closed).clean()


def _make_pitch_faces(body: TaperedBody) -> list[Face]:
    """Return the faces of one pitch of the teeth about the origin, without those of its ends.

    The pitch is a sector of the body of revolution, intersected with a sector of the cone to the apex.
    """
    import build123d as b3d

    outline = body.section.outer
    assert isinstance(outline, Loop)
    count = len(outline.corners) // body.teeth
    # From the start of the first pitch to that of the second, and to the axis.
    corners = (*outline.corners[: count + 1], 0j)
    sector = Loop(corners, (*outline.bulges[:count], 0.0, 0.0))
    # Extend slightly beyond both ends, so that no face of the cone coincides with one of the body's.
    beyond = CONE_EXTENSION * (body.high - body.low)
    wires = []
    for height in (body.low - beyond, body.high + beyond):
        wires.append(_make_wire(move_outline(sector, float(body.scale(np.array(height))))).moved(_shift_up(height)))
    half_section = b3d.Face(b3d.Wire.make_polygon([(z.real, 0.0, z.imag) for z in body.profile]))
    turned = b3d.Solid.revolve(half_section, 360.0 / body.teeth, b3d.Axis.Z)
    turned = turned.moved(b3d.Location((0.0, 0.0, 0.0), (0.0, 0.0, _find_pitch_start(body))))
    # Exactly one solid results; unpacking fails loudly otherwise.
    (whole,) = turned.intersect(b3d.Solid.make_loft(wires, ruled=True)).solids()
    ends = [np.exp(1j * (np.radians(_find_pitch_start(body)) + k * 2.0 * np.pi / body.teeth)) for k in (0, 1)]

    def cut(face: Face) -> bool:
        """Return whether it is normal to the axis, or lies in one of the two planes that bound the pitch."""
        if not face.is_planar:
            return False
        away = face.normal_at()
        level = complex(away.X, away.Y)
        return abs(level) < PERPENDICULAR_TOLERANCE or (
            abs(away.Z) < PERPENDICULAR_TOLERANCE
            and any(abs((end.conjugate() * level).real) < PERPENDICULAR_TOLERANCE for end in ends)
        )

    return [face for face in whole.faces() if not cut(face)]


def _find_pitch_start(body: TaperedBody) -> float:
    """Return where the first pitch begins, degrees."""
    outline = body.section.outer
    assert isinstance(outline, Loop)
    return float(np.degrees(np.angle(outline.corners[0])))


def _make_cut_body(body: CutBody) -> Solid:
    """Revolve the half section, and subtract all tools of the cuts at once."""
    import build123d as b3d

    upright = b3d.Location(b3d.Plane((0.0, 0.0, 0.0), x_dir=(1.0, 0.0, 0.0), z_dir=(0.0, -1.0, 0.0)))
    whole = b3d.Solid.revolve(_make_face(Region(body.profile)).moved(upright), 360.0, b3d.Axis.Z)
    (made,) = whole.cut(*(_make_tool(cut, body.far) for cut in body.cuts)).solids()
    return made


def _make_tool(cut: Cut, far: float) -> Shape:
    """Return the solid that a cut removes, up to a distance from the origin."""
    import build123d as b3d

    across, _, along = (
        tuple(axis) for axis in (cut.axes if isinstance(cut, ConeCut) else cut.make_tool(far).axes).tolist()
    )
    plane = b3d.Plane((0.0, 0.0, 0.0), x_dir=across, z_dir=along)
    if isinstance(cut, ConeCut):
        return b3d.Solid.make_cone(0.0, far * float(np.tan(cut.angle)), far, plane)
    section = _make_face(Region(cut.make_tool(far).outline))
    return b3d.extrude(section, amount=far, dir=(0, 0, 1)).moved(b3d.Location(plane))


def _build_mesh_solid(body: Mesh) -> Solid:
    """Return the solid enclosed by the triangles of a mesh, with shared edges."""
    import build123d as b3d
    from OCP.BRep import BRep_Builder
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeVertex
    from OCP.gp import gp_Pnt
    from OCP.TopoDS import TopoDS_Shell, TopoDS_Solid, TopoDS_Wire

    builder = BRep_Builder()
    corners = [BRepBuilderAPI_MakeVertex(gp_Pnt(*place)).Vertex() for place in body.corners.tolist()]
    edges: dict[tuple[int, int], TopoDS_Edge] = {}
    shell, whole = TopoDS_Shell(), TopoDS_Solid()
    builder.MakeShell(shell)
    for three in body.triangles.tolist():
        wire = TopoDS_Wire()
        builder.MakeWire(wire)
        for one, other in pairwise((*three, three[0])):
            # Each edge is shared by two faces, in opposite directions.
            if (other, one) in edges:
                builder.Add(wire, edges[other, one].Reversed())
            else:
                edges[one, other] = BRepBuilderAPI_MakeEdge(corners[one], corners[other]).Edge()
                builder.Add(wire, edges[one, other])
        wire.Closed(True)
        builder.Add(shell, BRepBuilderAPI_MakeFace(wire, True).Face())
    shell.Closed(True)
    builder.MakeSolid(whole)
    builder.Add(whole, shell)
    return b3d.Solid(whole)


def _shift_up(height: float) -> Location:
    import build123d as b3d

    return b3d.Location((0.0, 0.0, height))


def _make_face(region: Region) -> Face:
    import build123d as b3d

    return b3d.Face(_make_wire(region.outer), [_make_wire(hole) for hole in region.holes])


def _make_wire(outline: Outline) -> Wire:
    import build123d as b3d

    if isinstance(outline, Disc):
        centre = b3d.Plane((outline.centre.real, outline.centre.imag, 0.0))
        return b3d.Wire([b3d.Edge.make_circle(outline.radius, centre)])
    if isinstance(outline, Curve):
        return b3d.Wire([_make_spline(outline)])
    edges = []
    for start, end, bulge in outline.iterate_edges():
        a, b = (start.real, start.imag), (end.real, end.imag)
        if bulge == 0.0:
            edges.append(b3d.Edge.make_line(a, b))
        else:
            half = find_arc_middle(start, end, bulge)
            edges.append(b3d.Edge.make_three_point_arc(a, (half.real, half.imag), b))
    return b3d.Wire(edges)


def _make_spline(outline: Curve) -> Edge:
    """Return a smooth outline as its B-spline."""
    import build123d as b3d

    clamped = outline.b_spline
    return b3d.Edge.make_bspline(map(tuple, clamped.c.tolist()), clamped.t.tolist(), 3)
