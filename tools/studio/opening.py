"""The mechanism that moves when the studio opens: the first example, with the answer of the service.

The page shows it without a job, so that it moves at once, even if the service requires a key. A test queries the
service again and fails if its answer differs from the file.
"""

from __future__ import annotations

from typing import Any

import httpx

from synthesis.registry import KINDS, get_first_example

KIND = next(iter(KINDS))
STEPS = 180
"""Number of steps of the motion."""

DIGITS = 6
"""Significant digits of the stored numbers, more than a screen can show."""

WAIT_S = 60

MOTION = ("input_angle", "joints", "links", "transmission_angle", "toggles", "circuits", "valid")
"""Fields of an analysis that the picture of a motion needs."""

NOT_PLOTTED = ("jx", "jy", "jerk")


def opening(client: httpx.Client) -> dict[str, Any]:
    """Solve the first example; return its problem, its best design and the motion of that design.

    Raises
    ------
    httpx.HTTPStatusError
        If the service refuses a request.
    """
    problem = get_first_example(KIND)
    job = _json(
        client.post("/v1/jobs", json={"problem": problem}, headers={"Prefer": f"wait={WAIT_S}"}, timeout=2 * WAIT_S)
    )
    result = job["result"]
    design = result["designs"][0]
    at = f"/v1/jobs/{job['id']}"
    motion = _json(client.get(f"{at}/designs/0/motion", params={"steps": STEPS}))
    mechanism = design["mechanism"]
    question = {"mechanism": mechanism, "motion": {"at": mechanism["reference_input_angle"]}, "include": ["branches"]}
    circuits = _json(client.post("/v1/analyses", json=question))
    client.delete(at).raise_for_status()
    for kept in (*motion["joints"].values(), *motion["links"].values()):
        for name in NOT_PLOTTED:
            kept.pop(name, None)
    answer: dict[str, Any] = rounded(
        {
            "problem": problem,
            "found": len(result["designs"]),
            "summary": result["summary"],
            "design": design,
            "motion": {name: motion[name] for name in MOTION if name in motion},
            "circuits": {"circuits": circuits["circuits"]},
        }
    )
    return answer


def rounded(value: Any) -> Any:
    """Return a value with all floats in it rounded to :data:`DIGITS` significant digits."""
    if isinstance(value, float):
        short = float(f"{value:.{DIGITS}g}")
        return int(short) if short.is_integer() and abs(short) < 1e15 else short
    if isinstance(value, dict):
        return {name: rounded(one) for name, one in value.items()}
    return [rounded(one) for one in value] if isinstance(value, list) else value


def _json(answer: httpx.Response) -> Any:
    return answer.raise_for_status().json()
