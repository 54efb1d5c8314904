"""Extension of griffe that converts docstrings to Markdown before mkdocstrings renders them."""

from __future__ import annotations

from typing import Any

import griffe

from tools.site.docstrings import as_markdown


class Roles(griffe.Extension):
    """Converts the docstring of each object when griffe loads the object."""

    def on_object(self, *, obj: griffe.Object, **_rest: Any) -> None:
        """Convert the docstring of an object to Markdown."""
        if obj.docstring is not None:
            obj.docstring.value = as_markdown(obj.docstring.value)
