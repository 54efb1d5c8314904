"""Code that several tests share: sixbar curve."""

from __future__ import annotations

import math

import numpy as np

from synthesis.fit.constraints import (
    BOXES,
    CHANGE_POINT,
    COSINE,
    FAMILY_INDEX,
    FULL_TURN_INDEX,
    GIVEN_PIVOTS,
    LINKS,
    MOVING,
    POINT_BOX,
    RATIO,
    SIGN_INDEX,
)
from synthesis.kinds.path.residuals.sixbar import (
    BACK,
    CARRIER,
    HOLDER,
    ROOM,
    SIDE,
    SIXBAR_SETTING_SIZE,
    STEPS,
)
from synthesis.kinds.path.sixbar.shape_matching import find_similar_sixbars

CIRCLE = np.exp(2j * np.pi * np.arange(48) / 48)


def drawn(form, seed=0):
    """The sixbar of a form whose curve is most like an ellipse."""
    rng = np.random.default_rng(seed)
    found = find_similar_sixbars(form, CIRCLE.real + 0.6j * CIRCLE.imag, True, 1024, 1, rng)
    return found.x[0], found.signs[0], found.theta[0]


def stated(form, signs, x):
    """Demands of every sort, most of them broken a little, so that they bear loads."""
    out = np.full(SIXBAR_SETTING_SIZE, math.inf)
    out[FAMILY_INDEX], out[CARRIER], out[HOLDER] = form
    out[SIGN_INDEX], out[SIDE] = signs
    out[FULL_TURN_INDEX], out[CHANGE_POINT], out[STEPS], out[BACK] = 1.0, 1e-6, 12, 0.3
    out[LINKS], out[RATIO], out[COSINE] = (0.6, 1.2), 1.5, math.cos(math.radians(60.0))
    out[BOXES] = np.tile([x[0] + 0.1, x[0] + 0.3], 4)
    out[MOVING] = -0.1, 0.1, -0.1, 0.1
    out[POINT_BOX] = -math.inf, math.inf, -math.inf, math.inf
    out[GIVEN_PIVOTS] = 0.1, math.nan, math.nan, 0.2
    out[ROOM] = -0.4, 0.3, -0.3, 0.4
    return out
