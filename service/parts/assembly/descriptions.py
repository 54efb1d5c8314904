"""Parts in words: descriptions by the names of links, gears and pins, and the names of materials."""

from __future__ import annotations

import re

from kinematics.message import compose

MATERIAL_MESSAGES = {
    "sheet": "parts-sheet",
    "steel": "parts-steel",
    "aluminium": "parts-aluminium",
    "bronze": "parts-bronze",
}
"""Messages of materials; the names of all others are the same in every language."""

WORD_MESSAGES = {
    "arm": "parts-arm",
    "base": "parts-base",
    "second base": "parts-second-base",
    "cam": "parts-cam",
    "carrier": "parts-carrier",
    "coupler": "parts-coupler",
    "crank": "parts-crank",
    "driven crank": "parts-driven-crank",
    "follower": "parts-follower",
    "idler": "parts-idler",
    "input": "parts-input-link",
    "link": "parts-link",
    "output": "parts-output-link",
    "pawl": "parts-pawl",
    "pin pawl": "parts-pawl-pin",
    "pin roller": "parts-roller-pin",
    "planet": "parts-planet",
    "planet long": "parts-long-planet",
    "planet short": "parts-short-planet",
    "post": "parts-post",
    "ring": "parts-ring",
    "rocker": "parts-rocker",
    "roller": "parts-roller",
    "sun": "parts-sun",
    "sun large": "parts-large-sun",
    "sun small": "parts-small-sun",
    "upright": "parts-upright",
    "wheel": "parts-wheel",
}
"""Messages of the names that links, gears and parts have by default."""

PREFIX_MESSAGES = {
    "gear of ": "parts-gear-of-link",
    "lower ": "parts-lower-plate-of-link",
    "pin ": "parts-pin",
    "upper ": "parts-upper-plate-of-link",
}
"""Messages of names that begin with these words and continue with another name."""

_NUMBERED_PATTERN = re.compile(r"(.+) (\d+)")


def describe_name(name: str) -> str:
    """Return a name, in which spaces separate words, as a message; a name given by the client stays as it is.

    >>> describe_name("gear of coupler 2"), describe_name("jib")
    ('gear of coupler 2', 'jib')
    """
    if name in WORD_MESSAGES:
        return compose(WORD_MESSAGES[name])
    numbered = _NUMBERED_PATTERN.fullmatch(name)
    if numbered:
        return compose("parts-numbered", name=describe_name(numbered[1]), number=numbered[2])
    for prefix, message_id in PREFIX_MESSAGES.items():
        if name.startswith(prefix):
            return compose(message_id, name=describe_name(name.removeprefix(prefix)))
    return name


def describe_identifier(name: str) -> str:
    """Return a name, in which underscores separate words, as a message."""
    return describe_name(name.replace("_", " "))


def name_part(part: str) -> str:
    """Return the name of a part in the bill of materials for use in a sentence."""
    return compose("parts-part-in-sentence", name=part.replace("_", " "))


def name_material(material: str) -> str:
    """Return the name of a material as a message."""
    return compose(MATERIAL_MESSAGES[material]) if material in MATERIAL_MESSAGES else material
