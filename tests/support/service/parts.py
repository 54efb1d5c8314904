"""Code that several tests share: parts."""

from __future__ import annotations

import csv
import io
import zipfile
from typing import Any

import httpx

THREE = [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 40.0, "y": 15.0, "angle": -25.0},
         {"x": 75.0, "y": 5.0, "angle": -60.0}]  # fmt: skip
MOTION = {"kind": "motion", "positions": THREE, "max_designs": 1, "length_unit": "mm"}
SLIDER = {**MOTION, "output_side": {"dyad": "PR", "slide_angle": 15.0}}
SIZES = {"width": 15, "pin": 5, "thickness": 4, "clearance": 0.2}


def parts(client: httpx.Client, place: str, **query: Any) -> dict[str, bytes]:
    answer = client.get(f"{place}/parts", params=query)
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"] == "application/zip"
    with zipfile.ZipFile(io.BytesIO(answer.content)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def bill(files: dict[str, bytes]) -> dict[str, dict[str, str]]:
    return {row["part"]: row for row in csv.DictReader(io.StringIO(files["bom.csv"].decode()))}


def refused(client: httpx.Client, place: str, status: int, **query: Any) -> Any:
    answer = client.get(f"{place}/parts", params=query)
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    return answer.json()


DRIVEN = {**MOTION, "input_side": {"dyad": "PR"}}
