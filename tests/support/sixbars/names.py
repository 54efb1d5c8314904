"""Names that a sixbar of Watt's or Stephenson's chain does not have in any text."""

import re

WRONG_NAME = re.compile(
    r"\b(Watt|Stephenson)('s)?\s+(dwell\s+)?sixbars?\b|\b(Watt|Stephenson)'s\s+(first|second|third)\b"
)
"""Each sixbar has one name, which says which inversion it is: Watt I sixbar."""
