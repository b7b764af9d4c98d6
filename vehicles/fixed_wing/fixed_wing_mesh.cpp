#include "vehicles/fixed_wing/fixed_wing_mesh.h"

#include <cmath>

#include "vehicles/fixed_wing/fixed_wing_shapes.h"
#include "vehicles/fixed_wing/wing_mesh.h"
#include "vehicles/parts/blade_mesh.h"
#include "vehicles/parts/loft_mesh.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr unsigned kGlass = 0x14233a, kMetal = 0xb9bdc1, kCopper = 0xb4713d;

/// Frame with its y axis along x of B: lathes and cylinders lie along the fuselage.
Pose along_x(double x, double y, double z) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(-0.5 * kPi, Vector3d::UnitZ())), {x, y, z}};
}

/// Frame with its y axis upwards.
Pose upright(double x, double y, double z) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * kPi, Vector3d::UnitX())), {x, y, z}};
}

/// Half width, top and bottom of the fuselage at a share of its length from the nose.
struct Girth {
  double half_width_m, top_m, bottom_m;
};

Girth girth(const FixedWingParams& p, double s) {
  const double wide = kHalfWidth * p.shape.root_chord_m, belly = p.shape.belly_m;
  const double nose = std::pow(std::sin(0.5 * kPi * std::min(1.0, s / 0.34)), 0.62);
  const double tail = s < 0.55 ? 1.0 : std::cos(0.5 * kPi * 0.80 * (s - 0.55) / 0.45);
  const double drop = -0.15 * belly * (1.0 - nose);  // the nose droops
  return {wide * nose * (0.35 + 0.65 * tail), drop + 0.85 * belly * nose * (0.60 + 0.40 * tail),
          drop - belly * nose * (0.02 + 0.98 * std::pow(tail, 1.4))};
}

/// Rounded, flat below.
std::vector<Vector3d> girth_points(const Girth& g, double x) {
  std::vector<Vector3d> points;
  constexpr int kAround = 36;
  for (int k = 0; k < kAround; ++k) {
    const double angle_rad = 2.0 * kPi * (k + 0.5) / kAround;
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    const double power = s < 0.0 ? 0.55 : 0.95;  // of a superellipse
    const double y = g.half_width_m * std::copysign(std::pow(std::abs(c), power), c);
    const double z =
        (s < 0.0 ? -g.bottom_m : g.top_m) * std::copysign(std::pow(std::abs(s), power), s);
    points.emplace_back(x, y, z);
  }
  return points;
}

void add_fuselage(const FixedWingParams& p, MeshBuilder& b) {
  const double root = p.shape.root_chord_m;
  const double nose = p.shape.leading_edge_m + kNose * root, length = (1.0 + kNose) * root;
  constexpr int kPieces = 40;
  LoftRows rows;
  for (int i = 0; i <= kPieces; ++i) {
    const double s = std::pow(static_cast<double>(i) / kPieces, 1.35) + 1e-4;
    rows.push_back(girth_points(girth(p, s), nose - s * length));
  }
  LoftOptions options;
  options.closed = true;
  options.mirrored = true;  // rows go backwards, points go left over the top
  options.colour = [](std::size_t i, std::size_t j) {
    if (i < 8) return colour_from_srgb(kPaintOrange);
    return colour_from_srgb(j > 19 && j < 34 ? kPaintDark : kPaintWhite);  // belly
  };
  b.place(0, 0, 0);
  append_loft(rows, options, b);
  b.colour(colour_from_srgb(kPaintDark));
  append_lid(rows.front(), Vector3d::UnitX(), b);
  append_lid(rows.back(), -Vector3d::UnitX(), b);

  // Hatch over the battery: a shell a little above the skin.
  LoftRows hatch;
  for (int i = 0; i <= 16; ++i) {
    const double s = 0.20 + 0.30 * i / 16.0;
    Girth g = girth(p, s);
    const double edge = std::min(1.0, 6.0 * std::min(i, 16 - i) / 16.0 + 0.05);
    g.top_m += 0.004 * edge, g.half_width_m += 0.001;
    const std::vector<Vector3d> around = girth_points(g, nose - s * length);
    const auto from = static_cast<std::ptrdiff_t>(4.0 + 1.5 * (1.0 - edge));
    hatch.emplace_back(around.begin() + from, around.begin() + from + 10);
  }
  options.closed = false;
  options.colour = nullptr;
  b.colour(colour_from_srgb(kPaintDark));
  append_loft(hatch, options, b);
}

/// Camera with five lenses behind a window in the belly.
void add_camera(const FixedWingParams& p, MeshBuilder& b) {
  const double x = p.shape.leading_edge_m - 0.30 * p.shape.root_chord_m, z = -p.shape.belly_m;
  b.colour(colour_from_srgb(kMetal)).place(upright(x, 0, z + 0.0012)).cylinder(0.036, 0.0016, 40);
  b.colour(colour_from_srgb(kGlass)).place(upright(x, 0, z + 0.0004)).cylinder(0.032, 0.0016, 40);
  for (int k = 0; k < 5; ++k) {
    const double angle_rad = 2.0 * kPi * k / 5.0, r = k == 0 ? 0.0 : 0.018;
    const double lx = x + r * std::cos(angle_rad), ly = r * std::sin(angle_rad);
    b.colour(colour_from_srgb(kMetal))
        .place(upright(lx, ly, z - 0.0012))
        .cylinder(0.0066, 0.001, 20);
    b.colour(colour_from_srgb(0x0a0d14))
        .place(upright(lx, ly, z - 0.0022))
        .cylinder(0.005, 0.0008, 20);
  }
}

