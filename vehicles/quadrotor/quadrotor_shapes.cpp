#include "vehicles/quadrotor/quadrotor_shapes.h"

#include <cmath>

namespace vinerow::vehicles {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Share of the standing height by which the legs may give way before more than feet touches.
constexpr double kLegTravel = 0.4;

/// Frame, avionics and battery; what is drawn lies inside but for the mast.
Vector3d core_half_extents(const QuadrotorParams& p) {
  return {0.30 * p.arm_m, 0.30 * p.arm_m, 0.055};
}

/// Room of the legs from the body down to a height above the feet.
FoliageWatch::Part legs_part(const QuadrotorParams& p, double above_feet_m) {
  double across = 0.0;
  for (std::size_t i = 0; i < kRotors; ++i) {
    across = std::max(across, p.foot_B(i).head<2>().cwiseAbs().maxCoeff());
  }
  across += kFootRadius_m;
  const Vector3d half{across, across, 0.5 * (p.stand_height_m - above_feet_m)};
  return {Pose{Eigen::Quaterniond::Identity(), {0.0, 0.0, -half.z()}}, half};
}

}  // namespace

std::vector<physics::PlacedShape> make_quadrotor_shapes(const QuadrotorParams& p) {
  std::vector<physics::PlacedShape> shapes;
  const Eigen::Quaterniond upright(Eigen::AngleAxisd(kPi / 2, Vector3d::UnitX()));
  shapes.push_back({physics::BoxShape{core_half_extents(p)}, Pose{}});
  const FoliageWatch::Part legs = legs_part(p, kLegTravel * p.stand_height_m);
  shapes.push_back({physics::BoxShape{legs.half_extents_m}, legs.X_BS});
  for (std::size_t i = 0; i < kRotors; ++i) {
    shapes.push_back(
        {physics::CylinderShape{p.rotor_radius_m, kDiscHalfHeight_m}, Pose{upright, p.hub_B(i)}});
  }
  return shapes;
}

FoliageWatch make_foliage_watch(const QuadrotorParams& p) {
  VehicleDescription about;
  describe_outline(p, about);
  std::vector<FoliageWatch::Part> parts = {{Pose{}, core_half_extents(p)}, legs_part(p, 0.0)};
  for (std::size_t i = 0; i < kRotors; ++i) {
    append_disc_parts(p.hub_B(i), p.rotor_radius_m, kDiscHalfHeight_m, parts);
  }
  return {{Pose{Eigen::Quaterniond::Identity(), about.collision_centre_B},
           about.collision_half_extents_m},
          std::move(parts)};
}

void describe_outline(const QuadrotorParams& p, VehicleDescription& description) {
  const double top = p.rotor_height_m + kDiscHalfHeight_m, bottom = -p.stand_height_m;
  Vector2d half = Vector2d::Zero();
  for (std::size_t i = 0; i < kRotors; ++i) {
    half = half.cwiseMax(p.hub_B(i).head<2>().cwiseAbs() + Vector2d::Constant(p.rotor_radius_m));
  }
  description.collision_centre_B = {0.0, 0.0, 0.5 * (top + bottom)};
  description.collision_half_extents_m = {half.x(), half.y(), 0.5 * (top - bottom)};

  // Corners lie on circles a little larger than the discs, so that the sides touch the discs. The
  // directions straddle those in which two rotors reach equally far.
  constexpr int kCorners16 = 16;
  constexpr double kHalfTurn_rad = kPi / kCorners16;
  const double corner_m = p.rotor_radius_m / std::cos(kHalfTurn_rad);
  description.footprint_B.clear();
  for (int k = 0; k < kCorners16; ++k) {
    const double angle_rad = (2 * k + 1) * kHalfTurn_rad;
    const Vector2d out(std::cos(angle_rad), std::sin(angle_rad));
    Vector2d farthest = p.hub_B(0).head<2>();
    for (std::size_t i = 1; i < kRotors; ++i) {
      const Vector2d hub = p.hub_B(i).head<2>();
      if (hub.dot(out) > farthest.dot(out)) farthest = hub;
    }
    description.footprint_B.push_back(farthest + corner_m * out);
  }
}

bool is_at_rotors(const QuadrotorParams& p, double z_B) {
  return z_B > p.rotor_height_m - 2.0 * kDiscHalfHeight_m;
}

}  // namespace vinerow::vehicles
