#include "worlds/parts/leaf_area.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/api/wind.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/math/polyline.h"

namespace vinerow::worlds {
namespace {

double length_m(const std::vector<Eigen::Vector3d>& line) {
  return SpacePolyline(line).length_m();
}

/// Ground that belongs to the rows, m2.
double ground_of_rows_m2(const RowMap& map) {
  double rows_m = 0.0, alleys_m = 0.0, alleys_m2 = 0.0, canopy_m2 = 0.0;
  for (const PlantRow& row : map.rows) {
    rows_m += length_m(row.line_W);
    canopy_m2 += length_m(row.line_W) * row.canopy_width_m;
  }
  for (const Alley& alley : map.alleys) {
    alleys_m += length_m(alley.line_W);
    alleys_m2 += length_m(alley.line_W) * alley.width_m;
  }
  // A row on its own has the ground below its leaves.
  return alleys_m > 0.0 ? rows_m * alleys_m2 / alleys_m : canopy_m2;
}

struct LeafSum {
  double area_m2 = 0.0;
  double width_area_m3 = 0.0;  ///< leaf width times area
};

LeafSum sum_leaves(const WorldModel& world) {
  LeafSum sum;
  std::map<const TriangleMesh*, double> volumes_m3;  // trees share hulls
  for (const MeshInstance& instance : world.meshes) {
    if (!instance.foliage) continue;
    const auto [known, is_new] = volumes_m3.try_emplace(instance.mesh.get(), 0.0);
    if (is_new) known->second = enclosed_volume_m3(*instance.mesh);
    const double area_m2 = known->second * instance.foliage->area_density_m2pm3;
    sum.area_m2 += area_m2;
    sum.width_area_m3 += area_m2 * instance.foliage->leaf_width_m;
  }
  return sum;
}

/// What a scenario may give at most, so that vehicles accept it.
double most_shelter() {
  for (const ParameterSpec& spec : wind_table().specs()) {
    if (spec.name == "shelter") return spec.max;
  }
  throw std::logic_error("the wind has no parameter 'shelter'");
}

}  // namespace

double enclosed_volume_m3(const TriangleMesh& mesh) {
  double six_volumes = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>();
    six_volumes += a.dot(b.cross(c));
  }
  return std::abs(six_volumes) / 6.0;
}

Foliage foliage_in(const TriangleMesh& hull, double leaf_area_m2, double leaf_width_m) {
  const double volume_m3 = enclosed_volume_m3(hull);
  return {volume_m3 > 0.0 ? leaf_area_m2 / volume_m3 : 0.0, leaf_width_m};
}

double leaf_area_index(const WorldModel& world) {
  const double ground_m2 = ground_of_rows_m2(*world.rows);
  return ground_m2 > 0.0 ? sum_leaves(world).area_m2 / ground_m2 : 0.0;
}

double shelter_attenuation(double leaf_area_index, double height_m, double leaf_width_m) {
  return 0.28 * std::cbrt(leaf_area_index * leaf_area_index * height_m / leaf_width_m);
}

void settle_shelter(WorldModel& world) {
  if (!world.wind.shelter_by_leaves) return;
  const auto has = [&](auto&& is_meant) {
    return std::any_of(world.meshes.begin(), world.meshes.end(), is_meant);
  };
  if (!has([](const MeshInstance& mesh) { return mesh.foliage.has_value(); })) {
    const bool has_canopy = has([](const MeshInstance& mesh) {
      return mesh.surface == SurfaceClass::kCanopy && mesh.collides;
    });
    if (has_canopy) {
      throw ConfigError(
          "wind: shelter_by_leaves = true, but the world does not know the leaf area of its "
          "plants: "
          "give them leaves one by one (vines, leaves) or give wind.shelter");
    }
    return;  // bare plants
  }
  const LeafSum leaves = sum_leaves(world);
  double top_m = 0.0, rows_m = 0.0;
  for (const PlantRow& row : world.rows->rows) {
    top_m += length_m(row.line_W) * row.canopy_top_m;
    rows_m += length_m(row.line_W);
  }
  if (leaves.area_m2 <= 0.0 || rows_m <= 0.0) return;
  // A denser canopy leaves less than a twelfth of the wind at half its height anyway.
  const double attenuation = shelter_attenuation(leaf_area_index(world), top_m / rows_m,
                                                 leaves.width_area_m3 / leaves.area_m2);
  world.wind.shelter_attenuation = std::min(attenuation, most_shelter());
  world.wind.shelter_by_leaves = false;  // from here on it is given
}

}  // namespace vinerow::worlds
