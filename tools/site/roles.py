"""What mkdocstrings reads docstrings with: they are Markdown when it sees them."""

from __future__ import annotations

from typing import Any

import griffe

from tools.site.docstrings import as_markdown


class Roles(griffe.Extension):
    """Rewrites each docstring when its object is read."""

    def on_object(self, *, obj: griffe.Object, **_rest: Any) -> None:
        """Rewrite the docstring of an object."""
        if obj.docstring is not None:
            obj.docstring.value = as_markdown(obj.docstring.value)
