#include "vehicles/quadrotor/quadrotor_mesh.h"

#include <cmath>
#include <vector>

#include "vehicles/parts/blade_mesh.h"
#include "vehicles/parts/mesh_builder.h"
#include "vehicles/quadrotor/quadrotor_shapes.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr unsigned kCarbon = 0x1d1f22, kCarbonEdge = 0x34383c, kBlack = 0x101113;
constexpr unsigned kWhite = 0xf1f2ee, kOrange = 0xe0601c, kAluminium = 0xb9bdc1;
constexpr unsigned kBell = 0x54585d, kCopper = 0xb4713d, kRubber = 0x0c0c0d;
constexpr unsigned kBattery = 0x27466b, kLabel = 0xf2c230, kGlass = 0x14233a;
constexpr unsigned kRed = 0xd32020, kGreen = 0x22b14c;

/// Frame with its y axis upwards: lathes, cylinders and plates lie flat.
Pose upright(double x, double y, double z) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(kPi / 2, Vector3d::UnitX())), {x, y, z}};
}

/// Frame at (x, y, z) turned about z.
Pose turned(double x, double y, double z, double yaw_rad) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ())), {x, y, z}};
}

/// Regular polygon in (x, z), counter-clockwise seen from -y.
std::vector<Vector2d> polygon(double radius_m, int corners, double stretch_x = 1.0) {
  std::vector<Vector2d> outline;
  for (int k = 0; k < corners; ++k) {
    const double angle_rad = 2.0 * kPi * (k + 0.5) / corners;
    outline.emplace_back(stretch_x * radius_m * std::cos(angle_rad),
                         radius_m * std::sin(angle_rad));
  }
  return outline;
}

void add_frame(const QuadrotorParams& p, MeshBuilder& b) {
  const double a = p.arm_m;
  for (const double z : {-0.014, 0.014}) {
    b.colour(colour_from_srgb(kCarbon)).place(upright(0, 0, z));
    b.extrude(polygon(0.30 * a, 8), 0.0012, 0.0005);
  }
  for (int k = 0; k < 8; ++k) {
    const double angle_rad = kPi / 8 + kPi / 4 * k;
    const double x = 0.25 * a * std::cos(angle_rad), y = 0.25 * a * std::sin(angle_rad);
    b.colour(colour_from_srgb(k % 2 == 0 ? kOrange : kAluminium)).place(0, 0, 0);
    b.rod({x, y, -0.014}, {x, y, 0.014}, 0.004, 10);
    b.colour(colour_from_srgb(kAluminium)).rod({x, y, 0.014}, {x, y, 0.018}, 0.0028, 8);
  }
  // Hood in two tones with a visor ahead, and the autopilot's cube behind it.
  b.colour(colour_from_srgb(kWhite)).place(0.02 * a, 0, 0.029);
  b.box({0.19 * a, 0.15 * a, 0.014}, 0.010);
  b.colour(colour_from_srgb(kOrange)).place(0.10 * a, 0, 0.0435);
  b.box({0.085 * a, 0.10 * a, 0.0022}, 0.0020);
  b.colour(colour_from_srgb(kGlass))
      .place(0.185 * a, 0, 0.029)
      .box({0.028 * a, 0.10 * a, 0.007}, 0.004);
  b.colour(colour_from_srgb(kBlack)).place(-0.09 * a, 0, 0.047).box({0.019, 0.019, 0.008}, 0.003);
  b.colour(colour_from_srgb(kLabel)).place(-0.09 * a, 0, 0.0552).box({0.005, 0.010, 0.0004}, 0.0);
}

/// In its sliding case below the lower plate.
void add_battery(const QuadrotorParams& p, MeshBuilder& b) {
  const double a = p.arm_m, z = -0.037;
  b.colour(colour_from_srgb(kCarbonEdge))
      .place(0, 0, z - 0.021)
      .box({0.25 * a, 0.125 * a, 0.0016}, 0.001);
  for (const double side : {-1.0, 1.0}) {
    b.place(0, side * 0.122 * a, z).box({0.25 * a, 0.0014, 0.021}, 0.001);
  }
  b.colour(colour_from_srgb(kBattery))
      .place(-0.015 * a, 0, z)
      .box({0.255 * a, 0.112 * a, 0.018}, 0.005);
  b.colour(colour_from_srgb(kLabel)).place(-0.272 * a, 0, z).box({0.0012, 0.07 * a, 0.009}, 0.0);
  b.colour(colour_from_srgb(kBlack));
  for (const double x : {-0.13 * a, 0.13 * a}) {
    b.place(x, 0, z).box({0.009, 0.130 * a, 0.0245}, 0.002);
  }
  b.place(0, 0, 0).colour(colour_from_srgb(kRed));
  b.rod({-0.27 * a, 0.03 * a, z + 0.006}, {-0.22 * a, 0.09 * a, 0.0}, 0.0028, 8);
  b.colour(colour_from_srgb(kBlack));
  b.rod({-0.27 * a, -0.03 * a, z + 0.006}, {-0.22 * a, -0.09 * a, 0.0}, 0.0028, 8);
}

