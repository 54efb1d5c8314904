"""How large a drawing may be that is read within a second or two."""

from synthesis.model.statement import ABSURD
from synthesis.model.zones import MOST_VERTICES

MOST_ELEMENTS = 20_000
"""Elements of an SVG drawing, or entities of a DXF drawing, each as often as it is used."""

MOST_DEPTH = 32
"""Groups, uses or blocks within one another."""

MOST_PIECES = 100_000
"""Lines and curves in all of a drawing."""

MOST_POINTS = 100_000
"""Vertices of all polygons of a drawing."""

MOST_OUTLINES = 1_000
"""Closed outlines of a drawing."""

MOST_TOLD = 50
"""Elements that were left out, of which the answer speaks one by one."""

MOST_CORNERS = MOST_VERTICES
"""Vertices of a polygon: as many as a zone or an obstacle may have."""

FARTHEST = ABSURD
"""Greatest coordinate, as in statements."""

LONGEST_NAME = 100
"""Characters of a name, a layer or an id that are told."""

DEFAULT_TOLERANCE = 5e-4
"""Flattening tolerance as a share of the greater side of the box around all that is drawn: half a pixel of a screen."""

JOINED = 0.1
"""Ends are joined that lie within this share of the tolerance."""
