"""Number synthesis: which links make a chain of given freedom, and which chains of one freedom they make.

A *chain* is links joined by pins, none of them ground yet; a link with two joints is binary, with three ternary, and so
on. Counting alone leaves sets of links (Norton, Eq. 2.3–2.7),

    Σ n_k = L,    Σ k n_k = 3 (L − 1) − M,

and of a set some chains, or none: no part of a chain may be rigid, 3 (l − 1) − 2 j ≥ 1 for any l of its links with
the j joints between them (Norton, Sec. 2.8). Chains are listed without their isomorphs: links that are not binary are
joined by *paths* of binary links in all ways, and of what differs by a permutation one is kept.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np

from kinematics.arrays import Integers
from kinematics.errors import DimensionError

Joints = tuple[tuple[int, int], ...]
"""Pairs of links that are joined, links by number."""

MOST_LINKS = 10
"""Links of a chain at most, for parts are counted one by one."""


def link_sets(links: int, mobility: int = 1) -> list[tuple[int, ...]]:
    """Numbers of binary, ternary, quaternary, ... links (Norton, Eq. 2.3–2.7); those of fewest binary links first.

    Parameters
    ----------
    links, mobility : int
        Number of links, ground included, and freedoms of the mechanism.

    Returns
    -------
    list of tuple
        Counts by order, from binary links to those with ``links − mobility − 1`` joints, the most there can be; empty
        where there is no such chain.

    Raises
    ------
    DimensionError
        For fewer than two links or a mobility below one.

    Examples
    --------
    >>> link_sets(6)
    [(4, 2, 0), (5, 0, 1)]
    """
    if links < 2:
        raise DimensionError("links", "two or more", links)
    if mobility < 1:
        raise DimensionError("mobility", "one or more", mobility)
    excess = links - 3 - mobility  # joints beyond two a link: Σ (k − 2) n_k
    if excess < 0 or (3 * (links - 1) - mobility) % 2:
        return []
    width = links - mobility - 2

    def rest(order: int, left: int) -> Iterator[tuple[int, ...]]:
        if order == width + 1:
            if left == 0:
                yield ()
            return
        for count in range(left // (order - 1) + 1):
            for higher in rest(order + 1, left - count * (order - 1)):
                yield (count, *higher)

    return sorted((links - sum(higher), *higher) for higher in rest(2, excess) if sum(higher) <= links)


def kinematic_chains(link_set: tuple[int, ...]) -> list[Joints]:
    """All chains of one freedom that a set of links makes, none twice.

    Parameters
    ----------
    link_set : tuple of int
        Numbers of binary, ternary, ... links.

    Returns
    -------
    list of tuple
        The joints of each chain; links that are not binary have the first numbers, those of most joints last of them.

    Raises
    ------
    DimensionError
        For more than ``MOST_LINKS`` links, or a set that has not one freedom.
    """
    total = sum(link_set)
    if total > MOST_LINKS:
        raise DimensionError("link_set", f"at most {MOST_LINKS} links", total)
    if sum((order + 2) * count for order, count in enumerate(link_set)) != 3 * total - 4:
        raise DimensionError("link_set", "links of a chain with one freedom", link_set)
    binary = link_set[0]
    orders = [order + 3 for order, count in enumerate(link_set[1:]) for _ in range(count)]
    if not orders:
        return [tuple((n, (n + 1) % binary) for n in range(binary))]
    alike = _permutations(orders)
    found = []
    for paths in _multigraphs(orders, alike):
        same = alike[(paths[alike[:, :, None], alike[:, None, :]] == paths).all(axis=(1, 2))]
        seen: set[Lengths] = set()
        for lengths in _lengths(paths, binary):
            if lengths in seen:
                continue
            seen.update(_permuted(lengths, permutation) for permutation in same.tolist())
            joints = _joints(lengths, len(orders))
            if not _has_rigid_part(joints, total):
                found.append(joints)
    return found


def isomers(links: int) -> int:
    """Number of chains of one freedom of so many links (Norton, Table 2-3).

    Examples
    --------
    >>> [isomers(links) for links in (4, 6, 8)]
    [1, 2, 16]
    """
    return sum(len(kinematic_chains(chosen)) for chosen in link_sets(links))


Lengths = tuple[tuple[int, int, tuple[int, ...]], ...]
"""For two links: the numbers of binary links on each path between them, ascending."""


def _permutations(orders: list[int]) -> Integers:
    """Permutations of the links that keep their orders, shape (n, links)."""
    groups = [[n for n, k in enumerate(orders) if k == order] for order in sorted(set(orders))]
    every = itertools.product(*(itertools.permutations(group) for group in groups))
    return np.array([list(itertools.chain(*parts)) for parts in every], np.int64)


def _multigraphs(orders: list[int], alike: Integers) -> list[Integers]:
    """How many paths there are between every two links, (links, links); one of each class under permutations."""
    count = len(orders)
    pairs = list(itertools.combinations(range(count), 2))
    found: list[Integers] = []
    seen: set[bytes] = set()

    def fill(n: int, paths: Integers, left: list[int]) -> None:
        if n == len(pairs):
            if not any(left) and paths.tobytes() not in seen:
                found.append(paths.copy())
                seen.update(image.tobytes() for image in paths[alike[:, :, None], alike[:, None, :]])
            return
        i, j = pairs[n]
        if j == i + 1 and any(left[:i]):
            return
        for paths_here in range(min(left[i], left[j]) + 1):
            paths[i, j] = paths[j, i] = paths_here
            left[i], left[j] = left[i] - paths_here, left[j] - paths_here
            fill(n + 1, paths, left)
            left[i], left[j] = left[i] + paths_here, left[j] + paths_here
        paths[i, j] = paths[j, i] = 0

    fill(0, np.zeros((count, count), np.int64), list(orders))
    return found


def _lengths(paths: Integers, binary: int) -> Iterator[Lengths]:
    """All ways to put the binary links on the paths; at most one path between two links is a joint."""
    pairs = [(i, j) for i, j in itertools.combinations(range(len(paths)), 2) if paths[i, j]]

    def rest(n: int, left: int) -> Iterator[Lengths]:
        if n == len(pairs):
            if left == 0:
                yield ()
            return
        i, j = pairs[n]
        for own in itertools.combinations_with_replacement(range(left + 1), int(paths[i, j])):
            if sum(own) <= left and own.count(0) <= 1:
                for others in rest(n + 1, left - sum(own)):
                    yield ((i, j, own), *others)

    yield from rest(0, binary)


def _permuted(lengths: Lengths, permutation: list[int]) -> Lengths:
    """The same with the links renumbered."""
    moved = ((permutation[i], permutation[j], own) for i, j, own in lengths)
    return tuple(sorted((min(i, j), max(i, j), own) for i, j, own in moved))


def _joints(lengths: Lengths, first: int) -> Joints:
    joints: list[tuple[int, int]] = []
    for i, j, own in lengths:
        for binaries in own:
            path = [i, *range(first, first + binaries), j]
            first += binaries
            joints += itertools.pairwise(path)
    return tuple(joints)


def _has_rigid_part(joints: Joints, links: int) -> bool:
    """Whether some links with the joints between them have no freedom among themselves."""
    part = (np.arange(1 << links)[:, None] >> np.arange(links)) & 1
    size, between = part.sum(axis=1), np.zeros(len(part), np.int64)
    for i, j in joints:
        between += part[:, i] & part[:, j]
    return bool(((3 * (size - 1) - 2 * between < 1) & (size > 1)).any())
