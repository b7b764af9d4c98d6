#include "vehicles/parts/wheel_mesh.h"

#include <cmath>
#include <vector>

#include "engine/math/angles.h"
#include "vehicles/parts/mesh_builder.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kSegments = 40;
constexpr unsigned kTyreColour = 0x26272a;
constexpr unsigned kLugColour = 0x303134;

Vector3d on_wheel(double radius_m, double y_m, double angle_rad) {
  return {radius_m * std::cos(angle_rad), y_m, radius_m * std::sin(angle_rad)};
}

/// Tread surface under the lugs: falls off towards the shoulders.
double tread_radius(const WheelMeshParams& p, double y_m) {
  const double share = std::abs(y_m) / (0.5 * p.width_m);
  return p.radius_m - p.lug_height_m - 0.045 * p.radius_m * share * share;
}

void add_carcass(const WheelMeshParams& p, MeshBuilder& builder) {
  const double w = 0.5 * p.width_m, rim = p.rim_radius_m, tread = tread_radius(p, w);
  const double bulge = 0.5 * (rim + tread);
  const std::vector<Vector2d> outline = {
      {rim, -0.78 * w},        {rim + 0.012, -0.92 * w},
      {bulge, -1.02 * w},      {tread - 0.012, -w},
      {tread, -0.86 * w},      {tread_radius(p, 0.4 * w), -0.4 * w},
      {tread_radius(p, 0), 0}, {tread_radius(p, 0.4 * w), 0.4 * w},
      {tread, 0.86 * w},       {tread - 0.012, w},
      {bulge, 1.02 * w},       {rim + 0.012, 0.92 * w},
      {rim, 0.78 * w}};
  builder.colour(colour_from_srgb(kTyreColour)).lathe(outline, kSegments);
}

/// One bar of the chevron, from the middle to the shoulder on one side, leaning back on its way.
void add_lug(const WheelMeshParams& p, double start_rad, double side, MeshBuilder& builder) {
  constexpr int kPieces = 2;
  const double pitch = 2.0 * kPi / p.lugs;
  const double lean = 0.75 * pitch, half = 0.17 * pitch;
  const double y0 = -0.06 * p.width_m, y1 = 0.5 * p.width_m;
  const auto at = [&](int piece, double edge, double lift) {
    const double share = static_cast<double>(piece) / kPieces;
    const double y = y0 + (y1 - y0) * share;
    // Wider at the foot than at the top, wider at the shoulder than in the middle.
    const double wide = half * (0.8 + 0.5 * share) * (lift > 0.0 ? 0.8 : 1.25);
    // The angle from x towards z falls when the wheel rolls forward: the middle leads on top.
    const double angle = start_rad + lean * share + edge * wide;
    const double base = tread_radius(p, y);
    return on_wheel(lift > 0.0 ? base + p.lug_height_m * (1.0 + 0.6 * share * share) : base - 0.006,
                    side * y, angle);
  };
  const auto face = [&](const Vector3d& a, const Vector3d& b, const Vector3d& c,
                        const Vector3d& d) {
    if (side < 0.0) {
      builder.quad(a, b, c, d);
    } else {
      builder.quad(d, c, b, a);
    }
  };
  for (int i = 0; i < kPieces; ++i) {
    face(at(i, -1, 1), at(i, 1, 1), at(i + 1, 1, 1), at(i + 1, -1, 1));
    face(at(i, -1, 0), at(i, -1, 1), at(i + 1, -1, 1), at(i + 1, -1, 0));
    face(at(i, 1, 1), at(i, 1, 0), at(i + 1, 1, 0), at(i + 1, 1, 1));
  }
  face(at(0, 1, 0), at(0, 1, 1), at(0, -1, 1), at(0, -1, 0));
  face(at(kPieces, -1, 0), at(kPieces, -1, 1), at(kPieces, 1, 1), at(kPieces, 1, 0));
}

void add_rim(const WheelMeshParams& p, MeshBuilder& builder) {
  const double w = 0.5 * p.width_m, rim = p.rim_radius_m;
  const double out = p.left ? 1.0 : -1.0;
  // Drawn towards +y, then turned about z for right wheels.
  const Pose face{Eigen::Quaterniond(Eigen::AngleAxisd(p.left ? 0.0 : kPi, Vector3d::UnitZ())),
                  Vector3d::Zero()};
  builder.place(face);
  const std::vector<Vector2d> dish = {
      {rim + 0.004, 0.80 * w}, {rim, 0.86 * w},        {0.90 * rim, 0.84 * w},
      {0.86 * rim, 0.62 * w},  {0.80 * rim, 0.42 * w}, {0.52 * rim, 0.40 * w},
      {0.44 * rim, 0.55 * w},  {0.36 * rim, 0.58 * w}, {0.0, 0.58 * w}};
  builder.colour(colour_from_srgb(p.rim_srgb)).lathe(dish, kSegments);
  const std::vector<Vector2d> back = {{0.0, -0.35 * w}, {0.80 * rim, -0.40 * w}, {rim, -0.80 * w}};
  builder.lathe(back, kSegments / 2);
  // Dark holes in the dish, then the hub and its bolts.
  for (int i = 0; i < 6; ++i) {
    const Vector3d at = on_wheel(0.665 * rim, 0.41 * w, i * kPi / 3.0);
    builder.place(face * Pose{Eigen::Quaterniond::Identity(), at});
    builder.colour(colour_from_srgb(0x1b1c1d)).cylinder(0.085 * rim, 0.004, 10);
  }
  builder.place(face * Pose{Eigen::Quaterniond::Identity(), {0.0, 0.64 * w, 0.0}});
  builder.colour(colour_from_srgb(p.hub_srgb)).cylinder(0.24 * rim, 0.10 * w, 18);
  for (int i = 0; i < 5; ++i) {
    const Vector3d at = on_wheel(0.315 * rim, 0.60 * w, (i + 0.5) * 2.0 * kPi / 5.0);
    builder.place(face * Pose{Eigen::Quaterniond::Identity(), at});
    builder.colour(colour_from_srgb(0x8d9196)).cylinder(0.038 * rim, 0.05 * w, 6);
  }
  // A white mark on the sidewall shows that the wheel turns.
  builder.place(0, 0, 0).colour(colour_from_srgb(0xeceee8));
  for (const double angle : {0.6, 0.6 + kPi}) {
    const double y = out * 1.035 * w, r0 = rim + 0.022, r1 = rim + 0.045, half = 0.13;
    const Vector3d a = on_wheel(r0, y, angle - half), b = on_wheel(r0, y, angle + half);
    const Vector3d c = on_wheel(r1, y, angle + 0.8 * half), d = on_wheel(r1, y, angle - 0.8 * half);
    if (p.left) {
      builder.quad(a, b, c, d);
    } else {
      builder.quad(d, c, b, a);
    }
  }
}

}  // namespace

TriangleMesh make_wheel_mesh(const WheelMeshParams& params) {
  MeshBuilder builder;
  add_carcass(params, builder);
  builder.colour(colour_from_srgb(kLugColour));
  const double pitch = 2.0 * kPi / params.lugs;
  for (int i = 0; i < params.lugs; ++i) {
    add_lug(params, i * pitch, 1.0, builder);
    add_lug(params, (i + 0.5) * pitch, -1.0, builder);
  }
  add_rim(params, builder);
  return builder.take();
}

}  // namespace vinerow::vehicles
