#include "tools/replay/replay_index.h"

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"

namespace vinerow::tools {
namespace {

using nlohmann::json;

/// Lines as lists of x, y, z to a millimetre.
json lines_of(const std::vector<Eigen::Vector3d>& line) {
  json points = json::array();
  for (const Eigen::Vector3d& p : line) {
    for (int c = 0; c < 3; ++c) points.push_back(1e-3 * std::round(1e3 * p[c]));
  }
  return points;
}

json ground_index(const WorldModel& world) {
  json rows = json::array(), alleys = json::array();
  Eigen::AlignedBox3d box;
  double top_m = 0.0;
  for (const PlantRow& row : world.rows->rows) {
    top_m = std::max(top_m, row.canopy_top_m);
    rows.push_back(lines_of(row.line_W));
    for (const Eigen::Vector3d& p : row.line_W) {
      box.extend(p).extend(p + Eigen::Vector3d(0, 0, row.canopy_top_m));
    }
  }
  for (const Alley& alley : world.rows->alleys) alleys.push_back(lines_of(alley.line_W));
  json index = {{"rows", rows}, {"alleys", alleys}, {"canopy_top_m", top_m}};
  if (!box.isEmpty()) index["row_box"] = {lines_of({box.min()}), lines_of({box.max()})};
  if (world.terrain) {
    const HeightField& field = *world.terrain;
    const auto [low, high] = std::minmax_element(field.heights_m.begin(), field.heights_m.end());
    const Eigen::Vector2d far = field.corner_W + Eigen::Vector2d(field.width_m(), field.depth_m());
    index["terrain_box"] = {{field.corner_W.x(), field.corner_W.y(), *low},
                            {far.x(), far.y(), *high}};
  }
  return index;
}

}  // namespace

json replay_index(const std::string& name, const WorldModel& world,
                  const ReplayTextures& textures) {
  return {{"name", name},
          {"ground", ground_index(world)},
          {"light", replay_light(world.daylight)},
          {"textures", textures.index}};
}

}  // namespace vinerow::tools
