"""Limits on the size of a drawing, so that it is read within about two seconds."""

from synthesis.model.linkage.zones import MAX_VERTICES
from synthesis.model.problem import MAX_MAGNITUDE

MAX_ELEMENTS = 20_000
"""Maximum number of elements (SVG) or entities (DXF), counting every use."""

MAX_DEPTH = 32
"""Maximum nesting depth of groups, uses or blocks."""

MAX_PIECES = 100_000
"""Maximum number of lines and curves in a drawing."""

MAX_POINTS = 100_000
"""Maximum number of vertices of all polygons of a drawing."""

MAX_OUTLINES = 1_000
"""Maximum number of closed outlines of a drawing."""

MAX_LISTED = 50
"""Maximum number of left-out elements that the answer lists."""

MAX_CORNERS = MAX_VERTICES
"""Maximum number of vertices of a polygon, the limit for zones and obstacles."""

MAX_COORDINATE = MAX_MAGNITUDE
"""Largest absolute coordinate, as in problem statements."""

MAX_NAME_LENGTH = 100
"""Maximum number of characters of a reported name, layer or id."""

DEFAULT_TOLERANCE = 5e-4
"""Default flattening tolerance as a share of the larger side of the drawing's box: half a pixel of a screen."""

JOIN_GAP_SHARE = 0.1
"""Largest gap between ends that are joined, as a share of the flattening tolerance."""
