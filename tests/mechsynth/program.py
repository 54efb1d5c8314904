"""A program of somebody who uses the library, for a type checker: it is never run."""

import threading
from pathlib import Path
from typing import assert_type

import numpy as np
from numpy.typing import NDArray

from mechsynth import AsyncClient, Client, Constraints, Cycle, Design, InvalidProblem, Motion, Position, Result, solve
from mechsynth.parts import Region

places = [Position(x=0.0, y=0.0, angle=0.0), Position(x=40.0, y=15.0, angle=-25.0, tolerance=1.0)]
limits = Constraints(min_transmission_angle=30.0, fixed_pivot_region=Region(x=(-10.0, 10.0), y=(-10.0, 10.0)))
problem = Motion(positions=places, constraints=limits, max_designs=3)


def here() -> dict[str, str]:
    try:
        result = assert_type(solve(problem, progress=True, cancel=threading.Event()), Result)
    except InvalidProblem as error:
        return assert_type(error.errors, dict[str, str])
    best: Design = result.designs[0]
    assert_type(best.draw(), str)
    assert_type(best.to_dxf("a.dxf"), Path)
    cycle = assert_type(best.motion(360), Cycle)
    assert_type(cycle.joints["P"], NDArray[np.float64])
    return {}


def there() -> None:
    with Client("http://127.0.0.1:8000", key="k") as client:
        assert_type(client.solve(problem, label="one", progress=lambda share, doing: print(share, doing)), Result)


async def on_a_loop() -> Result:
    async with AsyncClient("http://127.0.0.1:8000") as client:
        return await client.solve({"kind": "gear_train", "ratio": "pi"})
