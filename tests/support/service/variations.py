"""Variations of a request body, each with one fault."""

import copy

STRANGE = ("odd", -7.5, {"odd": 1}, [[]], None)
FEW = 2
"""Of a long list the first members stand for all."""


def places(value, path=()):
    """Every place of a body, but of a long list the first few."""
    if path:
        yield path
    if isinstance(value, dict):
        for key, member in value.items():
            yield from places(member, (*path, key))
    elif isinstance(value, list):
        for n, member in enumerate(value[:FEW]):
            yield from places(member, (*path, n))


def at(body, path):
    for step in path:
        body = body[step]
    return body


def variations(body):
    """The body with one place removed, or made something strange, or given a field too many."""
    for path in places(body):
        for strange in STRANGE:
            varied = copy.deepcopy(body)
            at(varied, path[:-1])[path[-1]] = strange
            yield varied
        varied = copy.deepcopy(body)
        del at(varied, path[:-1])[path[-1]]
        yield varied
        if isinstance(at(body, path), dict):
            varied = copy.deepcopy(body)
            at(varied, path)["no_such_field"] = 1
            yield varied
