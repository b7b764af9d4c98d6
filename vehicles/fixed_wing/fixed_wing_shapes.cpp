#include "vehicles/fixed_wing/fixed_wing_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vehicles/parts/touch_judge.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Vector3d;

/// Boxes per half wing for the leaves: a swept wing in steps.
constexpr int kWingBoxes = 4;

double half_span(const FixedWingParams& p) {
  return 0.5 * p.wing.span_m;
}

/// Corners of a half wing's section as a flat slab.
void append_section(const WingStation& station, std::vector<Vector3d>& points) {
  const double half_m = 0.5 * kWingThickness * station.chord_m;
  for (const double z : {half_m, -half_m}) {
    points.push_back(station.leading_B + Vector3d(0, 0, z));
    points.push_back(station.leading_B + Vector3d(-station.chord_m, 0, 0.3 * z));
  }
}

/// Flat belly, rounded nose.
physics::HullShape fuselage_hull(const FixedWingParams& p) {
  const double root = p.shape.root_chord_m, nose = p.shape.leading_edge_m + kNose * root;
  const double tail = p.shape.leading_edge_m - root, wide = kHalfWidth * root;
  const double belly = -p.shape.belly_m, deck = 0.8 * p.shape.belly_m;
  physics::HullShape hull;
  for (const double side : {1.0, -1.0}) {
    for (const double z : {belly, deck}) {
      hull.points_B.emplace_back(nose - 0.15 * root, side * 0.7 * wide, z < 0 ? z : 0.6 * z);
      hull.points_B.emplace_back(p.shape.leading_edge_m - 0.3 * root, side * wide, z);
      hull.points_B.emplace_back(tail + 0.25 * root, side * 0.8 * wide, z);
      hull.points_B.emplace_back(tail, side * 0.3 * wide, z < 0 ? 0.3 * z : z);
    }
    hull.points_B.emplace_back(nose, side * 0.3 * wide, 0.25 * belly);
  }
  return hull;
}

FoliageWatch::Part fuselage_box(const FixedWingParams& p) {
  const double root = p.shape.root_chord_m;
  const double nose = p.shape.leading_edge_m + kNose * root, tail = p.shape.leading_edge_m - root;
  return {Pose{Eigen::Quaterniond::Identity(), {0.5 * (nose + tail), 0, -0.1 * p.shape.belly_m}},
          {0.5 * (nose - tail), kHalfWidth * root, 0.9 * p.shape.belly_m}};
}

FoliageWatch::Part fin_box(const FixedWingParams& p, double side) {
  const WingStation tip = wing_station(p, 1.0, side);
  const Vector3d middle =
      tip.leading_B + Vector3d(-tip.chord_m, 0, 0) + 0.5 * Vector3d(p.shape.fin_root_m, 0, 0);
  return {Pose{Eigen::Quaterniond::Identity(), middle + Vector3d(0, 0, 0.5 * p.shape.fin_height_m)},
          {0.6 * p.shape.fin_root_m, 0.008, 0.5 * p.shape.fin_height_m}};
}

std::string part_name(const FixedWingParams& p, const Vector3d& p_B) {
  const double root = p.shape.root_chord_m;
  if (p_B.y() > kHalfWidth * root) return "its left wing";
  if (p_B.y() < -kHalfWidth * root) return "its right wing";
  return p_B.x() > p.shape.leading_edge_m + 0.5 * kNose * root ? "its nose" : "its belly";
}

}  // namespace

WingStation wing_station(const FixedWingParams& p, double share, double side) {
  const double y = share * half_span(p);
  return {{p.shape.leading_edge_m - y * std::tan(p.shape.sweep_rad), side * y,
           y * std::tan(p.shape.dihedral_rad)},
          p.shape.root_chord_m + share * (p.shape.tip_chord_m - p.shape.root_chord_m)};
}

