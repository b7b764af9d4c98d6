#include "vehicles/payloads/spray_jet.h"

#include <algorithm>
#include <cmath>

namespace vinerow::vehicles {
namespace {

/// Rays continue this far behind a surface, so that they do not meet it again.
constexpr double kBehind_m = 1e-4;
/// No canopy is thicker; a hull without a far side within this distance is treated as solid.
constexpr double kThickest_m = 5.0;
/// A jet slower than this relative to the air is ignored.
constexpr double kSlowest_mps = 0.1;

constexpr SurfaceMask kCanopyMask = mask_of(SurfaceClass::kCanopy);
/// Droplets pass the wires.
constexpr SurfaceMask kStops = kAllSurfaces & ~mask_of(SurfaceClass::kWire);

}  // namespace

SprayJet::SprayJet(const SprayParams& params, const Eigen::Vector3d& p_W,
                   const Eigen::Vector3d& direction_W, const Eigen::Vector3d& v_W,
                   const Eigen::Vector3d& wind_W)
    : p_W_(p_W),
      carried_W_mps_(wind_W - params.settling_mps * Eigen::Vector3d::UnitZ()),
      decay_m_(params.jet_decay_m) {
  const Eigen::Vector3d start_W = params.jet_speed_mps * direction_W + v_W - wind_W;
  speed_mps_ = start_W.norm();
  if (speed_mps_ > kSlowest_mps) {
    axis_W_ = start_W / speed_mps_;
  } else {
    axis_W_ = direction_W;
    speed_mps_ = kSlowest_mps;
  }
}

double SprayJet::time_s(double x_m) const {
  return (x_m + 0.5 * x_m * x_m / decay_m_) / speed_mps_;
}

Eigen::Vector3d SprayJet::at(double x_m) const {
  return p_W_ + x_m * axis_W_ + time_s(x_m) * carried_W_mps_;
}

namespace internal {

SprayMeeting meet(const SceneQuery& scene, const Eigen::Vector3d& p_W,
                  const Eigen::Vector3d& direction_W, double length_m) {
  SprayMeeting met;
  const auto hit = scene.cast_ray(p_W, direction_W, length_m, kStops);
  if (!hit) return met;
  met.meets = true;
  met.distance_m = hit->distance_m;
  met.mesh = hit->mesh;
  met.is_canopy = hit->surface == SurfaceClass::kCanopy;
  if (!met.is_canopy) return met;
  const Eigen::Vector3d inside_W = p_W + (hit->distance_m + kBehind_m) * direction_W;
  const auto exit = scene.cast_ray(inside_W, direction_W, kThickest_m, kCanopyMask);
  // The next piece starts behind the far side.
  if (exit) met.chord_m = exit->distance_m + 2.0 * kBehind_m;
  return met;
}

}  // namespace internal
}  // namespace vinerow::vehicles
