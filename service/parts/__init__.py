"""Mechanisms as parts for manufacture: plates, gears, pins, spacers and blocks, their files, and a zip of all.

Glossary:

region    an outline with its holes, made of straight lines and arcs, or of a smooth curve;
body      a prism (a region from one height to another), a body of revolution, one with cuts, a twisted prism, or a
          mesh;
part      a stack of bodies that moves with a link, or with a joint;
carrier   the body that parts move with: a link and a joint of it, or a body of a train;
assembly  all parts of a design at their places, in millimetres, the plane of the base's upper face at height 0;
collar    the largest diameter on a pin next to a plate: washers, spacers, rings, heads.

:mod:`shapes`, :mod:`bodies` and :mod:`model` define a part, :mod:`sizes` the options of a request. :mod:`made` is the
entry point: from a design to a checked assembly. It knows the makers: :mod:`linkages` finds sizes and planes of a
planar linkage, and :mod:`building` builds its assembly; :mod:`cams`, :mod:`barrel`, :mod:`geneva`, :mod:`spherical` and
:mod:`ratchets` build those of drives on shafts, from plates that :mod:`stack` puts on pins and keyed shafts, in sizes
that :mod:`fitting` finds. :mod:`overlaps` detects interference. The writers (:mod:`dxf`, :mod:`sheet`, :mod:`bom`,
:mod:`cad`) know only the assembly; only :mod:`cad` needs the libraries of the extra ``cad``.
"""