void add_motor(const QuadrotorParams& p, const Vector3d& hub, MeshBuilder& b) {
  const double r = 0.021 * p.rotor_radius_m / 0.19, top = hub.z() - 0.006;
  // Mount plate, stator with its windings, bell with a domed top.
  b.colour(colour_from_srgb(kCarbonEdge)).place(upright(hub.x(), hub.y(), 0.012));
  b.cylinder(1.15 * r, 0.0025, 24);
  b.colour(colour_from_srgb(kCopper)).place(upright(hub.x(), hub.y(), 0.019));
  b.cylinder(0.86 * r, 0.0045, 24);
  const std::vector<Vector2d> bell = {{1.00 * r, 0.0},  {1.00 * r, 0.55}, {0.95 * r, 0.75},
                                      {0.70 * r, 0.92}, {0.30 * r, 1.0},  {0.0, 1.0}};
  std::vector<Vector2d> outline;
  for (const Vector2d& point : bell) outline.emplace_back(point.x(), point.y() * (top - 0.021));
  b.colour(colour_from_srgb(kBell)).place(upright(hub.x(), hub.y(), 0.021)).lathe(outline, 28);
  b.colour(colour_from_srgb(kOrange)).place(upright(hub.x(), hub.y(), 0.021 + 0.3 * (top - 0.021)));
  b.cylinder(1.012 * r, 0.0016, 28);
  b.colour(colour_from_srgb(kAluminium)).place(0, 0, 0);
  b.rod({hub.x(), hub.y(), top - 0.002}, hub, 0.003, 10);
}

