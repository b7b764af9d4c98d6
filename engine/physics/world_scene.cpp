#include "engine/physics/world_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "engine/physics/check_world.h"

namespace vinerow::physics {
namespace {

using Eigen::Vector3d;

constexpr SurfaceMask kRigidMask =
    kAllSurfaces & ~mask_of(SurfaceClass::kCanopy) & ~mask_of(SurfaceClass::kWire);

/// Calls `use(x0, y0, x1, y1)` with the horizontal bounds of every triangle that may carry a wheel.
template <class Use>
void for_each_carrying_triangle(const WorldModel& world, Use&& use) {
  for (const MeshInstance& instance : world.meshes) {
    if (!carries_wheels(instance)) continue;
    const Eigen::Matrix3d R_WM = instance.X_WM.q.toRotationMatrix();
    for (const auto& triangle : instance.mesh->triangles) {
      Eigen::AlignedBox2d plan;
      for (const std::uint32_t v : triangle) {
        const Vector3d p_W = R_WM * instance.mesh->vertices[v].cast<double>() + instance.X_WM.p;
        plan.extend(p_W.head<2>());
      }
      use(plan);
    }
  }
}

std::optional<HeightFieldRay> make_terrain(const WorldModel& world) {
  std::optional<HeightFieldRay> terrain;
  if (world.terrain) terrain.emplace(*world.terrain);
  return terrain;
}

}  // namespace

RigidMap::RigidMap(const WorldModel& world) {
  Eigen::AlignedBox2d all;
  for_each_carrying_triangle(world, [&](const Eigen::AlignedBox2d& plan) { all.extend(plan); });
  if (all.isEmpty()) return;
  constexpr double kMaxCells = 2048.0;  // along an axis: 0.5 MB of bits
  corner_W_ = all.min();
  cell_m_ = std::max(1.0, all.sizes().maxCoeff() / kMaxCells);
  columns_ = static_cast<int>(all.sizes().x() / cell_m_) + 1;
  rows_ = static_cast<int>(all.sizes().y() / cell_m_) + 1;
  marked_.assign(static_cast<std::size_t>(columns_) * rows_, false);
  for_each_carrying_triangle(world, [&](const Eigen::AlignedBox2d& plan) {
    // Single precision of the ray caster moves triangles by less than this.
    constexpr double kMargin_m = 1e-3;
    mark(plan.min().x() - kMargin_m, plan.min().y() - kMargin_m, plan.max().x() + kMargin_m,
         plan.max().y() + kMargin_m);
  });
}

int RigidMap::column_of(double x) const {
  return static_cast<int>(
      std::floor(std::clamp((x - corner_W_.x()) / cell_m_, -1.0, columns_ + 0.0)));
}

int RigidMap::row_of(double y) const {
  return static_cast<int>(std::floor(std::clamp((y - corner_W_.y()) / cell_m_, -1.0, rows_ + 0.0)));
}

void RigidMap::mark(double x0, double y0, double x1, double y1) {
  const int i1 = std::min(column_of(x1), columns_ - 1);
  const int j1 = std::min(row_of(y1), rows_ - 1);
  for (int j = std::max(row_of(y0), 0); j <= j1; ++j) {
    for (int i = std::max(column_of(x0), 0); i <= i1; ++i) {
      marked_[static_cast<std::size_t>(j) * columns_ + i] = true;
    }
  }
}

bool RigidMap::any_near(double x0, double y0, double x1, double y1) const {
  if (marked_.empty()) return false;
  const int i1 = std::min(column_of(std::max(x0, x1)), columns_ - 1);
  const int j1 = std::min(row_of(std::max(y0, y1)), rows_ - 1);
  for (int j = std::max(row_of(std::min(y0, y1)), 0); j <= j1; ++j) {
    for (int i = std::max(column_of(std::min(x0, x1)), 0); i <= i1; ++i) {
      if (marked_[static_cast<std::size_t>(j) * columns_ + i]) return true;
    }
  }
  return false;
}

WorldScene::WorldScene(const WorldModel& world)
    : terrain_(make_terrain(world)),
      trees_(std::make_shared<MeshTrees>()),
      rays_(world, terrain(), is_seen_by_rays, trees_),
      mesh_distance_(world, trees_),
      rigid_map_(world) {
  // The ray caster's single precision moves triangles by far less.
  constexpr double kMargin_m = 1.0;
  for (const MeshInstance& instance : world.meshes) {
    if (!is_seen_by_rays(instance) || (mask_of(instance.surface) & kGroundMask) == 0) continue;
    const Vector3d up_M = instance.X_WM.q.conjugate() * Vector3d::UnitZ();
    for (const Eigen::Vector3f& v : instance.mesh->vertices) {
      const double height_m = up_M.dot(v.cast<double>()) + instance.X_WM.p.z();
      meshes_top_m_ = std::max(meshes_top_m_, height_m + kMargin_m);
      meshes_bottom_m_ = std::min(meshes_bottom_m_, height_m - kMargin_m);
    }
  }
}

std::optional<RayHit> WorldScene::cast_ray(const Vector3d& p_W, const Vector3d& dir_W,
                                           double max_distance_m, SurfaceMask mask) const {
  return rays_.cast_ray(p_W, dir_W, max_distance_m, mask);
}

void WorldScene::cast_rays(std::span<const SceneRay> rays, std::span<std::optional<RayHit>> hits,
                           SurfaceMask mask) const {
  rays_.cast_rays(rays, hits, mask);
}

void WorldScene::find_blocked(std::span<const SceneRay> rays, std::span<bool> blocked,
                              SurfaceMask mask) const {
  rays_.find_blocked(rays, blocked, mask);
}

std::optional<double> WorldScene::ground_height_m(double x, double y, double z_from) const {
  std::optional<double> highest;
  if (terrain_ && terrain_->field().contains(x, y)) {
    const double height = terrain_->field().height_m(x, y);
    if (height <= z_from) highest = height;
  }
  const double top_m = std::min(z_from, meshes_top_m_);
  const double reach_m = top_m - (highest ? *highest : meshes_bottom_m_);
  if (!(reach_m > 0.0)) return highest;
  if (const auto hit =
          rays_.meshes().cast({x, y, top_m}, -Vector3d::UnitZ(), reach_m, kGroundMask)) {
    highest = top_m - hit->distance_m;
  }
  return highest;
}

double WorldScene::distance_to_box_m(const Pose& X_WBox, const Vector3d& half_extents_m,
                                     double max_distance_m, SurfaceMask mask) const {
  return mesh_distance_.to_box_m(X_WBox, half_extents_m, max_distance_m, mask);
}

void WorldScene::prepare() const {
  rays_.meshes().prepare();
  trees_->prepare();
}

std::optional<RayHit> WorldScene::probe_rigid(const Vector3d& p_W, const Vector3d& dir_W,
                                              double max_distance_m) const {
  std::optional<RayHit> first;
  double reach_m = max_distance_m;
  if (terrain_) {
    if (const auto hit = terrain_->cast(p_W, dir_W, reach_m)) {
      first = RayHit{hit->distance_m, hit->normal_W, SurfaceClass::kTerrain, -1};
      reach_m = hit->distance_m;
    }
  }
  const Vector3d end_W = p_W + reach_m * dir_W;
  if (!rigid_map_.any_near(p_W.x(), p_W.y(), end_W.x(), end_W.y())) return first;
  if (const std::optional<RayHit> hit = rays_.meshes().cast(p_W, dir_W, reach_m, kRigidMask)) {
    first = hit;
  }
  return first;
}

}  // namespace vinerow::physics
