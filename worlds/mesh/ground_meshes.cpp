#include "worlds/mesh/ground_meshes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "engine/api/mesh.h"
#include "engine/api/world_model.h"

namespace vinerow::worlds {
namespace {

constexpr double kMinSide_m = 5.0;
constexpr double kMinShare = 0.5;       ///< of a box that ground covers
constexpr double kMaxSteepShare = 0.5;  ///< steep surface per covered area
constexpr double kSteepNormal_z = 0.5;  ///< cos 60 deg

/// An object seen from above.
struct Plan {
  Eigen::AlignedBox2d box;
  double up_m2 = 0.0, down_m2 = 0.0;  ///< covered by faces that look up, down
  double steep_m2 = 0.0;              ///< surface that does neither

  /// Files with their faces the wrong way round are ground all the same.
  double covered_m2() const { return std::max(up_m2, down_m2); }
};

double area_m2(const Eigen::AlignedBox2d& box) {
  return box.isEmpty() ? 0.0 : box.sizes().prod();
}

void add_to(Plan& plan, const MeshInstance& instance) {
  const Eigen::Matrix3d R_WM = instance.X_WM.q.toRotationMatrix();
  for (const auto& [i, j, k] : instance.mesh->triangles) {
    const auto corner = [&](std::uint32_t v) -> Eigen::Vector3d {
      return R_WM * instance.mesh->vertices[v].cast<double>() + instance.X_WM.p;
    };
    const Eigen::Vector3d a = corner(i), b = corner(j), c = corner(k);
    for (const Eigen::Vector3d& p : {a, b, c}) plan.box.extend(p.head<2>().eval());
    const Eigen::Vector3d twice = (b - a).cross(c - a);  // along the normal, two areas long
    const double area = 0.5 * twice.norm(), in_plan = 0.5 * twice.z();
    if (std::abs(in_plan) < kSteepNormal_z * area) {
      plan.steep_m2 += area;
    } else {
      (in_plan > 0.0 ? plan.up_m2 : plan.down_m2) += std::abs(in_plan);
    }
  }
}

bool can_be_ground(const Plan& plan) {
  if (plan.box.isEmpty() || plan.box.sizes().minCoeff() < kMinSide_m) return false;
  return plan.steep_m2 <= kMaxSteepShare * plan.covered_m2() &&
         plan.covered_m2() >= kMinShare * area_m2(plan.box);
}

}  // namespace

std::vector<std::size_t> find_ground(const std::vector<MeshObject>& objects,
                                     const WorldModel& world) {
  std::vector<std::size_t> ground;
  Eigen::AlignedBox2d everything;
  double covered_m2 = 0.0;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    Plan plan;
    for (std::size_t m = objects[i].begin; m < objects[i].end; ++m) add_to(plan, world.meshes[m]);
    everything.extend(plan.box);
    if (!can_be_ground(plan)) continue;
    ground.push_back(i);
    covered_m2 += plan.covered_m2();
  }
  if (covered_m2 < kMinShare * area_m2(everything)) ground.clear();
  return ground;
}

}  // namespace vinerow::worlds
