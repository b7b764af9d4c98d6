#!/usr/bin/env python3
"""Terrain, rows, maps and vehicles as arrays.

    world_test.py VINEROW
"""

import pathlib
import sys
import unittest

import numpy

import vinerow

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIOS = ROOT / "assets" / "scenarios"


class World(unittest.TestCase):
    def test_rows_are_those_of_the_scenario(self):
        scenario = {
            "vinerow": 1, "name": "rows", "duration_s": 1,
            "world": {"type": "vineyard", "row_count": 3, "row_length_m": 20, "pitch_m": 2.5, "row_bearing_deg": 90,
                      "leaf_cards_per_m": 10, "plant_variants": 1},
            "vehicles": {"rover": {"type": "diff_drive_rover", "spawn": {"alley": 0}}},
        }
        with vinerow.open(scenario) as session:
            world = session.world()
            self.assertEqual(len(world.rows), 3)
            self.assertEqual(len(world.alleys), len(session.map("rover").alleys))
            for row in world.rows:
                length = numpy.linalg.norm(numpy.diff(row.line[:, :2], axis=0), axis=1).sum()
                self.assertAlmostEqual(length, 20.0, delta=0.05)
            gaps = numpy.diff(sorted(row.line[:, 1].mean() for row in world.rows))
            numpy.testing.assert_allclose(gaps, 2.5, atol=1e-6)
            self.assertEqual({alley.width_m for alley in world.alleys if 0 < alley.id < 3}, {2.5})

    def test_terrain_is_where_rows_and_the_rover_stand(self):
        with vinerow.open(SCENARIOS / "vineyard_rover.yaml", {"criteria": []}) as session:
            terrain = session.world().terrain
            self.assertEqual(terrain.heights.ndim, 2)
            for row in session.world().rows:
                heights = terrain.height_at(row.line[:, 0], row.line[:, 1])
                numpy.testing.assert_allclose(heights, row.line[:, 2], atol=2e-3)
            session.step(1.0)
            x, y, z = session.signal("rover/truth")["pose"].position
            self.assertLess(abs(z - terrain.height_at(x, y)), 0.5)

    def test_a_vehicles_map_has_hulls(self):
        with vinerow.open(SCENARIOS / "localisation_sensors_4.yaml", {"criteria": []}) as session:
            row_map = session.map(session.vehicles[0])
            self.assertGreater(len(row_map.meshes), 0)
            for mesh in row_map.meshes:
                self.assertEqual(mesh.vertices.shape[1], 3)
                self.assertLess(mesh.triangles.max(), len(mesh.vertices))
            with self.assertRaisesRegex(vinerow.ConfigError, "no vehicle 'rovr'"):
                session.map("rovr")

    def test_actuators(self):
        with vinerow.open(ROOT / "docs" / "examples" / "session" / "free_rover.yaml") as session:
            rover = session.vehicle("rover")
            self.assertEqual(rover.type, "diff_drive_rover")
            self.assertEqual([a.name for a in rover.actuators][0], "wheel_fl_speed_radps")
            self.assertTrue(all(a.min < 0 < a.max for a in rover.actuators))
            self.assertEqual(rover.footprint.shape[1], 2)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
