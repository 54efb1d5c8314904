"""Conversion of docstrings to Markdown: roles, double backticks and inline examples become code."""

from __future__ import annotations

import re

_ROLE = re.compile(r":(?:func|class|mod|meth|attr|data|exc|obj):`~?([^`]+)`")
_LITERAL = re.compile(r"``([^`]+)``")
_EXAMPLE = re.compile(r"(?:^|(?<=\n\n))>>> (?:.+\n?)+")


def as_markdown(docstring: str) -> str:
    """Convert a reStructuredText docstring to Markdown."""
    text = _LITERAL.sub(r"`\1`", _ROLE.sub(r"`\1`", docstring))
    return _EXAMPLE.sub(lambda example: f"```python\n{example[0].rstrip()}\n```\n", text)
