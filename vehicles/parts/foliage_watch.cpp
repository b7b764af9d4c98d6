#include "vehicles/parts/foliage_watch.h"

#include <algorithm>
#include <cmath>

#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "engine/math/angles.h"

namespace vinerow::vehicles {
namespace {

/// Search distance of the whole hull; a flight between rows seldom comes closer than some
/// decimetres.
constexpr double kLook_m = 0.5;
/// The parts are queried if the hull's box is closer than this.
constexpr double kClose_m = 0.05;
constexpr SurfaceMask kCanopyMask = mask_of(SurfaceClass::kCanopy);

}  // namespace

FoliageWatch::FoliageWatch(Part hull, std::vector<Part> parts)
    : hull_(std::move(hull)), parts_(std::move(parts)) {
  reach_from_B_m_ = hull_.X_BS.p.norm() + hull_.half_extents_m.norm();
}

void FoliageWatch::start(const WorldModel& world) {
  margin_m_ = 0.0;
  has_canopy_ =
      std::any_of(world.meshes.begin(), world.meshes.end(), [](const MeshInstance& instance) {
        return instance.collides && instance.surface == SurfaceClass::kCanopy;
      });
}

double FoliageWatch::ask(const SceneQuery& scene, const Pose& X_WB, const Part& part,
                         double reach_m) {
  ++questions_;
  return scene.distance_to_box_m(X_WB * part.X_BS, part.half_extents_m, reach_m, kCanopyMask);
}

bool FoliageWatch::touches(const SceneQuery& scene, const physics::BodyState& body, double dt_s) {
  if (!has_canopy_) return false;
  margin_m_ -= (body.v_WB_W.norm() + body.w_WB_W.norm() * reach_from_B_m_) * dt_s;
  if (margin_m_ > 0.0) return false;
  margin_m_ = ask(scene, body.X_WB, hull_, kLook_m);
  if (margin_m_ > kClose_m) return false;
  double nearest_m = 2.0 * kClose_m;
  for (const Part& part : parts_) {
    nearest_m = std::min(nearest_m, ask(scene, body.X_WB, part, nearest_m));
    if (nearest_m <= 0.0) return true;
  }
  margin_m_ = nearest_m;
  return false;
}

void append_disc_parts(const Eigen::Vector3d& centre_B, double radius_m, double half_height_m,
                       std::vector<FoliageWatch::Part>& out) {
  // Twelve-sided prism around the disc, as six rectangles turned by 30 degrees each.
  constexpr int kBoxes = 6;
  constexpr double kHalfSide_rad = kPi / (2 * kBoxes);
  for (int k = 0; k < kBoxes; ++k) {
    const Eigen::AngleAxisd turn(kPi * k / kBoxes, Eigen::Vector3d::UnitZ());
    out.push_back({Pose{Eigen::Quaterniond(turn), centre_B},
                   {radius_m, radius_m * std::tan(kHalfSide_rad), half_height_m}});
  }
}

}  // namespace vinerow::vehicles