void add_arm(const QuadrotorParams& p, std::size_t i, MeshBuilder& b) {
  const double a = p.arm_m;
  const Vector3d hub = p.hub_B(i);
  const double yaw_rad = std::atan2(hub.y(), hub.x());
  const Vector3d out(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
  const bool ahead = hub.x() > 0.1 * a;
  b.colour(colour_from_srgb(kCarbon))
      .place(0, 0, 0)
      .rod(0.16 * a * out, 1.02 * a * out, 0.0105, 18);
  b.colour(colour_from_srgb(ahead ? kOrange : kWhite));
  b.rod(0.60 * a * out, 0.72 * a * out, 0.0112, 18);
  // Clamps at the root and under the motor, speed controller with its fins between.
  b.colour(colour_from_srgb(kCarbonEdge));
  for (const double at : {0.24 * a, 0.97 * a}) {
    b.place(turned(at * out.x(), at * out.y(), 0, yaw_rad)).box({0.017, 0.016, 0.0125}, 0.004);
  }
  b.colour(colour_from_srgb(kAluminium));
  for (int k = 0; k < 5; ++k) {
    const double at = 0.42 * a + 0.008 * k;
    b.place(turned(at * out.x(), at * out.y(), 0.0, yaw_rad)).box({0.0022, 0.0135, 0.0135}, 0.001);
  }
  // Position light: red to the left, green to the right, white behind.
  const unsigned light = !ahead && std::abs(hub.y()) < 0.1 * a ? kWhite
                         : hub.y() > 0.0                       ? kRed
                                                               : kGreen;
  b.colour(colour_from_srgb(light)).place(upright(0.97 * hub.x(), 0.97 * hub.y(), -0.015));
  b.cylinder(0.008, 0.003, 16);
  add_motor(p, hub, b);
}

void add_gear(const QuadrotorParams& p, MeshBuilder& b) {
  const double root = 0.55 * p.gear_radius_m / p.arm_m;
  for (std::size_t i = 0; i < kRotors; ++i) {
    const Vector3d foot = p.foot_B(i) + Vector3d(0, 0, kFootRadius_m);
    const Vector3d top(root * p.hub_B(i).x(), root * p.hub_B(i).y(), -0.012);
    b.place(0, 0, 0).colour(colour_from_srgb(kCarbon)).rod(top, foot, 0.0062, 14);
    b.colour(colour_from_srgb(kOrange))
        .rod(top + 0.02 * (foot - top), top + 0.12 * (foot - top), 0.0085, 14);
    const double r = kFootRadius_m;
    std::vector<Vector2d> ball;
    for (int k = 0; k <= 10; ++k) {
      const double angle_rad = -kPi / 2 + kPi * k / 10;
      ball.emplace_back(r * std::cos(angle_rad), r * std::sin(angle_rad));
    }
    b.colour(colour_from_srgb(kRubber))
        .place(upright(foot.x(), foot.y(), foot.z()))
        .lathe(ball, 18);
  }
  // Braces between neighbouring legs, left and right, where the camera's view is not barred.
  b.place(0, 0, 0).colour(colour_from_srgb(kCarbonEdge));
  for (std::size_t i = 0; i < kRotors; ++i) {
    const Vector3d from = p.foot_B(i), to = p.foot_B((i + 1) % kRotors);
    if (std::abs(0.5 * (from + to).y()) < 0.4 * p.gear_radius_m) continue;
    const Vector3d up(0, 0, 0.35 * p.stand_height_m);
    b.rod(0.86 * Vector3d(from.x(), from.y(), 0) + Vector3d(0, 0, from.z()) + up,
          0.86 * Vector3d(to.x(), to.y(), 0) + Vector3d(0, 0, to.z()) + up, 0.004, 10);
  }
}

/// Camera ahead, hung in a yoke on dampers.
void add_camera(const QuadrotorParams& p, MeshBuilder& b) {
  const double x = 0.36 * p.arm_m, z = -0.055;
  b.colour(colour_from_srgb(kCarbonEdge))
      .place(0.92 * x, 0, -0.020)
      .box({0.028, 0.030, 0.0018}, 0.001);
  b.colour(colour_from_srgb(kRubber));
  for (const double y : {-0.02, 0.02})
    b.place(upright(0.92 * x, y, -0.017)).cylinder(0.005, 0.004, 12);
  b.colour(colour_from_srgb(kAluminium)).place(0, 0, 0);
  b.rod({x, 0, -0.020}, {x, 0, -0.032}, 0.010, 18);
  b.rod({x, -0.032, -0.032}, {x, 0.032, -0.032}, 0.004, 10);
  for (const double y : {-0.032, 0.032}) {
    b.rod({x, y, -0.032}, {x, y, z}, 0.004, 10);
    b.rod({x, y > 0 ? y - 0.010 : y + 0.010, z}, {x, y, z}, 0.010, 16);
  }
  b.colour(colour_from_srgb(kBlack)).place(x, 0, z).box({0.016, 0.022, 0.017}, 0.005);
  b.place(0, 0, 0).rod({x + 0.015, 0, z}, {x + 0.030, 0, z}, 0.0125, 22);
  b.colour(colour_from_srgb(kAluminium)).rod({x + 0.029, 0, z}, {x + 0.031, 0, z}, 0.0130, 22);
  b.colour(colour_from_srgb(kGlass)).rod({x + 0.030, 0, z}, {x + 0.0315, 0, z}, 0.0105, 22);
}

void add_mast(const QuadrotorParams& p, MeshBuilder& b) {
  const double x = -0.22 * p.arm_m, top = p.rotor_height_m + 0.065;
  b.colour(colour_from_srgb(kAluminium)).place(0, 0, 0).rod({x, 0, 0.014}, {x, 0, top}, 0.004, 12);
  b.colour(colour_from_srgb(kCarbonEdge)).place(upright(x, 0, 0.018)).cylinder(0.011, 0.004, 16);
  b.place(upright(x, 0, top)).cylinder(0.031, 0.002, 28);
  const std::vector<Vector2d> dome = {
      {0.030, 0.0}, {0.031, 0.006}, {0.027, 0.013}, {0.016, 0.018}, {0.0, 0.019}};
  b.colour(colour_from_srgb(kWhite)).place(upright(x, 0, top + 0.002)).lathe(dome, 28);
  // Radio and remote-control whips.
  b.colour(colour_from_srgb(kBlack)).place(0, 0, 0);
  for (const double side : {-1.0, 1.0}) {
    b.rod({-0.26 * p.arm_m, side * 0.11 * p.arm_m, -0.012},
          {-0.36 * p.arm_m, side * 0.17 * p.arm_m, -0.095}, 0.0022, 8);
  }
}

}  // namespace

TriangleMesh make_quadrotor_body(const QuadrotorParams& params) {
  MeshBuilder builder;
  add_frame(params, builder);
  add_battery(params, builder);
  for (std::size_t i = 0; i < kRotors; ++i) add_arm(params, i, builder);
  add_gear(params, builder);
  add_camera(params, builder);
  add_mast(params, builder);
  return builder.take();
}

TriangleMesh make_quadrotor_rotor(double radius_m, bool counter_clockwise) {
  MeshBuilder builder;
  const double r = 0.07 * radius_m;
  const double mirror = counter_clockwise ? 1.0 : -1.0;
  for (const double yaw_rad : {0.0, kPi}) {
    builder.place(turned(0, 0, 0, yaw_rad));
    append_blade(radius_m, mirror, kCarbon, kOrange, builder);
  }
  builder.colour(colour_from_srgb(kBlack)).place(upright(0, 0, 0)).cylinder(r, 0.0045, 20);
  const std::vector<Vector2d> spinner = {
      {0.72 * r, 0.0045}, {0.66 * r, 0.009}, {0.40 * r, 0.0135}, {0.0, 0.015}};
  builder.colour(colour_from_srgb(counter_clockwise ? kAluminium : kOrange)).lathe(spinner, 20);
  return builder.take();
}

}  // namespace vinerow::vehicles
