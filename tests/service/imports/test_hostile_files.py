"""``POST /v1/imports`` with files that no honest client sends: read or refused, in bounded time and memory."""

import asyncio
import functools
import io
import random
import re
import struct
import time
import zlib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from service.imports import desk as desks
from service.imports.desk import ImportDesk
from service.outlines import DrawingError
from service.outlines.faults import MalformedDrawing, NoOutline, UnsuitableDrawing
from tests.support.service.drawn_files import dxf, page
from tests.support.service.hostile_drawings import HOSTILE, everything, mutated
from tests.support.service.imports import TABLES, blob, found, picture, read
from tests.support.service.outlines import SHAPES
from tests.support.service.request_pool import never
from tests.support.service.running import LEAN, RunningServer, workers_of

REFUSED = (400, 413, 415, 422)
SOON_S = 30.0
"""For one file, on a machine that may be very busy: the reader gives up after ten seconds."""

MOST_MB = 900
"""What a reader takes at most: its libraries, and what a file may have."""


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(*chunks):
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(kind, data) for kind, data in chunks)


def head(width, height, depth=8, colour=0):
    return b"IHDR", struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, 0)


def squeezed(count):
    """So many equal bytes, a thousand times smaller."""
    return zlib.compress(b"\0" * count, 9)


def pattern(rows):
    file = io.BytesIO()
    Image.fromarray(rows.astype(np.uint8)).save(file, "PNG")
    return file.getvalue()


SMALL = (head(9, 9), (b"IDAT", squeezed(90)), (b"IEND", b""))

PICTURES = {
    "a picture of 10^10 pixels": lambda: png(head(100_000, 100_000), (b"IDAT", squeezed(1 << 26)), (b"IEND", b"")),
    "a picture of the greatest size": lambda: png(head(2**31 - 1, 2**31 - 1), (b"IDAT", b""), (b"IEND", b"")),
    "a picture without pixels": lambda: png(head(0, 0), (b"IEND", b"")),
    "more rows than it says": lambda: png(head(64, 64), (b"IDAT", squeezed(1 << 27)), (b"IEND", b"")),
    "fewer rows than it says": lambda: png(head(4000, 4000), (b"IDAT", squeezed(4001)), (b"IEND", b"")),
    "a text of 128 MiB": lambda: png(SMALL[0], (b"zTXt", b"a\0\0" + squeezed(1 << 27)), *SMALL[1:]),
    "a profile of 128 MiB": lambda: png(SMALL[0], (b"iCCP", b"a\0\0" + squeezed(1 << 27)), *SMALL[1:]),
    "many chunks": lambda: png(SMALL[0], *[(b"tEXt", b"a\0b")] * 60_000, *SMALL[1:]),
    "no pixels that can be unpacked": lambda: png(head(9, 9), (b"IDAT", b"junk"), (b"IEND", b"")),
    "a second header": lambda: png(SMALL[0], head(100_000, 100_000), *SMALL[1:]),
    "a density of nothing": lambda: png(SMALL[0], (b"pHYs", struct.pack(">IIB", 0, 0, 1)), *SMALL[1:]),
    "a checkerboard": lambda: pattern(np.indices((4000, 4000)).sum(0) % 2 * 255),
    "stripes": lambda: pattern(np.tile(np.arange(4096) % 2 * 255, (4096, 1))),
    "noise": lambda: pattern(np.random.default_rng(1).integers(0, 256, (900, 900))),
    "one row": lambda: pattern(np.arange(60_000)[None] % 7 * 40),
    "nothing but white": lambda: pattern(np.full((4096, 4096), 255)),
    "cut off": lambda: picture(200, blob())[:300],
}

TABLES_OF_ALL_SORTS = {
    "a table of one column": lambda: b"1\n" * 300_000,
    "10^5 curves": lambda: b"0 0\n\n" * 200_000,
    "10^5 points": lambda: b"".join(b"%d %d\n" % (k, k % 9) for k in range(90_000)),
    "a zigzag that grows": lambda: b"".join(b"%d %d\n" % (k * (-1) ** k, k) for k in range(70_000)),
    "a spiral": lambda: b"".join(b"%.3f %.3f\n" % (k * np.cos(k / 9), k * np.sin(k / 9)) for k in range(40_000)),
    "cells without end": lambda: b"1," * 500_000,
    "one digit after the other": lambda: b"1" * 1_000_000,
    "commas": lambda: b"," * 1_000_000,
    "quotes": lambda: b'"' * 1_000_000,
    "the same point": lambda: b"1 1\n" * 90_000,
    "numbers beyond all": lambda: b"0,0\n1e308,1e308\n-1e308,1e308\n",
    "numbers next to nothing": lambda: b"0,0\n1e-308,1e-308\n-1e-308,5e-324\n",
    "nothing": lambda: b"",
    "no text": lambda: bytes(range(256)) * 100,
    "half a character": lambda: b"\xff\xfe0",
}

