#include "engine/physics/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/api/height_field.h"
#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "engine/physics/triangle_box.h"

namespace vinerow::physics {
namespace {

using Eigen::Vector3d;
using Tree = MeshDistance::Tree;

Eigen::AlignedBox3f calc_bounds_W(const MeshInstance& instance) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3f& v : instance.mesh->vertices) {
    bounds.extend(instance.X_WM * v.cast<double>());
  }
  // Rounded outwards: the tree's bounds must always contain the triangles.
  const Vector3d margin =
      Vector3d::Constant(1e-5) + 1e-6 * bounds.max().cwiseAbs().cwiseMax(bounds.min().cwiseAbs());
  return {(bounds.min() - margin).cast<float>(), (bounds.max() + margin).cast<float>()};
}

/// Oriented box with its own frame O, where it is |x_i| <= half_extents_m_i, relative to a tree's
/// frame T.
class QueryBox {
 public:
  QueryBox(const Pose& X_OT, const Vector3d& half_extents_m)
      : R_OT_(X_OT.q.toRotationMatrix()),
        R_abs_(R_OT_.cwiseAbs()),
        p_OT_(X_OT.p),
        half_extents_m_(half_extents_m) {}

  Vector3d to_O(const Vector3d& p_T) const { return R_OT_ * p_T + p_OT_; }

  /// Lower bound of the squared distance between the box and one of the tree: their separation
  /// along the axes of O.
  double operator()(const Tree::Box& box_T) const {
    const Vector3d centre = 0.5 * (box_T.min() + box_T.max()).cast<double>();
    const Vector3d half = 0.5 * (box_T.max() - box_T.min()).cast<double>();
    const Vector3d gap = to_O(centre).cwiseAbs() - half_extents_m_ - R_abs_ * half;
    return gap.cwiseMax(0.0).squaredNorm();
  }
  /// The same of two boxes, one in each half of the processor's registers.
  Eigen::Array2d operator()(const Tree::Box& a_T, const Tree::Box& b_T) const {
    Eigen::Array2d centre[3], half[3];
    for (int k = 0; k < 3; ++k) {
      const Eigen::Array2d low(a_T.min()[k], b_T.min()[k]), high(a_T.max()[k], b_T.max()[k]);
      centre[k] = 0.5 * (low + high);
      half[k] = 0.5 * (high - low);
    }
    Eigen::Array2d sum2 = Eigen::Array2d::Zero();
    for (int i = 0; i < 3; ++i) {
      const Eigen::Array2d place =
          R_OT_(i, 0) * centre[0] + R_OT_(i, 1) * centre[1] + R_OT_(i, 2) * centre[2] + p_OT_[i];
      const Eigen::Array2d reach =
          R_abs_(i, 0) * half[0] + R_abs_(i, 1) * half[1] + R_abs_(i, 2) * half[2];
      sum2 += (place.abs() - half_extents_m_[i] - reach).max(0.0).square();
    }
    return sum2;
  }

 private:
  Eigen::Matrix3d R_OT_, R_abs_;
  Vector3d p_OT_, half_extents_m_;
};

void lower_to(double candidate2, const Vector3d& a, const Vector3d& b, const Vector3d& c,
              const Vector3d& h, double& best2) {
  if (candidate2 < best2) best2 = std::min(best2, triangle_box_distance2(a, b, c, h));
}

/// Terrain cells under the box, widened by the search radius.
void search_terrain(const HeightField& field, const Pose& X_WBox, const Vector3d& h,
                    double& best2) {
  const Eigen::Matrix3d R_WO = X_WBox.q.toRotationMatrix();
  const Vector3d reach = R_WO.cwiseAbs() * h + Vector3d::Constant(std::sqrt(best2));
  const auto index = [&](double x, int last) {
    return static_cast<int>(
        std::clamp(std::floor(x / field.cell_m), 0.0, static_cast<double>(last)));
  };
  const Eigen::Vector2d low = (X_WBox.p - reach).head<2>() - field.corner_W;
  const Eigen::Vector2d high = (X_WBox.p + reach).head<2>() - field.corner_W;
  if (high.x() < 0.0 || high.y() < 0.0 || low.x() > field.width_m() || low.y() > field.depth_m()) {
    return;
  }
  const Pose X_OW = X_WBox.inverse();
  const Eigen::Matrix3d R_OW = R_WO.transpose();
  const auto point_O = [&](int i, int j) {
    const double z = field.heights_m[static_cast<std::size_t>(j) * field.columns + i];
    return Vector3d(R_OW * Vector3d(field.corner_W.x() + i * field.cell_m,
                                    field.corner_W.y() + j * field.cell_m, z) +
                    X_OW.p);
  };
  const int last_i = index(high.x(), field.columns - 2);
  const int last_j = index(high.y(), field.rows - 2);
  for (int j = index(low.y(), field.rows - 2); j <= last_j; ++j) {
    for (int i = index(low.x(), field.columns - 2); i <= last_i; ++i) {
      const Vector3d p00 = point_O(i, j), p10 = point_O(i + 1, j);
      const Vector3d p01 = point_O(i, j + 1), p11 = point_O(i + 1, j + 1);
      lower_to(triangle_box_bound2(p00, p10, p11, h), p00, p10, p11, h, best2);
      lower_to(triangle_box_bound2(p00, p11, p01, h), p00, p11, p01, h, best2);
    }
  }
}

}  // namespace

MeshDistance::MeshDistance(const WorldModel& world, std::shared_ptr<MeshTrees> trees)
    : world_(world), trees_(std::move(trees)) {
  std::vector<Eigen::AlignedBox3f> boxes;
  for (const MeshInstance& instance : world.meshes) {
    if (!instance.collides) continue;
    entries_.push_back({&instance, &trees_->of(*instance.mesh)});
    boxes.push_back(calc_bounds_W(instance));
  }
  instances_ = Tree(boxes);
}

double MeshDistance::to_box_m(const Pose& X_WBox, const Vector3d& h, double max_distance_m,
                              SurfaceMask mask) const {
  double best2 = max_distance_m * max_distance_m;
  const Pose X_OW = X_WBox.inverse();
  instances_.search(QueryBox(X_OW, h), best2, [&](std::uint32_t item) {
    const Entry& entry = entries_[item];
    if ((mask & mask_of(entry.instance->surface)) == 0) return;
    const QueryBox query(X_OW * entry.instance->X_WM, h);
    const TriangleMesh& mesh = *entry.instance->mesh;
    entry.tree->get().search(query, best2, [&](std::uint32_t triangle) {
      const auto& [i, j, k] = mesh.triangles[triangle];
      const Vector3d a = query.to_O(mesh.vertices[i].cast<double>());
      const Vector3d b = query.to_O(mesh.vertices[j].cast<double>());
      const Vector3d c = query.to_O(mesh.vertices[k].cast<double>());
      lower_to(triangle_box_bound2(a, b, c, h), a, b, c, h, best2);
    });
  });
  if (world_.terrain && (mask & mask_of(SurfaceClass::kTerrain)) != 0 && best2 > 0.0) {
    search_terrain(*world_.terrain, X_WBox, h, best2);
  }
  return best2 < max_distance_m * max_distance_m ? std::sqrt(best2) : max_distance_m;
}

}  // namespace vinerow::physics
