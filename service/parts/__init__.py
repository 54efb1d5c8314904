"""Mechanisms as parts that can be made: plates, gears, pins, spacers and blocks, their files, and a zip of them all.

Glossary:

region    an outline with its holes, made of straight lines and arcs, or of a smooth curve;
body      a prism (a region from one height to another), a body of revolution, one that is carved, a twisted prism, or
          a mesh;
part      a stack of bodies that moves with a link, or with a joint;
carrier   what parts move with: a link and a joint of it, or a body of a train;
assembly  all parts of a design at their places, in millimetres, the plane of the base's upper face at height 0;
collar    the widest that stands on a pin beside a plate: washers, spacers, rings, heads.

:mod:`shapes`, :mod:`bodies` and :mod:`model` say what a part is, :mod:`sizes` what a request states. :mod:`made` is the
door: from a design to an assembly that has been checked. It knows the makers: :mod:`linkages` finds sizes and planes of
a planar linkage, of which :mod:`building` makes the assembly; :mod:`cams`, :mod:`barrel`, :mod:`geneva`,
:mod:`spherical` and :mod:`ratchets` make those of drives on shafts, from plates that :mod:`stack` puts on pins and
keyed shafts, in sizes that :mod:`fitting` finds.
:mod:`overlaps` sees whether two parts want one place. The writers (:mod:`dxf`, :mod:`sheet`, :mod:`bom`, :mod:`cad`)
know the assembly alone; only :mod:`cad` needs the libraries of the extra ``cad``.
"""