SPOILT = {
    name: functools.cache(make)
    for name, make in ({name: make for name, (make, _) in HOSTILE.items()} | PICTURES | TABLES_OF_ALL_SORTS).items()
}

AT_ONCE = {
    "laughs", "deep groups", "no numbers", "far away", "a block within itself", "a block many times", "inf in a DXF",
    "a picture of 10^10 pixels", "more rows than it says", "a text of 128 MiB", "a density of nothing",
    "a second header", "no pixels that can be unpacked", "a checkerboard", "one row", "cut off", *TABLES_OF_ALL_SORTS,
}  # fmt: skip
"""What takes no second to make and to read; the others are tried by the campaign."""


@pytest.mark.slow
@pytest.mark.parametrize(
    "what", [pytest.param(name, marks=[] if name in AT_ONCE else pytest.mark.campaign) for name in SPOILT]
)
def test_a_hostile_file_is_refused_soon_or_read(client, what):
    content = SPOILT[what]()
    began = time.monotonic()
    answer = read(client, content)
    assert time.monotonic() - began < SOON_S
    assert answer.status_code in (200, *REFUSED), answer.text
    if answer.status_code == 200:
        curves = answer.json()["curves"]
        assert curves
        numbers = np.array([(p["x"], p["y"], one["length"]) for one in curves for p in one["points"]])
        assert np.isfinite(numbers).all()
        assert np.abs(numbers[:, :2]).max() <= 1e9
        assert all(len(one["points"]) <= 1000 for one in curves)
    else:
        assert len(answer.text) < 20_000
    assert client.get("/healthz").status_code == 200


@pytest.mark.slow
@pytest.mark.parametrize(
    ("what", "word"),
    [
        ("laughs", "entities"), ("a picture of 10^10 pixels", "pixels"),
        ("a checkerboard", "400\u202f000 points"), ("a block within itself", "deep"),
        ("10^5 curves", "1000 curves"), ("cut off", "cannot be read"),
    ],
)  # fmt: skip
def test_a_refusal_says_why(client, what, word):
    assert word in read(client, SPOILT[what]()).json()["detail"]


def test_nothing_that_a_file_refers_to_is_fetched(client, tmp_path):
    secret = tmp_path / "secret.svg"
    secret.write_bytes(page('<path d="M0 0h77"/>'))
    for reference in (
        f'<use href="file://{secret}#a"/>', f'<image href="file://{secret}"/>', f'<?xml-stylesheet href="{secret}"?>',
    ):  # fmt: skip
        (curve,) = found(client, page('<path d="M0 0h9"/>' + reference))["curves"]
        assert curve["length"] == 9
    for declared in (f'<!ENTITY a SYSTEM "file://{secret}">', f'<!ENTITY % a SYSTEM "{secret}"> %a;'):
        body = f"<!DOCTYPE svg [{declared}]>{page('<text>x</text>').decode()}"
        assert read(client, body.encode()).status_code == 400


# Fuzzed from real files.


def changed_picture(content, rng):
    """Some chunk of it is another: its data, its length, its place, its kind; its sums are right as often as not."""
    at, chunks = 8, []
    while at + 8 <= len(content):
        size = int.from_bytes(content[at : at + 4], "big")
        chunks.append([content[at + 4 : at + 8], bytearray(content[at + 8 : at + 8 + size])])
        at += 12 + size
    for _ in range(rng.randint(1, 3)):
        k = rng.randrange(len(chunks))
        kind, data = chunks[k]
        what = rng.randrange(5)
        if what == 0 and data:
            data[rng.randrange(len(data))] = rng.randrange(256)
        elif what == 1:
            del data[rng.randrange(len(data) + 1) :]
        elif what == 2:
            chunks[k][0] = rng.choice([b"IHDR", b"PLTE", b"tRNS", b"pHYs", b"IEND", b"acTL", b"fdAT", b"gAMA"])
        elif what == 3:
            chunks.insert(rng.randrange(len(chunks)), [kind, bytearray(data)])
        else:
            del chunks[k]
            if not chunks:
                break
    made = bytearray(png(*((bytes(kind), bytes(data)) for kind, data in chunks)))
    if rng.random() < 0.3:
        made[rng.randrange(len(made))] = rng.randrange(256)
    return bytes(made)


ODD_CELLS = [b"", b";", b"\t", b",,", b"nan", b"1e999", b"-", b"\0", b"\xff", b'"', b"\n\n", b"#", b"9" * 80, b"e"]


