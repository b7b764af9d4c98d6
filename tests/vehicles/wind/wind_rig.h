#pragma once
/// A probe in a world of a few lines, without physics.

#include <optional>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "tests/support/plain_scene.h"
#include "vehicles/parts/wind_probe.h"

namespace vinerow::vehicles::test {

struct WindRig {
  explicit WindRig(const Wind& wind, std::uint64_t seed = 1, const RowMap& rows = {},
                   const char* vehicle = "drone") {
    world.wind = wind;
    world.rows = rows;
    probe.emplace(world, scene, RandomStream(seed, vehicle, "wind"));
  }
  /// Stands still. @param dt  since the last sample
  const Eigen::Vector3d& sample(Duration dt, const Eigen::Vector3d& p_W) {
    const Eigen::Vector3d& wind = probe->sample(now, p_W, Eigen::Vector3d::Zero(), dt);
    now = now + dt;
    return wind;
  }

  WorldModel world;
  vinerow::test::PlainScene scene;
  std::optional<WindProbe> probe;
  Time now;
};

/// From the west, so that u is along x, v along y, w along z.
inline Wind west_wind(double speed_mps) {
  Wind wind;
  wind.mean_speed_mps = speed_mps;
  wind.from_azimuth_rad = 1.5 * 3.14159265358979323846;
  wind.height_law = WindHeightLaw::kUniform;
  return wind;
}

/// Rows along x, 2.5 m apart, 60 m long, alleys between them; canopy 2 m high.
inline RowMap five_rows() {
  RowMap map;
  for (int i = 0; i < 5; ++i) {
    map.rows.push_back({i, {{-30, 2.5 * i, 0}, {30, 2.5 * i, 0}}, 0.6, 0.5, 2.0});
  }
  for (int i = 0; i < 4; ++i) {
    map.alleys.push_back({i, {{-30, 2.5 * i + 1.25, 0}, {30, 2.5 * i + 1.25, 0}}, 2.5});
  }
  return map;
}

}  // namespace vinerow::vehicles::test
