"""Bodies that are measured on their meshes, because their sections have no simple outlines."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from service.parts.geometry.meshes import SECTION_SAG, list_regions
from service.parts.geometry.regions import Region, measure_area

if TYPE_CHECKING:
    from manifold3d import Manifold

VOLUME_SAG_SHARE = 6.5e-5
"""Maximum sag of the finer mesh of a volume, as a share of the body's size: all larger circles then have more edges
than the minimum."""


class MeshedBody(ABC):
    """A body whose mesh, within a sag of it, has its volume, its shadow and its sections."""

    @abstractmethod
    def make_mesh(self, sag: float) -> Manifold:
        """Return the mesh within a sag of the body."""

    @cached_property
    def _mesh(self) -> Manifold:
        return self.make_mesh(SECTION_SAG)

    @property
    def low(self) -> float:
        """Height of the lowest point."""
        return float(self._mesh.bounding_box()[2])

    @property
    def high(self) -> float:
        """Height of the highest point."""
        return float(self._mesh.bounding_box()[5])

    @cached_property
    def volume(self) -> float:
        """Volume, cubic millimetres: of two meshes, extrapolated to no sag, to which the error is proportional."""
        low, high = np.reshape(self._mesh.bounding_box(), (2, 3))
        sag = min(SECTION_SAG, VOLUME_SAG_SHARE * float((high - low).max()))
        fine = self._mesh if sag == SECTION_SAG else self.make_mesh(sag)
        return float((4.0 * fine.volume() - self.make_mesh(4.0 * sag).volume()) / 3.0)

    @cached_property
    def region(self) -> Region:
        """Shadow of the body."""
        return max(list_regions(self._mesh.project()), key=lambda region: measure_area(region.outer))

    def cut_between(self, low: float, high: float) -> tuple[Region, ...]:
        """Return the section half-way between two heights."""
        return list_regions(self._mesh.slice(0.5 * (low + high)))
