"""How large a file may be that is read within a second or two, beside the limits of drawings."""

MOST_CURVES = 1_000
"""Curves of an answer."""

MOST_POINTS = 100_000
"""Points of a file before they are thinned, and of all curves of an answer."""

PNG = b"\x89PNG\r\n\x1a\n"
"""What a PNG file begins with."""

MOST_LOOKED = 300_000
"""Points of all curves of a file together, before they are thinned."""

MOST_PIXELS = 1 << 24
"""Of a picture: 4096 by 4096."""

MOST_CROSSINGS = 400_000
"""Points of all contours of a picture, before they are thinned."""

MOST_COLUMNS = 100
"""Of a table, of which two are read."""

FEWEST, DEFAULT_POINTS, MOST_ASKED = 3, 1_000, 10_000
"""Points of a curve, by `max_points`; a path or an outline takes 1000."""

READ_S = 10.0
"""How long a file is read before it is given up."""

MEMORY_MB = 512
"""What a process may take for a file, beside what its libraries take."""
