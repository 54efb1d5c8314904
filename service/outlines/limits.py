"""Limits on the size of a drawing, so that it is read within about two seconds."""

from synthesis.model.statement import ABSURD
from synthesis.model.zones import MOST_VERTICES

MOST_ELEMENTS = 20_000
"""Maximum number of elements (SVG) or entities (DXF), counting every use."""

MOST_DEPTH = 32
"""Maximum nesting depth of groups, uses or blocks."""

MOST_PIECES = 100_000
"""Maximum number of lines and curves in a drawing."""

MOST_POINTS = 100_000
"""Maximum number of vertices of all polygons of a drawing."""

MOST_OUTLINES = 1_000
"""Maximum number of closed outlines of a drawing."""

MOST_TOLD = 50
"""Maximum number of left-out elements that the answer lists."""

MOST_CORNERS = MOST_VERTICES
"""Maximum number of vertices of a polygon, the limit for zones and obstacles."""

FARTHEST = ABSURD
"""Largest absolute coordinate, as in problem statements."""

LONGEST_NAME = 100
"""Maximum number of characters of a reported name, layer or id."""

DEFAULT_TOLERANCE = 5e-4
"""Default flattening tolerance as a share of the larger side of the drawing's box: half a pixel of a screen."""

JOINED = 0.1
"""Largest gap between ends that are joined, as a share of the flattening tolerance."""
