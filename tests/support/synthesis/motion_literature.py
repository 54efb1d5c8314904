"""Code that several tests share: motion literature."""

from __future__ import annotations

import cmath
import math
from typing import Any


def vector(value: Any) -> complex:
    return cmath.rect(value["mag"], math.radians(value["ang"])) if isinstance(value, dict) else complex(*value)
