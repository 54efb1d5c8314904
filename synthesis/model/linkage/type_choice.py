"""Field ``mechanisms`` of kinds that support sixbars: ``auto``, or a list of the types to search.

A kind defines its types by a literal, and lists the fields that its sixbars do not support. Without the field
``mechanisms`` no sixbars are searched. ``auto`` accepts every statement and searches sixbars only if they support it. A
list of types is refused if its sixbars do not support the statement, with a message at each field concerned.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Literal, TypeVar

from kinematics.message import compose
from synthesis.model.linkage.problem import Constraints, LinkageProblem
from synthesis.model.problem import Contradiction

Name = TypeVar("Name", bound=str)

Auto = Literal["auto"]
"""Choice of the simplest type that satisfies the constraints, and of other types if they are clearly better."""


UNCLASSED_SIXBAR: Literal["stephenson_2"] = "stephenson_2"
"""The sixbar without a fourbar O2 A B O4, so that it has no Grashof class; its input drives a triad."""


def select_requested_types(requested: Auto | Sequence[str] | None, every: Sequence[Name]) -> tuple[Name, ...]:
    """Return the requested types among ``every``: all of them for ``auto``, none if the field is left out."""
    if requested is None:
        return ()
    return tuple(name for name in every if requested == "auto" or name in requested)


def select_searched_types(
    requested: Auto | Sequence[str] | None, every: Sequence[Name], unsupported: Iterable[Contradiction]
) -> tuple[Name, ...]:
    """Return the sixbars to search: the requested ones; for ``auto`` all of them, or none if a field is unsupported."""
    return () if requested == "auto" and any(True for _ in unsupported) else select_requested_types(requested, every)


def find_type_contradictions(
    requested: Auto | Sequence[str] | None, every: Sequence[str], unsupported: Iterable[Contradiction]
) -> list[Contradiction]:
    """Return the contradictions of fields that the sixbars of an explicit list do not support."""
    return list(unsupported) if isinstance(requested, list) and select_requested_types(requested, every) else []


def describe_skipped_sixbars(unsupported: Iterable[Contradiction]) -> str:
    """Describe why ``auto`` searched no sixbars: name the fields that they do not support."""
    return compose("model-sixbars-skipped", fields=_list_fields(unsupported))


def remove_unclassed(named: Sequence[Name], beyond: Iterable[Contradiction]) -> tuple[Name, ...]:
    """Return the sixbars to search, without :data:`UNCLASSED_SIXBAR` if there are fields that it does not support."""
    left_out = any(True for _ in beyond)
    return tuple(name for name in named if not (left_out and name == UNCLASSED_SIXBAR))


def describe_unclassed(named: Sequence[Name], beyond: Iterable[Contradiction]) -> str:
    """Describe why :data:`UNCLASSED_SIXBAR` was requested but not searched; empty if it was searched."""
    fields = _list_fields(beyond) if UNCLASSED_SIXBAR in named else ""
    return compose("model-stephenson-2-skipped", fields=fields) if fields else ""


def refuse_class(limits: Constraints) -> list[Contradiction]:
    """Return a contradiction if a Grashof class is required of :data:`UNCLASSED_SIXBAR`."""
    return limits.find_class_contradictions((), compose("model-stephenson-2-without-class"))


def _list_fields(faults: Iterable[Contradiction]) -> str:
    return ", ".join(dict.fromkeys(fault.path.strip("/").replace("/", ".") for fault in faults))


def find_unsupported_by_sixbars(problem: LinkageProblem) -> Iterator[Contradiction]:
    """Yield contradictions of the fields that no sixbar supports, for all kinds of problems."""
    if problem.manufacture is not None:
        yield Contradiction("/manufacture", compose("model-sixbars-without-manufacture"))
    for name in ("fixed_pivots", "moving_pivots"):
        if problem.space is not None and getattr(problem.space, name) is not None:
            kind = name.removesuffix("s")
            detail = compose("model-sixbars-without-zones", name=kind)
            yield Contradiction(f"/space/{name}", detail)