def changed_table(content, rng):
    for _ in range(rng.randint(1, 4)):
        spot = rng.choice(list(re.finditer(rb"[^\n]", content)))
        odd = rng.choice(
            [b"", b";", b"\t", b",,", b"nan", b"1e999", b"-", b"\0", b"\xff", b'"', b"\n\n", b"#", b"9" * 80, b"e"]
        )
        content = content[: spot.start()] + odd + content[spot.end() :]
    return content


def seeds():
    svg = page("".join(SHAPES) + '<circle r="4"/><path d="M0 0C1 2 3 4 5 6S7 8 9 9"/>', width="9mm", viewBox="0 0 9 9")
    tables = [table.encode() for table in TABLES.values()]
    pictures = [
        picture(40, lambda pen, k: pen.ellipse([5 * k, 5 * k, 30 * k, 20 * k], fill=0), dpi=(300, 300)),
        picture(40, lambda pen, k: pen.ellipse([5 * k, 5 * k, 30 * k, 20 * k], fill=0), colours=8),
        picture(
            40, lambda pen, k: pen.rectangle([5, 5, 30, 20], fill=(9, 9, 9, 200)), mode="RGBA", ground=(0, 0, 0, 0)
        ),
        picture(40, lambda pen, k: pen.rectangle([5, 5, 30, 20], fill=0), finer=1, mode="1", ground=1),
    ]
    drawings = [svg, svg, dxf(everything, dxfversion="R12"), dxf(everything, dxfversion="R2018")]
    return [(mutated, one) for one in drawings] + [(changed_table, one) for one in tables] + [
        (changed_picture, one) for one in pictures * 2
    ]  # fmt: skip


def fuzz(client, numbers):
    """Send so many changed files; how often each status was the answer."""
    files = seeds()
    seen: dict[int, int] = {}
    for seed in numbers:
        rng = random.Random(seed)
        change, content = rng.choice(files)
        began = time.monotonic()
        answer = read(client, change(content, rng))
        assert time.monotonic() - began < SOON_S, seed
        assert answer.status_code in (200, *REFUSED), (seed, answer.text)
        seen[answer.status_code] = seen.get(answer.status_code, 0) + 1
    return seen


def test_changed_files_are_read_or_refused(client):
    seen = fuzz(client, range(60))
    assert {200, 400} <= set(seen)


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """A server whose children are known."""
    running = RunningServer(tmp_path_factory.mktemp("alone"), LEAN, workers=1, reserve=0)
    running.own = set(running.workers())
    yield running
    assert running.stop() == 0


def readers(running):
    return set(workers_of(running.process.pid)) - running.own


def greatest_mb(pid):
    """The most memory that a process has had."""
    text = Path(f"/proc/{pid}/status").read_text()
    return int(re.search(r"VmHWM:\s+(\d+) kB", text)[1]) / 1024


@pytest.mark.campaign
def test_500_changed_files_take_bounded_memory(alone):
    seen = fuzz(alone.client, range(1000, 1500))
    for what in SPOILT:
        read(alone.client, SPOILT[what]())
    took = {pid: greatest_mb(pid) for pid in readers(alone)}
    print(seen, took, "server", greatest_mb(alone.process.pid))
    assert sum(seen.values()) == 500
    assert took
    assert max(took.values()) < MOST_MB
    assert greatest_mb(alone.process.pid) < MOST_MB


# The desk itself.


def asked(desk, content, door="imports"):
    return asyncio.run(desk.read(never, "acme", door, content))


@pytest.fixture
def desk(monkeypatch):
    monkeypatch.setattr(desks, "READER_COUNT", 1)  # each start takes a second
    desk = ImportDesk("warning", "text", memory_mb=24)
    yield desk
    desk.stop()


@pytest.mark.campaign
def test_a_file_that_takes_too_much_is_given_up_and_the_next_one_is_read(desk, monkeypatch):
    line = page('<path d="M0 0h9"/>')
    assert b'"length":9' in asked(desk, line)
    large = SPOILT["nothing but white"]()
    with pytest.raises(UnsuitableDrawing, match="more memory"):
        asked(desk, large)
    assert b'"length":9' in asked(desk, line)
    for content, error in ((b"<svg", MalformedDrawing), (page("<text/>"), NoOutline)):
        with pytest.raises(DrawingError) as caught:
            asked(desk, content)
        assert type(caught.value) is error
    assert caught.value.reasons == (("text", "It is text; turn it into paths."),)
    monkeypatch.setattr(desks, "READ_TIMEOUT_S", 1e-4)
    impatient = ImportDesk("warning", "text")
    with pytest.raises(UnsuitableDrawing, match="takes longer"):
        asked(impatient, page('<rect width="9" height="9"/>' * 900), "outlines")
    impatient.stop()
