"""Random problems, from sound ones to absurd ones: the examples of a kind with a few things done to them.

A case is made by its kind and number alone, so that one that has found a defect can be made again.
"""

from __future__ import annotations

from typing import Any

Place = tuple[Any, Any]
"""A container and the key of one member."""
