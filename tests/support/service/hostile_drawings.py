"""Code that several tests share: hostile drawings."""

import re

from tests.support.service.drawn_files import PLAIN, dxf, page


def laughs():
    levels = "".join(f'<!ENTITY a{k} "{f"&a{k - 1};" * 10}">' for k in range(1, 10))
    return f'<!DOCTYPE svg [<!ENTITY a0 "ha">{levels}]><svg><text>&a9;</text></svg>'.encode()


def uses():
    levels = "".join(f'<g id="g{k}">{f"""<use href="#g{k - 1}"/>""" * 10}</g>' for k in range(1, 12))
    return page(f'<defs><rect id="g0" width="9" height="9"/>{levels}</defs><use href="#g11"/>')


def blocks(draw):
    return dxf(draw)


def doubled(space):
    space.doc.blocks.new("B0").add_circle((0, 0), 1)
    for k in range(1, 20):
        block = space.doc.blocks.new(f"B{k}")
        for x in range(4):
            block.add_blockref(f"B{k - 1}", (x, 0))
    space.add_blockref("B19", (0, 0))


def itself(space):
    block = space.doc.blocks.new("SELF")
    block.add_circle((0, 0), 1)
    block.add_blockref("SELF", (1, 0))
    space.add_blockref("SELF", (0, 0))


def tiled(space):
    space.doc.blocks.new("TILE").add_circle((0, 0), 1)
    counts = {"row_count": 30_000, "column_count": 30_000, "row_spacing": 0.0, "column_spacing": 1.0}
    space.add_blockref("TILE", (0, 0), dxfattribs=counts)


def star(space):
    for k in range(5000):
        space.add_line((0, 0), (k + 1, 1))


def many(space):
    for k in range(1100):
        space.add_circle((3 * k, 0), 1)


HOSTILE = {
    "laughs": (laughs, 400),
    "uses within uses": (uses, 422),
    "a use of itself": (lambda: page('<g id="a"><use href="#a"/></g>'), 422),
    "deep groups": (lambda: page("<g>" * 5000 + "</g>" * 5000), 422),
    "many elements": (lambda: page("<g/>" * 60_000), 422),
    "many attributes": (lambda: page("<g " + " ".join(f'a{k}="1"' for k in range(20_000)) + "/>"), 422),
    "many vertices": (lambda: page(f'<polygon points="{"0 0 1 1 " * 120_000}"/>'), 422),
    "a path of 10^5 lines": (lambda: page(f'<path d="M0 0{"l1 1" * 110_000}"/>'), 422),
    "arcs without separators": (lambda: page(f'<path d="M0 0a{"1-1" * 200_000}"/>'), 422),
    "digits without end": (lambda: page(f'<path d="M0 0L{"1" * 500_000}"/>'), 422),
    "commas": (lambda: page(f'<polygon points="{"," * 900_000}x"/>'), 422),
    "transforms": (lambda: page(f'<rect width="9" height="9" transform="{"scale(1.1) " * 80_000}"/>'), 422),
    "a transform of commas": (lambda: page(f'<rect width="9" height="9" transform="scale({"1," * 400_000}x)"/>'), 422),
    "no numbers": (lambda: page('<path d="MNaN NaNL1 1z"/><circle r="inf"/><rect width="nan" height="1"/>'), 422),
    "far away": (lambda: page('<path d="M1e308 1e308h1e308v1e308z"/><circle r="1e10"/>'), 422),
    "a fine tolerance": (lambda: page('<ellipse rx="1e8" ry="1e7"/>'), 422),
    "blocks within blocks": (lambda: blocks(doubled), 422),
    "a block within itself": (lambda: blocks(itself), 422),
    "a block many times": (lambda: blocks(tiled), 422),
    "a star of lines": (lambda: blocks(star), 422),
    "lines on one another": (lambda: page(f'<path d="{"M0 0H1" * 45_000}"/>'), 422),
    "many outlines": (lambda: blocks(many), 422),
    "nan in a DXF": (lambda: PLAIN.replace("5.0", "nan").encode(), 422),
    "inf in a DXF": (lambda: PLAIN.replace("3.0", "1e400").encode(), 422),
    "a number that is none": (lambda: PLAIN.replace("5.0", "five").encode(), 400),
    "a spline of degree 10^6": (
        lambda: PLAIN.replace("CIRCLE", "SPLINE").replace("40\n5.0", "71\n1000000").encode(),
        400,
    ),
    "NULs": (lambda: b"\0" * 1000, 415),
    "a table of nothing": (lambda: b"0\nSECTION\n2\nTABLES\n" + b"0\nTABLE\n" * 20_000 + b"0\nEOF\n", 422),
}


def everything(space):
    space.doc.blocks.new("HINGE").add_circle((1, 1), 2)
    space.add_blockref("HINGE", (3, 3))
    space.add_polyline2d([(70, 0), (80, 0), (80, 5)], close=True)
    space.add_arc((0, 0), 3, 10, 200)
    space.add_line((1, 1), (2, 2))
    space.add_circle((9, 9), 1)


ODD = [b"-1", b"0", b"1e308", b"7.5", b"-1e9", b"1e-320", b"nan", b"70000", b"\xff", "²".encode(), b"1e20", b""]
WORDS = [b"SPLINE", b"INSERT", b"LINE", b"HINGE", b"ENDSEC", b"LWPOLYLINE", b"POLYLI\xff'E", b"EOF", b"SOLID"]


def mutated(drawing, rng):
    """Some numbers or words of it are others, or some of its bytes."""
    if rng.random() < 0.2:
        changed = bytearray(drawing)
        for _ in range(rng.randint(1, 4)):
            changed[rng.randrange(len(changed))] = rng.randrange(256)
        return bytes(changed)
    for _ in range(rng.randint(1, 4)):
        if drawing.startswith(b"<"):
            spot = rng.choice(list(re.finditer(rb"[0-9.]+", drawing)))
            drawing = drawing[: spot.start()] + rng.choice(ODD) + drawing[spot.end() :]
        else:
            lines = drawing.split(b"\n")
            lines[2 * rng.randrange(len(lines) // 2) + 1] = rng.choice(ODD + WORDS)
            drawing = b"\n".join(lines)
    return drawing