std::vector<physics::PlacedShape> make_fixed_wing_shapes(const FixedWingParams& p) {
  std::vector<physics::PlacedShape> shapes;
  shapes.push_back({fuselage_hull(p), Pose{}});
  for (const double side : {1.0, -1.0}) {
    physics::HullShape wing;
    append_section(wing_station(p, 0.0, side), wing.points_B);
    append_section(wing_station(p, 1.0, side), wing.points_B);
    shapes.push_back({wing, Pose{}});
    const FoliageWatch::Part fin = fin_box(p, side);
    shapes.push_back({physics::BoxShape{fin.half_extents_m}, fin.X_BS});
  }
  return shapes;
}

FoliageWatch make_foliage_watch(const FixedWingParams& p) {
  std::vector<FoliageWatch::Part> parts = {fuselage_box(p)};
  for (const double side : {1.0, -1.0}) {
    for (int k = 0; k < kWingBoxes; ++k) {
      const WingStation in = wing_station(p, static_cast<double>(k) / kWingBoxes, side);
      const WingStation out = wing_station(p, static_cast<double>(k + 1) / kWingBoxes, side);
      const double front = std::max(in.leading_B.x(), out.leading_B.x());
      const double rear = std::min(in.leading_B.x() - in.chord_m, out.leading_B.x() - out.chord_m);
      Vector3d middle = 0.5 * (in.leading_B + out.leading_B);
      middle.x() = 0.5 * (front + rear);
      parts.push_back({Pose{Eigen::Quaterniond::Identity(), middle},
                       {0.5 * (front - rear), 0.5 * std::abs(out.leading_B.y() - in.leading_B.y()),
                        0.5 * kWingThickness * in.chord_m}});
    }
    parts.push_back(fin_box(p, side));
  }
  VehicleDescription about;
  describe_outline(p, about);
  return {{Pose{Eigen::Quaterniond::Identity(), about.collision_centre_B},
           about.collision_half_extents_m},
          std::move(parts)};
}

void describe_outline(const FixedWingParams& p, VehicleDescription& description) {
  const AirframeShape& s = p.shape;
  const WingStation tip = wing_station(p, 1.0, 1.0);
  const double nose = s.leading_edge_m + kNose * s.root_chord_m;
  const double tail = s.leading_edge_m - s.root_chord_m;
  const double tip_rear = tip.leading_B.x() - tip.chord_m;
  const double fin_rear = tip_rear - 0.1 * s.fin_root_m;
  const double front = std::max(nose, tip.leading_B.x()), rear = std::min(tail, fin_rear);
  const double top = tip.leading_B.z() + s.fin_height_m, bottom = -s.belly_m;
  description.collision_centre_B = {0.5 * (front + rear), 0.0, 0.5 * (top + bottom)};
  description.collision_half_extents_m = {0.5 * (front - rear), half_span(p) + 0.01,
                                          0.5 * (top - bottom)};
  const double wide = kHalfWidth * s.root_chord_m, y = half_span(p) + 0.01;
  // Counter-clockwise from the nose's right; convex: the notch behind the fuselage is filled.
  description.footprint_B = {{nose, -wide}, {nose, wide}, {tip.leading_B.x(), y},
                             {rear, y},     {rear, -y},   {tip.leading_B.x(), -y}};
}

std::string judge_fixed_wing(const physics::PhysicsWorld& world, physics::BodyId body,
                             const physics::BodyState& before, const FixedWingParams& p) {
  return judge_touches(
      world, body, before, [&p](const Vector3d& p_B) { return part_name(p, p_B); },
      [&](const GroundTouch& touch) -> std::string {
        if (touch.sink_mps > p.landing_sink_limit_mps) {
          return fmt::format("hit the ground with {}, sinking at {:.1f} m/s",
                             part_name(p, touch.p_B), touch.sink_mps);
        }
        const double upright = (before.X_WB.q * Vector3d::UnitZ()).dot(touch.normal_W);
        const double tilt_rad = std::acos(std::clamp(upright, -1.0, 1.0));
        if (tilt_rad > p.landing_tilt_limit_rad) {
          return fmt::format("touched the ground tilted by {:.0f} deg", deg_from_rad(tilt_rad));
        }
        return {};
      });
}

}  // namespace vinerow::vehicles
