"""Code that several tests share: kernels."""

from __future__ import annotations

import numpy as np

from kinematics.linkage.slider_crank.closed_form import SliderCrank


def random_slider_cranks(rng: np.random.Generator, n: int, scale: float = 1.0) -> SliderCrank:
    pivot, point = (scale * (rng.normal(size=n) + 1j * rng.normal(size=n)) for _ in range(2))
    angle = rng.uniform(-np.pi, np.pi, n)
    crank, coupler = (scale * np.exp(rng.uniform(np.log(0.1), np.log(3.0), n)) for _ in range(2))
    on_slide = pivot + scale * np.exp(1j * angle) * (rng.normal(size=n) + 1j * rng.uniform(-1.5, 1.5, n))
    return SliderCrank(pivot, on_slide, angle, crank, coupler, point)
