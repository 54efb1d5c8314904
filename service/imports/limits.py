"""Size limits of imported files, which allow reading within a second or two, in addition to those of drawings."""

MAX_CURVES = 1_000
"""Maximum number of curves in an answer."""

MAX_POINTS = 100_000
"""Maximum number of points of a file before thinning, and of all curves in an answer."""

PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"
"""First bytes of a PNG file."""

MAX_DENSE_POINTS = 300_000
"""Maximum total number of points of all curves of a file before thinning."""

MAX_PIXELS = 1 << 24
"""Maximum number of pixels of a picture: 4096 by 4096."""

MAX_CROSSINGS = 400_000
"""Maximum number of points of all contours of a picture before thinning."""

MAX_COLUMNS = 100
"""Maximum number of columns of a table, of which two are read."""

MIN_POINTS, DEFAULT_POINTS, MAX_REQUESTED_POINTS = 3, 1_000, 10_000
"""Bounds and default of `max_points`, points of a curve; a path or an outline accepts 1000."""

READ_TIMEOUT_S = 10.0
"""Time limit for reading a file, seconds."""

MEMORY_MB = 512
"""Memory limit for a file beyond that of the libraries, MiB."""
