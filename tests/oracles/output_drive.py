"""A fourbar and its cognates with the output link as the input: the same linkage read from its other end."""

from __future__ import annotations

import numpy as np

from kinematics.linkage.fourbar import Fourbar
from kinematics.linkage.fourbar.cognates import Cognate


def driven_at_output(linkage: Fourbar) -> Fourbar:
    """The same mechanism with its output link as the input: O2 with O4, A with B, a with c exchanged."""
    return Fourbar(
        linkage.output_pivot,
        linkage.input_pivot,
        linkage.output,
        linkage.coupler,
        linkage.input,
        linkage.coupler - linkage.coupler_point,
    )


def cognate_driven_at_output(cognate: Cognate) -> Cognate:
    """The same cognate with its output link as the input."""
    first, middle, last = cognate.turns_with
    offset = cognate.offset[..., ::-1] + np.array([0.0, np.pi, 0.0])
    wrapped = np.angle(np.exp(1j * offset))
    return Cognate(driven_at_output(cognate.linkage), cognate.source, (last, middle, first), wrapped)
