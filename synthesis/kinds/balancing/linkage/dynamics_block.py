"""The ``dynamics`` block of an answer: the client's block with counterweights and geared inertias added."""

from __future__ import annotations

from collections.abc import Sequence

from kinematics.dynamics.bodies import join_bodies, make_body
from kinematics.dynamics.machine import Machine
from synthesis.kinds.balancing.linkage.force_balance import Weight
from synthesis.model.dynamics.request import DynamicsBlock
from synthesis.model.json_object import JsonObject


def add_weights(machine: Machine, block: DynamicsBlock, weights: Sequence[Weight]) -> JsonObject:
    """Add weights to the block: links with a weight become bodies with mass, centre of gravity and inertia."""
    stated = block.model_dump(mode="json", by_alias=True, exclude_unset=True)
    bodies = dict(stated.get("bodies", {}))
    for link in dict.fromkeys(weight.link for weight in weights):
        own = machine.bodies.get(link)
        parts = [weight.body for weight in weights if weight.link == link]
        if own is not None and (float(own.mass) > 0.0 or float(own.inertia) > 0.0):
            # A body without mass has no meaningful centre: its inertia is placed at the weight's centre.
            parts.insert(0, own if float(own.mass) > 0.0 else make_body(0.0, complex(parts[0].cg), float(own.inertia)))
        whole = join_bodies(parts)
        cg = complex(whole.cg) / machine.scale
        bodies[link] = {"mass": float(whole.mass), "cg": [cg.real, cg.imag], "inertia": float(whole.inertia)}
    return {**stated, "bodies": bodies}


def with_inertias(block: JsonObject, inertias: dict[str, float]) -> JsonObject:
    """Add links that have an inertia but no mass to the block."""
    turned = {link: {"mass": 0.0, "inertia": inertia} for link, inertia in inertias.items()}
    return {**block, "bodies": {**block["bodies"], **turned}}
