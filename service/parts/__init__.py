"""Mechanisms as parts for manufacture: plates, gears, pins, spacers and blocks, their files, and a zip of all.

Glossary:

region    an outline with its holes, made of straight lines and arcs, or of a smooth curve;
body      a prism (a region from one height to another), a body of revolution, one with cuts, a twisted prism, or a
          mesh;
part      a stack of bodies that moves with a link, or with a joint;
carrier   the body that parts move with: a link and a joint of it, or a body of a train;
assembly  all parts of a design at their places, in millimetres, the plane of the base's upper face at height 0;
collar    the largest diameter on a pin next to a plate: washers, spacers, rings, heads.

:mod:`service.parts.registry` is the entry point: from a design to a checked assembly, by the maker of its type.

* :mod:`service.parts.geometry.regions`, :mod:`service.parts.geometry.solids` and :mod:`service.parts.assembly.model`
  define a part, and :mod:`service.parts.assembly.sizes` defines the options of a request.
* Makers of linkages: :mod:`service.parts.linkage.maker` finds sizes and planes of a planar linkage, and
  :mod:`service.parts.linkage.builder` builds its assembly.
* Makers of mechanisms on shafts: :mod:`service.parts.cam`, :mod:`service.parts.indexing` and
  :mod:`service.parts.flywheel` build assemblies from plates that :mod:`service.parts.assembly.plate_stack` puts on pins
  and keyed shafts, in sizes that :mod:`service.parts.assembly.fit_sizes` finds. :mod:`service.parts.gears` builds gear
  trains.
* :mod:`service.parts.assembly.interference` detects interference.
* The writers (:mod:`service.parts.drawings`, :mod:`service.parts.assembly.bill_of_materials`,
  :mod:`service.parts.export`) know only the assembly. Only :mod:`service.parts.export.cad` needs the libraries of the
  extra ``cad``.
"""