void add_motor(const FixedWingParams& p, MeshBuilder& b) {
  const Vector3d hub = propeller_B(p);
  const double front = p.shape.leading_edge_m - 0.86 * p.shape.root_chord_m;
  // Pylon from the fuselage to the mount, motor with windings and bell.
  b.colour(colour_from_srgb(kPaintWhite)).place(0, 0, 0);
  b.rod({front, 0, 0.5 * hub.z()}, {hub.x() + 0.042, 0, hub.z()}, 0.013, 24);
  b.colour(colour_from_srgb(kPaintDark)).place(along_x(hub.x() + 0.040, 0, hub.z()));
  b.cylinder(0.0165, 0.002, 28);
  b.colour(colour_from_srgb(kCopper)).place(along_x(hub.x() + 0.034, 0, hub.z()));
  b.cylinder(0.0125, 0.004, 28);
  b.colour(colour_from_srgb(0x54585d)).place(along_x(hub.x() + 0.019, 0, hub.z()));
  b.cylinder(0.0148, 0.012, 28);
  b.colour(colour_from_srgb(kMetal)).place(0, 0, 0);
  b.rod({hub.x() + 0.008, 0, hub.z()}, {hub.x() - 0.004, 0, hub.z()}, 0.003, 12);
}

/// Pitot tube, antennas, and the skid that the belly slides on.
void add_fittings(const FixedWingParams& p, MeshBuilder& b) {
  const WingStation left = wing_station(p, 0.5, 1.0);
  const Vector3d root = left.leading_B + Vector3d(-0.01, 0, 0);
  b.place(0, 0, 0)
      .colour(colour_from_srgb(kMetal))
      .rod(root, root + Vector3d(0.075, 0, 0), 0.0022, 12);
  b.colour(colour_from_srgb(kPaintDark)).rod(root, root + Vector3d(0.02, 0, 0), 0.0034, 12);
  const double x = p.shape.leading_edge_m - 0.52 * p.shape.root_chord_m;
  const double top = girth(p, 0.60).top_m;
  const std::vector<Vector2d> dome = {
      {0.017, 0.0}, {0.0175, 0.004}, {0.015, 0.008}, {0.009, 0.0105}, {0.0, 0.0112}};
  b.colour(colour_from_srgb(kPaintGrey)).place(upright(x, 0, top - 0.004)).lathe(dome, 28);
  b.colour(colour_from_srgb(kPaintDark)).place(0, 0, 0);
  b.rod({x - 0.05, 0.014, top - 0.010}, {x - 0.085, 0.018, top + 0.055}, 0.0016, 8);
}

}  // namespace

TriangleMesh make_fixed_wing_body(const FixedWingParams& p) {
  MeshBuilder b;
  for (const double side : {1.0, -1.0}) {
    append_half_wing(p, side, b);
    append_fin(p, side, b);
  }
  add_fuselage(p, b);
  add_camera(p, b);
  add_motor(p, b);
  add_fittings(p, b);
  return b.take();
}

Pose elevon_hinge_X_BE(const FixedWingParams& p, double side) {
  const auto hinge = [&](double share) {
    const WingStation station = wing_station(p, share, side);
    return Vector3d(station.leading_B -
                    Vector3d((1.0 - p.shape.elevon_chord) * station.chord_m, 0, 0));
  };
  const Vector3d inner = hinge(p.shape.elevon_from), outer = hinge(p.shape.elevon_to);
  const Vector3d y = side * (outer - inner).normalized();
  const Vector3d x = y.cross(Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d R;
  R << x, y, x.cross(y);
  return {Eigen::Quaterniond(R), inner};
}

TriangleMesh make_fixed_wing_elevon(const FixedWingParams& p, double side) {
  MeshBuilder b;
  append_elevon(p, side, elevon_hinge_X_BE(p, side), b);
  return b.take();
}

Vector3d propeller_B(const FixedWingParams& p) {
  return {p.shape.leading_edge_m - 1.10 * p.shape.root_chord_m, 0.0, 0.75 * p.shape.belly_m};
}

TriangleMesh make_fixed_wing_propeller(const FixedWingParams& p) {
  MeshBuilder b;
  const double radius = std::sqrt(p.propeller.area_m2 / kPi);
  for (const double turn_rad : {0.0, kPi}) {
    // The blade turns about its z: that becomes x of the link.
    const Eigen::Quaterniond q(Eigen::AngleAxisd(turn_rad, Vector3d::UnitX()) *
                               Eigen::AngleAxisd(0.5 * kPi, Vector3d::UnitY()));
    b.place({q, Vector3d::Zero()});
    append_blade(radius, 1.0, kPaintDark, kPaintOrange, b);
  }
  const std::vector<Vector2d> spinner = {
      {0.011, 0.0}, {0.0105, 0.006}, {0.008, 0.013}, {0.004, 0.017}, {0.0, 0.018}};
  // Its point looks back.
  b.place({Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * kPi, Vector3d::UnitZ())), {0.004, 0, 0}});
  b.colour(colour_from_srgb(kPaintOrange)).lathe(spinner, 28);
  return b.take();
}

}  // namespace vinerow::vehicles
