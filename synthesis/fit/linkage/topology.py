"""Topologies of linkages that one crank drives, as tables of nodes.

A node is a pin, or a point of a link. Its row (kind, i, j, k) says how it follows from earlier nodes:

====== ========= ================================================================================
kind   nodes     position
====== ========= ================================================================================
FIXED            constant
CRANK  i         rotates about node i with the input
DYAD   i, j      joins two links, one of which goes through i and the other through j
POINT  i, j      fixed on the link through i and j
VIEW   i, j, k   that of node i, seen from the link through j and k, as if this link kept its reference position
====== ========= ================================================================================

A linkage of dyads grows from ground and crank: each dyad adds two links, the first of which is joined to one earlier
link and the second to another. Links are numbered: 0 is the ground, 1 the crank, 2m and 2m + 1 those of dyad m. The
first dyad is joined to the crank and the ground, so that the linkage begins with a fourbar O2 A B O4.

A Stephenson II is no chain of dyads on its ground, but it is one on its input link (inversion): its row of views shows
the joints as the ground sees them. It is driven by link 3, relative to the input.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from itertools import combinations

import numpy as np

from kinematics.arrays import Integers, Mask

FIXED, CRANK, DYAD, POINT, VIEW = range(5)
"""Kinds of nodes."""

GROUND, INPUT, COUPLER, ROCKER = range(4)
"""Numbers of the links of the first fourbar."""

Dyads = tuple[tuple[int, int], ...]
"""The links to which the first and the second link of each dyad are joined."""

FIRST_DYAD = (INPUT, GROUND)
"""The dyad that makes a fourbar of ground and crank."""


@dataclass(frozen=True, eq=False)
class Topology:
    """A topology: its nodes, and which links they belong to.

    Attributes
    ----------
    nodes : int, shape (n, 4)
        Rows of the table in the module's docstring; unused entries are 0.
    links : dict of str to tuple of int
        Pins of each link by its name; the ground is the first link.
    body : str
        Name of the link that has the traced point.
    point : int
        Node of the traced point, as the ground sees it; without one, the last pin.
    heading : int
        Node of a second point of the same link, whose direction from the traced point is the link's; negative if there
        is none.
    joints : dict of str to int
        Nodes of all joints as the ground sees them, by name.
    families : tuple of int
        Pairs of the first fourbar in :attr:`pairs`: ground, input, coupler, output. Empty if the input is not its
        crank.
    triad : tuple of int
        Nodes q, j, O₂, A, O₄, B of the triad that transmits the force (:mod:`synthesis.fit.triad_slant`); empty if
        dyads do.
    """

    nodes: Integers
    links: dict[str, tuple[int, ...]]
    body: str
    point: int
    joints: dict[str, int]
    heading: int = -1
    families: tuple[int, ...] = ()
    triad: tuple[int, ...] = ()

    @property
    def pairs(self) -> Integers:
        """All pairs of pins of one link, shape (pairs, 2), each once."""
        found = [pair for pins in self.links.values() for pair in combinations(pins, 2)]
        return np.array(found, np.int64)

    @property
    def arms(self) -> Integers:
        """The traced point, where its coordinates are, and each pin of its link, shape (a, 2); empty without one."""
        if "P" not in self.joints:
            return np.empty((0, 2), np.int64)
        return np.array([(self.get_source(self.point), pin) for pin in self.links[self.body]], np.int64)

    @cached_property
    def pin_names(self) -> dict[int, str]:
        """Names of the joints by the nodes in :attr:`links`, which are not their views."""
        return {self.get_source(k): name for name, k in self.joints.items()}

    def get_source(self, node: int) -> int:
        """Return the node of a view, or a node itself if it is none: the one that has coordinates."""
        return int(self.nodes[node, 1]) if self.nodes[node, 0] == VIEW else node

    @property
    def transmitting(self) -> Mask:
        """Which nodes are dyads whose angles transmit the force, shape (n,)."""
        # Seen from the input link of a Stephenson II, dyads are not what the force goes through; its triad is.
        dyads = self.nodes[:, 0] == DYAD
        return np.zeros_like(dyads) if self.triad else dyads

    @property
    def fixed_pivots(self) -> tuple[int, ...]:
        """Nodes of the fixed pivots, that of the input first."""
        return next(iter(self.links.values()))

    @property
    def moving_pins(self) -> tuple[int, ...]:
        """Nodes of the moving pins, as the ground sees them."""
        still = {self.pin_names[pin] for pin in self.fixed_pivots}
        return tuple(node for name, node in self.joints.items() if name not in {"P", *still})

    @property
    def measured_direction(self) -> tuple[int, int]:
        """Nodes of the direction that targets refer to: that of the body if it has a heading, else of the output."""
        return (self.point, self.heading) if self.heading >= 0 else self.get_direction("output")

    def get_direction(self, link: str) -> tuple[int, int]:
        """Return the first two nodes of a link as the ground sees them: its direction."""
        first, second, *_ = (self.joints[self.pin_names[pin]] for pin in self.links[link])
        return first, second


def build_topology(dyads: Dyads, *, traces: bool = True, guides: bool = False) -> Topology:
    """Build the topology of a chain of dyads; the traced point is on the first link of the last dyad.

    Parameters
    ----------
    dyads : tuple of pairs of int
        The links to which each dyad is joined, :data:`FIRST_DYAD` first.
    traces : bool
        Whether there is a traced point.
    guides : bool
        Whether the link with the traced point has a heading.
    """
    rows: list[tuple[int, ...]] = [(FIXED,), (CRANK, 0)]
    names = ["O2", "A"]
    pins: dict[int, list[int]] = {GROUND: [0], INPUT: [0, 1]}
    # A and B are the pins of the first dyad; those of the next dyads follow in the alphabet, P excepted.
    letters = iter("BCDEFGHIJKLMN")
    for number, joined in enumerate(dyads, 1):
        ends = []
        for link in joined:
            if number == 1 and link == INPUT:
                ends.append(1)
                continue
            # A dyad never shares a pin with an earlier one: every joint connects two links.
            rows.append((FIXED,) if link == GROUND else (POINT, *pins[link][:2]))
            names.append(f"O{2 * number + 2}" if link == GROUND else next(letters))
            pins[link].append(len(rows) - 1)
            ends.append(len(rows) - 1)
        rows.append((DYAD, *ends))
        names.append(next(letters))
        pins[2 * number], pins[2 * number + 1] = ([end, len(rows) - 1] for end in ends)
    body = 2 * len(dyads)
    if traces:
        rows.append((POINT, *pins[body][:2]))
        names.append("P")
    point = len(rows) - 1
    if guides:
        rows.append((POINT, *pins[body][:2]))
    link_names = _name_links(dyads)
    return Topology(
        nodes=_pad_rows(rows),
        links={link_names[link]: tuple(listed) for link, listed in sorted(pins.items())},
        body=link_names[body],
        point=point,
        joints={name: node for node, name in enumerate(names)},
        heading=len(rows) - 1 if guides else -1,
        families=_find_first_fourbar(pins),
    )


def _pad_rows(rows: list[tuple[int, ...]]) -> Integers:
    """Return a table of rows with 0 in the entries that their kinds do not use."""
    return np.array([[*row, *(0,) * (4 - len(row))] for row in rows], np.int64)


def _name_links(dyads: Dyads) -> list[str]:
    """Return the names of the links by number."""
    names = ["ground", "input", "coupler", "output", *(f"link_{k + 1}" for k in range(4, 2 * len(dyads) + 2))]
    # The output of a linkage is the last of its links that is joined to the ground.
    grounded = [2 * m + 1 for m, joined in enumerate(dyads, 1) if joined[1] == GROUND]
    if grounded[-1] != ROCKER:
        names[ROCKER], names[grounded[-1]] = "rocker", "output"
    return names


def _find_first_fourbar(pins: dict[int, list[int]]) -> tuple[int, ...]:
    """Return the pairs of ground, input, coupler and output of the first fourbar, by their rank among all pairs."""
    pairs = [pair for _, listed in sorted(pins.items()) for pair in combinations(listed, 2)]
    return tuple(pairs.index((pins[link][0], pins[link][1])) for link in (GROUND, INPUT, COUPLER, ROCKER))


STEPHENSON_2_BODIES = {"link_4": (1, 3), "link_3": (0, 1), "link_5": (2, 3)}
"""Links of a Stephenson II that may carry the point, with the two nodes of :func:`build_stephenson_2` on them."""


def build_stephenson_2(body: str, *, traces: bool = True, guides: bool = False) -> Topology:
    """Build a Stephenson II as its input link sees it, with the views that the ground has of its joints.

    Link 3 rotates about A relative to the input and drives the fourbar A B D C; the output, from E on link 4, and the
    ground O4 O2 are a dyad.
    """
    a, b, c, d, e, o2, o4, p = range(8)
    rows: list[tuple[int, ...]] = [(FIXED,), (CRANK, a), (FIXED,), (DYAD, b, c), (POINT, b, d), (FIXED,)]
    seen = {"A": a, "B": b, "C": c, "D": d, "E": e}
    if traces:
        rows += [(DYAD, e, o2), (POINT, *STEPHENSON_2_BODIES[body])]
        moving = seen | {"P": p}
        if guides:
            rows.append((POINT, *STEPHENSON_2_BODIES[body]))
        first_view = len(rows)
        rows += [(VIEW, node, o2, o4) for node in moving.values()]
        seen = {name: first_view + k for k, name in enumerate(moving)}
        if guides:
            rows.append((VIEW, p + 1, o2, o4))
    else:
        # Targets carry the ground along: link 3 may turn back, where ground and output are in line.
        rows.append((FIXED,))
    links = {"ground": (o2, o4), "input": (o2, a, c), "link_3": (a, b), "link_4": (b, d, e), "link_5": (c, d)}
    return Topology(
        nodes=_pad_rows(rows),
        links=links | {"output": (o4, e)},
        body=body,
        point=seen["P" if traces else "E"],
        joints={"O2": o2, "O4": o4} | seen,
        heading=len(rows) - 1 if guides else -1,
        triad=(e, o4, a, b, c, d),
    )


SIXBAR_DYADS: dict[str, Dyads] = {
    "watt_1": ((COUPLER, ROCKER), (ROCKER, COUPLER), (COUPLER, INPUT), (INPUT, COUPLER)),
    "stephenson_1": ((INPUT, ROCKER), (ROCKER, INPUT)),
    "stephenson_3": ((COUPLER, GROUND),),
}
"""Second dyads of sixbars whose traced point is on a link that is joined neither to the ground nor to the fourbar
alone."""

FUNCTION_SIXBARS: dict[str, Topology] = {
    "watt_2": build_topology((FIRST_DYAD, (ROCKER, GROUND)), traces=False),
    "stephenson_2": build_stephenson_2("link_4", traces=False),
    "stephenson_3": build_topology((FIRST_DYAD, (COUPLER, GROUND)), traces=False),
}
"""Sixbars whose output is a link on the ground that a fourbar does not drive alone, without a traced point."""

EIGHTBAR_DYAD_COUNT = 3
"""Number of dyads of an eightbar, with that of its first fourbar."""


@cache
def list_generators(kind: str) -> tuple[Topology, ...]:
    """Return the topologies of a type of function generator: one of :data:`FUNCTION_SIXBARS`, or ``eightbar``."""
    if kind == "eightbar":
        return tuple(build_topology(chain, traces=False) for chain in _list_dyads(EIGHTBAR_DYAD_COUNT, grounded=True))
    return (FUNCTION_SIXBARS[kind],)


@cache
def list_forms(kind: str, *, guides: bool = False) -> tuple[Topology, ...]:
    """Return the topologies of a type of linkage: a sixbar of :data:`SIXBAR_DYADS`, ``stephenson_2`` or ``eightbar``.

    ``guides`` asks for headings of the link with the traced point.
    """
    if kind == "stephenson_2":
        return tuple(build_stephenson_2(body, guides=guides) for body in STEPHENSON_2_BODIES)
    # Eightbars have 88 topologies, too many to name: the type stands for all of them.
    if kind == "eightbar":
        return tuple(list_chains(EIGHTBAR_DYAD_COUNT, guides=guides))
    return tuple(build_topology((FIRST_DYAD, pair), guides=guides) for pair in SIXBAR_DYADS[kind])


def list_chains(dyad_count: int, *, guides: bool = False) -> list[Topology]:
    """Return all topologies of a number of dyads in which every dyad moves the traced point."""
    return [build_topology(chain, guides=guides) for chain in _list_dyads(dyad_count, grounded=False)]


def _list_dyads(dyad_count: int, *, grounded: bool) -> list[Dyads]:
    """Return all chains in which every dyad moves the last one, whose second link is on the ground if ``grounded``."""
    chains: list[Dyads] = [(FIRST_DYAD,)]
    for number in range(2, dyad_count + 1):
        last, links = number == dyad_count, range(2 * number)
        # Only for the last dyad the order of its links matters: the point is on the first, which must not be grounded.
        chains = [
            (*chain, (i, j))
            for chain in chains
            for i in links
            for j in links
            if i != j and ((i != GROUND and (not grounded or j == GROUND)) if last else i < j)
        ]
    return [_ground_second(chain) for chain in chains if _moves_last(chain)]


def _ground_second(chain: Dyads) -> Dyads:
    """Return the chain with the second link of each dyad joined to the ground, if one is."""
    # The order of a dyad's links only changes their numbers, which later dyads refer to: exchange these as well.
    renumbered: list[tuple[int, int]] = []
    numbers = {GROUND: GROUND, INPUT: INPUT}
    for m, joined in enumerate(chain, 1):
        exchanged = joined[0] == GROUND
        first, second = joined[::-1] if exchanged else joined
        renumbered.append((numbers[first], numbers[second]))
        numbers[2 * m], numbers[2 * m + 1] = (2 * m + 1, 2 * m) if exchanged else (2 * m, 2 * m + 1)
    return tuple(renumbered)


def _moves_last(chain: Dyads) -> bool:
    """Return whether every dyad is between the last one and the crank."""
    needed, waiting = set[int](), [len(chain)]
    while waiting:
        number = waiting.pop()
        if number not in needed:
            needed.add(number)
            waiting += [link // 2 for link in chain[number - 1] if link > INPUT]
    return len(needed) == len(chain)
