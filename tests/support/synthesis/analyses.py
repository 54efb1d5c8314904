"""Code that several tests share: analyses."""

import math

import numpy as np

from tests.kinematics.mechanism_sampling import EVERY, geared_fivebar, take

KINDS = {
    "fourbar": "fourbar", "slider-crank": "slider_crank", "slider-crank driven by its slider": "slider_crank",
    "inverted slider-crank": "inverted_slider_crank", "crank-shaper": "crank_shaper", "Whitworth": "whitworth",
    "geared fivebar": "geared_fivebar", "drag link and rocker": "drag_link_rocker",
    "drag link and slider": "drag_link_slider", "Peaucellier": "peaucellier",
}  # fmt: skip


def stated(name):
    """A random mechanism of a type by its skeleton and the lengths of its links of two joints."""
    rng = np.random.default_rng(3)
    # With a ratio that does not repeat, circuits would not be listed.
    mechanism = take(geared_fivebar(rng, 1, -2.0) if name == "geared fivebar" else EVERY[name](rng, 1), 0)
    kind = KINDS.get(name, name.split()[0])

    def pair(place):
        return [complex(place).real, complex(place).imag]

    binary = {n: j for n, j in mechanism.links.items() if len(j) == 2}
    return {
        "type": kind,
        "links": {n: abs(complex(mechanism.joints[i] - mechanism.joints[j])) for n, (i, j) in binary.items()},
        "skeleton": {
            "joints": {n: pair(z) for n, z in mechanism.joints.items()},
            "links": [{"name": n, "joints": list(j)} for n, j in mechanism.links.items()],
            "slides": [
                {"joint": s.joint, "link": s.link, "point": pair(s.point), "angle": math.degrees(s.angle)}
                for s in mechanism.slides
            ],
            "gears": [{"links": [g.first, g.second], "ratio": g.ratio} for g in mechanism.gears],
            "input_link": mechanism.input,
        },
    }
