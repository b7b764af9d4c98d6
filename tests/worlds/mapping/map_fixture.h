#pragma once
/// Worlds with the scene that map makers ask, built once, and checks of row meshes.

#include <Eigen/Geometry>
#include <map>
#include <set>
#include <utility>

#include "engine/api/forward.h"
#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/random.h"
#include "engine/physics/physics_world.h"
#include "tests/worlds/world_fixture.h"

namespace vinerow::test {

struct SurveyedWorld {
  std::unique_ptr<WorldModel> model;
  std::unique_ptr<physics::PhysicsWorld> physics;

  MapContext context(std::uint64_t seed = 1) const {
    MapContext context;
    context.vehicle = "rover";
    context.part = "rover.map";
    context.seed = seed;
    context.world = model.get();
    context.scene = &physics->scene();
    return context;
  }
};

/// "vineyard": 4 rows of 30 m with gaps; "orchard": 3 rows of 20 m of trees; "surveyed": Riseholme.
inline const SurveyedWorld& surveyed_world(const std::string& type) {
  static std::map<std::string, SurveyedWorld> worlds;
  SurveyedWorld& world = worlds[type];
  if (world.model) return world;
  ParameterSet parameters = world_parameters(type);
  parameters.set("occupancy_cell_m", 0.1);
  if (type == "vineyard") {
    parameters.set("row_count", 4.0).set("row_length_m", 30.0).set("leaf_cards_per_m", 10.0);
    parameters.set("missing_vine_share", 0.08);
  } else if (type == "orchard") {
    parameters.set("plant_rows", 3.0).set("row_length_m", 20.0).set("leaf_cards_per_tree", 20.0);
  } else {
    parameters.set("survey_file", riseholme_file()).set("leaf_cards_per_m", 10.0);
  }
  world.model = make_world(type, parameters);
  world.physics = std::make_unique<physics::PhysicsWorld>(physics::PhysicsSettings{}, *world.model);
  return world;
}

inline ParameterSet map_parameters(const std::string& type) {
  return ParameterSet(world_registry().spec(PartKind::kMap, type).parameters, type);
}

/// Volume within a mesh; adds test failures where it is not closed.
inline double closed_volume_m3(const TriangleMesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  double volume_m3 = 0.0;
  const Eigen::Vector3d o = mesh.vertices.at(0).cast<double>();
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_TRUE(edges.insert({t[k], t[(k + 1) % 3]}).second) << "an edge is walked twice";
    }
    const Eigen::Vector3d a = mesh.vertices.at(t[0]).cast<double>() - o;
    const Eigen::Vector3d b = mesh.vertices.at(t[1]).cast<double>() - o;
    const Eigen::Vector3d c = mesh.vertices.at(t[2]).cast<double>() - o;
    volume_m3 += a.dot(b.cross(c)) / 6.0;
  }
  for (const auto& [a, b] : edges) EXPECT_TRUE(edges.count({b, a})) << "an edge is open";
  return volume_m3;
}

/// A point on a facet that does not look along its row, and how far the canopy is from there along
/// the normal; found from both sides of the facet, nearest first.
struct SurfaceSample {
  Eigen::Vector3d p_W, normal_W;
  double error_m;  ///< > 0: the canopy lies outside the map
};

/// `count` points, evenly over area. Points with no canopy within 0.4 m are left out.
inline std::vector<SurfaceSample> sample_surface(const SurveyedWorld& world, const RowMap& map,
                                                 int count, RandomStream random) {
  struct Facet {
    Eigen::Vector3d a, ab, ac, normal;
    double area_until_m2;
  };
  std::vector<Facet> facets;
  double area_m2 = 0.0;
  for (const RowMesh& mesh : map.meshes) {
    const PlantRow* row = nullptr;
    for (const PlantRow& r : map.rows) row = r.id == mesh.row ? &r : row;
    const Eigen::Vector3d ahead = (row->line_W.back() - row->line_W.front()).normalized();
    for (const auto& t : mesh.mesh_W.triangles) {
      Facet facet;
      facet.a = mesh.mesh_W.vertices[t[0]].cast<double>();
      facet.ab = mesh.mesh_W.vertices[t[1]].cast<double>() - facet.a;
      facet.ac = mesh.mesh_W.vertices[t[2]].cast<double>() - facet.a;
      const Eigen::Vector3d across = facet.ab.cross(facet.ac);
      facet.normal = across.normalized();
      if (!(std::abs(facet.normal.dot(ahead)) <= 0.7)) continue;
      facet.area_until_m2 = area_m2 += 0.5 * across.norm();
      facets.push_back(facet);
    }
  }
  std::vector<SurfaceSample> samples;
  for (int k = 0; k < count; ++k) {
    const double at_m2 = random.uniform(0.0, area_m2);
    const auto facet =
        std::lower_bound(facets.begin(), facets.end() - 1, at_m2,
                         [](const Facet& f, double area) { return f.area_until_m2 < area; });
    double v = random.uniform(), w = random.uniform();
    if (v + w > 1.0) v = 1.0 - v, w = 1.0 - w;
    const Eigen::Vector3d p = facet->a + v * facet->ab + w * facet->ac, &n = facet->normal;
    const auto& scene = world.physics->scene();
    constexpr SurfaceMask kCanopy = mask_of(SurfaceClass::kCanopy);
    const auto out = scene.cast_ray(p, n, 0.4, kCanopy), in = scene.cast_ray(p, -n, 0.4, kCanopy);
    if (!out && !in) continue;
    const double out_m = out ? out->distance_m : 1.0, in_m = in ? in->distance_m : 1.0;
    samples.push_back({p, n, out_m < in_m ? out_m : -in_m});
  }
  return samples;
}

inline double rms_of(const std::vector<SurfaceSample>& samples) {
  double sum = 0.0;
  for (const SurfaceSample& sample : samples) sum += sample.error_m * sample.error_m;
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

}  // namespace vinerow::test
