"""A planar linkage as parts that can be made: plates, pins, spacers and blocks, their files, and a zip of them all.

Glossary:

region    an outline with its holes, made of straight lines and arcs;
prism     a region from one height to another;
part      a stack of prisms that moves with a link, or with a joint;
assembly  all parts of a design at their places, in millimetres, the plane of the base's upper face at height 0;
collar    the widest that stands on a pin beside a plate: washers, spacers, rings, heads.

:mod:`shapes` and :mod:`model` say what a part is, :mod:`sizes` how thick and wide, :mod:`building` makes the assembly
of a mechanism whose planes are known, :mod:`overlaps` sees whether two parts want one place, and :mod:`made` is the
door: from a design to an assembly that has been checked. The writers (:mod:`dxf`, :mod:`sheet`, :mod:`bom`,
:mod:`cad`) know the assembly alone; only :mod:`cad` needs the libraries of the extra ``cad``.
"""
