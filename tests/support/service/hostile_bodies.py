"""Code that several tests share: hostile bodies."""

import copy
import json

from tests.support.service.running import PROBLEM

MIB = 1 << 20


def raw(problem: str) -> bytes:
    return f'{{"problem": {problem}}}'.encode()


def changed(path, value):
    """The good body with one value put in."""
    body = {"problem": copy.deepcopy(PROBLEM)}
    *parents, last = path
    place = body
    for step in parents:
        place = place[step]
    place[last] = value
    return json.dumps(body).encode()


POSITION = '{"x": 0, "y": 0, "angle": 0}'


def with_x(number: str) -> bytes:
    return raw(f'{{"kind": "motion", "positions": [{{"x": {number}, "y": 0, "angle": 0}}, {POSITION}]}}')


MALFORMED = {
    "empty": b"",
    "spaces": b"   ",
    "truncated": b'{"problem": {"kind": "motion", "positions": [',
    "two values": b"{} {}",
    "not json": b"problem=motion",
    "single quotes": b"{'problem': 1}",
    "trailing comma": b'{"problem": {},}',
    "comment": b'{"problem": {} /* x */}',
    "lone surrogate": b'{"problem": {}, "label": "\\ud800"}',
    "lone low surrogate": b'{"problem": {}, "label": "\\udc00 x"}',
    "bad utf-8": b'{"problem": {}, "label": "\xff\xfe"}',
    "overlong utf-8": b'{"problem": {}, "label": "\xc0\xaf"}',
    "utf-16": '{"problem": {}}'.encode("utf-16"),
    "byte order mark": b'\xef\xbb\xbf{"problem": {}}',
    "nul byte": b'{"problem": {}}\x00',
    "control character in a string": b'{"problem": {}, "label": "a\x01"}',
    "deep lists": b"[" * 100_000,
    "deep objects": b'{"a":' * 100_000,
    "5000 digits": with_x("1" * 5000),
    "a million digits": with_x("1" * 1_000_000),
    "leading zero": with_x("01"),
    "hexadecimal": with_x("0x10"),
    "python's true": b'{"problem": True}',
}

INVALID = {
    "a list": (b"[]", ""),
    "a string": (b'"problem"', ""),
    "a number": (b"3", ""),
    "null": (b"null", ""),
    "no problem": (b"{}", "/problem"),
    "problem null": (raw("null"), "/problem"),
    "problem a list": (raw("[1]"), "/problem"),
    "problem a string": (raw('"motion"'), "/problem"),
    "no kind": (raw(f'{{"positions": [{POSITION}, {{"x": 1, "y": 0, "angle": 0}}]}}'), "/problem/kind"),
    "unknown kind": (changed(("problem", "kind"), "perpetuum_mobile"), "/problem/kind"),
    "kind a list": (changed(("problem", "kind"), ["motion"]), "/problem/kind"),
    "unknown field": (changed(("problem", "postions"), []), "/problem/postions"),
    "unknown field above": (json.dumps({"problem": PROBLEM, "priority": 1}).encode(), "/priority"),
    "field that needs escapes": (changed(("problem", "a/b~c"), 0), "/problem/a~1b~0c"),
    "nan": (with_x("NaN"), "/problem/positions/0/x"),
    "infinity": (with_x("Infinity"), "/problem/positions/0/x"),
    "minus infinity": (with_x("-Infinity"), "/problem/positions/0/x"),
    "1e999": (with_x("1e999"), "/problem/positions/0/x"),
    "absurdly large": (with_x("1e10"), "/problem/positions/0/x"),
    "an integer beyond doubles": (with_x("1" * 400), "/problem/positions/0/x"),
    "a number as a string": (with_x('"1"'), "/problem/positions/0/x"),
    "a number as a truth": (with_x("true"), "/problem/positions/0/x"),
    "a number as null": (with_x("null"), "/problem/positions/0/x"),
    "one position": (changed(("problem", "positions"), [PROBLEM["positions"][0]]), "/problem/positions"),
    "no positions": (changed(("problem", "positions"), []), "/problem/positions"),
    "positions an object": (changed(("problem", "positions"), {"0": 1}), "/problem/positions"),
    "equal positions": (changed(("problem", "positions"), [PROBLEM["positions"][0]] * 2), "/problem/positions/1"),
    "missing coordinate": (changed(("problem", "positions", 1), {"x": 1, "y": 1}), "/problem/positions/1/angle"),
    "too many choices": (
        changed(
            ("problem", "input_side"),
            {"fixed_pivot": [0, 0], "link_angle": 1.0, "coupler_vector": {"length": 1.0, "angle": 1.0}},
        ),
        "/problem/input_side",
    ),
    "pivot of three numbers": (changed(("problem", "input_side"), {"fixed_pivot": [0, 0, 0]}), None),
    "negative count": (changed(("problem", "max_designs"), -1), "/problem/max_designs"),
    "fractional count": (changed(("problem", "max_designs"), 1.5), "/problem/max_designs"),
    "huge seed": (changed(("problem", "seed"), 2**63), "/problem/seed"),
    "interval upside down": (
        changed(("problem", "constraints"), {"fixed_pivot_region": {"x": [1, 0], "y": [0, 1]}}),
        "/problem/constraints/fixed_pivot_region/x",
    ),
    "label a number": (json.dumps({"problem": PROBLEM, "label": 7}).encode(), "/label"),
    "label too long": (json.dumps({"problem": PROBLEM, "label": "x" * 201}).encode(), "/label"),
    "label with NUL": (json.dumps({"problem": PROBLEM, "label": "a\0b"}).encode(), "/label"),
}

ENORMOUS = {
    "a million positions": raw('{"kind": "motion", "positions": [' + "0," * 500_000 + "0]}"),
    "a hundred thousand unknown fields": raw("{" + ",".join(f'"{n:x}":0' for n in range(100_000)) + "}"),
    "deep and closed": raw("[" * 50_000 + "]" * 50_000),
    "many empty lists": raw("[" + "[]," * 340_000 + "[]]"),
    "many deep lists": raw("[" + ("[" * 99 + "]" * 99 + ",") * 5000 + "[]]"),
    "many small objects": raw("[" + '{"a":{"b":{"c":{}}}},' * 47_000 + "{}]"),
    "many strings of quotes": raw("[" + r'"\"\\",' * 130_000 + "0]"),
    "one name many times": raw("{" + '"kind":"motion",' * 60_000 + '"kind":"motion"}'),
    "a long string": raw('"' + "x" * (MIB - 100) + '"'),
    "a long field name": raw('{"' + "x" * (MIB - 100) + '": 0}'),
    "nearly too many values": raw("{" + ",".join(f'"{n:x}":0' for n in range(19_000)) + "}"),
}
