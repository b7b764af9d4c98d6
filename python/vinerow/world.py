"""Terrain, rows, maps and vehicles: plain values with arrays, copied from the run."""

from __future__ import annotations

from typing import NamedTuple

import numpy

from .arrays import Array


class Terrain(NamedTuple):
    """Heights on a regular grid; between them two flat triangles per cell, split from (i, j) to (i+1, j+1).

    heights: (rows, columns), m; rows go north, columns east
    cell_m: distance between samples
    corner: (x, y) of heights[0, 0], m
    """

    heights: Array
    cell_m: float
    corner: tuple[float, float]

    def height_at(self, x: Array, y: Array) -> Array:
        """Heights of the triangle surface; outside the grid the nearest edge continues."""
        rows, columns = self.heights.shape
        u = numpy.clip((numpy.asarray(x) - self.corner[0]) / self.cell_m, 0.0, columns - 1.0)
        v = numpy.clip((numpy.asarray(y) - self.corner[1]) / self.cell_m, 0.0, rows - 1.0)
        i = numpy.minimum(u.astype(int), columns - 2)
        j = numpy.minimum(v.astype(int), rows - 2)
        du, dv = u - i, v - j
        h = self.heights.astype(float)
        h00, h10, h01, h11 = h[j, i], h[j, i + 1], h[j + 1, i], h[j + 1, i + 1]
        east = h00 + du * (h10 - h00) + dv * (h11 - h10)  # the triangle with (i+1, j), where du >= dv
        north = h00 + dv * (h01 - h00) + du * (h11 - h01)
        return numpy.where(du >= dv, east, north)


class Row(NamedTuple):
    """A row of plants: its centre line (n, 3) at the ground, and its canopy."""

    id: int
    line: Array
    canopy_width_m: float
    canopy_base_m: float
    canopy_top_m: float


class Alley(NamedTuple):
    """Free strip between two rows: its centre line (n, 3) and its width."""

    id: int
    line: Array
    width_m: float


class RowMesh(NamedTuple):
    """Hull of a row on a map: vertices (n, 3), triangles (m, 3) of indices."""

    row: int
    vertices: Array
    triangles: Array


class Grid(NamedTuple):
    """Occupied cells (rows, columns); corner is that of cells[0, 0]."""

    cells: Array
    cell_m: float
    corner: tuple[float, float]


class SpawnPoint(NamedTuple):
    """A named start of a vehicle."""

    name: str
    position: tuple[float, float]
    yaw: float


class World(NamedTuple):
    """The true world. `terrain` is None if the ground is a mesh."""

    name: str
    terrain: Terrain | None
    rows: list[Row]
    alleys: list[Alley]
    boundary: Array
    spawn_points: list[SpawnPoint]
    notes: list[str]


class Map(NamedTuple):
    """What a vehicle knows of the world. `terrain` is None if the map uses the true one."""

    rows: list[Row]
    alleys: list[Alley]
    boundary: Array
    meshes: list[RowMesh]
    grid: Grid | None
    terrain: Terrain | None


class Actuator(NamedTuple):
    """An entry of a vehicle's actuator vector."""

    name: str
    unit: str
    min: float
    max: float


class Wheels(NamedTuple):
    """Wheels with commanded speeds; `effective_track_m` (skid steering) is 0 if unknown."""

    track_m: float
    wheel_base_m: float
    wheel_radius_m: float
    wheel_speed_limit_radps: float
    effective_track_m: float


class Vehicle(NamedTuple):
    """A vehicle as controllers know it. `footprint` (n, 2) is its outline in its own frame; `wheels` is None without any."""

    name: str
    type: str
    actuators: list[Actuator]
    mass_kg: float
    max_speed_mps: float | None
    min_turning_radius_m: float | None
    footprint: Array
    wheels: Wheels | None
