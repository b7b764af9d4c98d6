#include "vehicles/four_wheel_steering_rover/four_wheel_steering_mesh.h"

#include <array>
#include <vector>

#include "engine/math/angles.h"
#include "vehicles/parts/mesh_builder.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr unsigned kOrange = 0xd8571a;
constexpr unsigned kDarkOrange = 0x9c3a10;
constexpr unsigned kAnthracite = 0x33373b;
constexpr unsigned kBlack = 0x17181a;
constexpr unsigned kAluminium = 0xb4b8bc;
constexpr unsigned kTank = 0xe9ece4;
constexpr unsigned kBlue = 0x1f5f9e;
constexpr unsigned kGlass = 0x16263f;
constexpr unsigned kYellow = 0xf2c230;
constexpr unsigned kRed = 0xc62828;
constexpr unsigned kLamp = 0xfff3c8;
constexpr unsigned kCream = 0xf7f8f4;

/// Heights above the ground, in wheel radii where the wheels decide.
struct Layout {
  double half_base, half_track, radius, tyre, ground;

  /// Middle of the portal beams: clear of the mudguards on full spring travel.
  double beam() const { return 2.68 * radius; }
  double deck() const { return beam() + 0.035; }
  double half_width() const { return half_track + 0.5 * tyre; }
  /// Frame F at (x, y, z), z from the ground.
  Pose at(double x, double y, double z) const {
    return {Eigen::Quaterniond::Identity(), {x, y, z - ground}};
  }
  /// The same with F's y axis upwards: lathes and cylinders stand.
  Pose upright(double x, double y, double z) const {
    Pose pose = at(x, y, z);
    pose.q = Eigen::AngleAxisd(kPi / 2, Vector3d::UnitX());
    return pose;
  }
  /// The same with F's y axis along the direction `yaw` in the plane.
  Pose facing(double x, double y, double z, double yaw_rad) const {
    Pose pose = at(x, y, z);
    pose.q = Eigen::AngleAxisd(yaw_rad - kPi / 2, Vector3d::UnitZ());
    return pose;
  }
};

Layout layout_of(const FourWheelSteeringMeshParams& p) {
  return {0.5 * p.wheel_base_m, 0.5 * p.track_m, p.wheel_radius_m, p.tyre_width_m,
          p.ground_to_origin_m};
}

void add_frame(const Layout& l, MeshBuilder& b) {
  const double x = l.half_base, z = l.beam();
  b.colour(colour_from_srgb(kAnthracite));
  for (const double ey : {-1.0, 1.0}) {
    b.place(l.at(0, ey * 0.21, z)).box({x + 0.10, 0.028, 0.032}, 0.008);
  }
  for (const double at : {-0.45 * x, 0.45 * x}) {
    b.place(l.at(at, 0, z)).box({0.025, 0.20, 0.025}, 0.006);
  }
  for (const double ex : {-1.0, 1.0}) {
    // Portal beam over the axle, arched up a little between the kingpin housings.
    b.colour(colour_from_srgb(kAnthracite));
    b.place(l.at(ex * x, 0, z)).box({0.045, l.half_track + 0.01, 0.036}, 0.010);
    b.colour(colour_from_srgb(kBlack));
    b.place(l.at(ex * x, 0, z + 0.045)).box({0.075, 0.16, 0.02}, 0.008);
    for (const double ey : {-1.0, 1.0}) {
      // Kingpin housing with its steering servo on top.
      b.colour(colour_from_srgb(kAluminium)).place(l.upright(ex * x, ey * l.half_track, z));
      b.cylinder(0.052, 0.045, 24);
      b.colour(colour_from_srgb(kBlack)).place(l.upright(ex * x, ey * l.half_track, z + 0.075));
      b.cylinder(0.043, 0.032, 24);
      b.colour(colour_from_srgb(kOrange)).place(l.upright(ex * x, ey * l.half_track, z + 0.110));
      b.cylinder(0.034, 0.005, 24);
      // Rod of the mechanism from the servo box in the middle to the housing.
      b.colour(colour_from_srgb(kAluminium)).place(l.at(0, 0, 0));
      const double rod_x = ex * (x - 0.075), rod_z = z + 0.03;
      b.rod({rod_x, ey * 0.13, rod_z}, {rod_x + ex * 0.01, ey * (l.half_track - 0.03), rod_z},
            0.010, 10);
    }
  }
  // Battery tub hung between the axles, with ribs and a bottom plate.
  b.colour(colour_from_srgb(kAnthracite)).place(l.at(0, 0, 0.5 * (z - 0.03 + 0.24)));
  b.box({0.44, 0.30, 0.5 * (z - 0.03 - 0.24)}, 0.03);
  b.colour(colour_from_srgb(kBlack));
  for (const double ey : {-1.0, 1.0}) {
    for (int i = 0; i < 5; ++i) {
      b.place(l.at(-0.26 + 0.13 * i, ey * 0.302, 0.375)).box({0.042, 0.006, 0.085}, 0.004);
    }
  }
}

void add_hood(const Layout& l, MeshBuilder& b) {
  const double x = l.half_base, z = l.deck(), w = 0.33;
  // Side view: electronics hood at the front with a raked nose; heights above the deck.
  const std::vector<Vector2d> side = {{0.10, 0.0},      {x + 0.10, 0.0},  {x + 0.15, 0.05},
                                      {x + 0.13, 0.11}, {x - 0.08, 0.24}, {x - 0.20, 0.275},
                                      {0.13, 0.275},    {0.10, 0.24}};
  b.colour(colour_from_srgb(kOrange)).place(l.at(0, 0, z)).extrude(side, w, 0.035);
  const std::vector<Vector2d> flank = {
      {0.19, 0.05}, {x + 0.02, 0.05}, {x - 0.03, 0.10}, {x - 0.17, 0.21}, {0.19, 0.21}};
  for (const double ey : {-1.0, 1.0}) {
    b.colour(colour_from_srgb(kAnthracite)).place(l.at(0, ey * w, z)).extrude(flank, 0.007, 0.004);
    b.colour(colour_from_srgb(kBlack));
    for (int i = 0; i < 4; ++i) {
      b.place(l.at(0.34, ey * (w + 0.008), z + 0.075 + 0.035 * i)).box({0.11, 0.004, 0.008}, 0.002);
    }
  }
  // Running boards over the wheels, front to rear, with a chequered-plate look.
  for (const double ey : {-1.0, 1.0}) {
    b.colour(colour_from_srgb(kDarkOrange));
    b.place(l.at(0, ey * 0.405, z + 0.012)).box({0.53, 0.07, 0.010}, 0.004);
    b.colour(colour_from_srgb(kAnthracite));
    for (int i = 0; i < 9; ++i) {
      b.place(l.at(-0.44 + 0.11 * i, ey * 0.405, z + 0.023)).box({0.03, 0.05, 0.003}, 0.001);
    }
    for (const double at : {-0.38, 0.38}) {
      b.place(l.at(at, ey * 0.30, z - 0.006)).box({0.018, 0.10, 0.010}, 0.002);
    }
  }
  // Lamps in the nose, and a stereo camera between them.
  for (const double ey : {-0.22, 0.22}) {
    b.colour(colour_from_srgb(kBlack)).place(l.facing(x + 0.145, ey, z + 0.072, 0.0));
    b.cylinder(0.036, 0.014, 24);
    b.colour(colour_from_srgb(kLamp)).place(l.facing(x + 0.160, ey, z + 0.072, 0.0));
    b.cylinder(0.028, 0.004, 24);
  }
  b.colour(colour_from_srgb(kBlack))
      .place(l.at(x + 0.145, 0, z + 0.075))
      .box({0.02, 0.10, 0.024}, 0.008);
  b.colour(colour_from_srgb(kGlass));
  for (const double ey : {-0.065, 0.065}) {
    b.place(l.facing(x + 0.165, ey, z + 0.075, 0.0)).cylinder(0.015, 0.004, 18);
  }
}

void add_tank(const Layout& l, MeshBuilder& b) {
  const double x = -0.20, r = 0.185, z = l.deck() + 0.03 + r, w = 0.36;
  // Lying spray tank with domed ends in a cradle, two straps and a blue lid.
  const std::vector<Vector2d> shell = {{0.0, -w},
                                       {0.5 * r, -w + 0.006},
                                       {0.8 * r, -w + 0.03},
                                       {0.95 * r, -w + 0.065},
                                       {r, -w + 0.11},
                                       {r, w - 0.11},
                                       {0.95 * r, w - 0.065},
                                       {0.8 * r, w - 0.03},
                                       {0.5 * r, w - 0.006},
                                       {0.0, w}};
  b.colour(colour_from_srgb(kTank)).place(l.at(x, 0, z)).lathe(shell, 40);
  b.colour(colour_from_srgb(kAnthracite));
  for (const double ey : {-0.17, 0.17}) {
    b.place(l.at(x, ey, z)).ring_sector(r, r + 0.006, 0.018, 0.0, 2.0 * kPi, 40);
    b.place(l.at(x, ey, l.deck() + 0.03)).box({0.15, 0.022, 0.03}, 0.006);
  }
  b.colour(colour_from_srgb(kBlue))
      .place(l.upright(x, 0, z + r + 0.008))
      .cylinder(0.075, 0.018, 28);
  b.place(l.upright(x, 0, z + r + 0.032)).cylinder(0.03, 0.010, 18);
  // Level gauge on the left end, filter and pump under it.
  b.colour(colour_from_srgb(kBlue))
      .place(l.at(x + r + 0.002, -0.05, z))
      .box({0.004, 0.012, 0.10}, 0.002);
}

void add_spray_columns(const Layout& l, MeshBuilder& b) {
  const double x = -l.half_base - 0.02, z = l.deck();
  // Pump box at the rear, and a nozzle column on each side of it.
  b.colour(colour_from_srgb(kOrange))
      .place(l.at(-0.60, 0, z + 0.085))
      .box({0.15, 0.30, 0.085}, 0.025);
  b.colour(colour_from_srgb(kBlack));
  for (int i = 0; i < 4; ++i) {
    b.place(l.at(-0.752, 0, z + 0.045 + 0.028 * i)).box({0.004, 0.20, 0.008}, 0.002);
  }
  b.colour(colour_from_srgb(kRed));
  for (const double ey : {-0.26, 0.26}) {
    b.place(l.at(-0.752, ey, z + 0.09)).box({0.006, 0.022, 0.032}, 0.004);
  }
  const double base = z, top = 1.34;
  for (const double ey : {-1.0, 1.0}) {
    const double y = ey * 0.345;
    b.colour(colour_from_srgb(kAluminium)).place(l.at(0, 0, 0));
    b.rod({x, y, base - 0.03}, {x, y, top}, 0.017, 14);
    b.rod({x + 0.20, y, base + 0.01}, {x, y, base + 0.30}, 0.009, 10);
    b.colour(colour_from_srgb(kBlack));
    b.rod({x - 0.026, y, base + 0.02}, {x - 0.026, y, top - 0.04}, 0.009, 10);
    for (int i = 0; i < 5; ++i) {
      const double at = base + 0.10 + 0.155 * i;
      b.colour(colour_from_srgb(kBlack));
      b.rod({x - 0.026, y, at}, {x - 0.026, y + ey * 0.055, at}, 0.011, 12);
      b.colour(colour_from_srgb(kBlue));
      b.rod({x - 0.026, y + ey * 0.055, at}, {x - 0.026, y + ey * 0.085, at}, 0.016, 14);
      b.colour(colour_from_srgb(kYellow));
      b.rod({x - 0.026, y + ey * 0.085, at}, {x - 0.026, y + ey * 0.094, at}, 0.010, 12);
    }
  }
  b.colour(colour_from_srgb(kAluminium)).place(l.at(0, 0, 0));
  b.rod({x, -0.345, top - 0.02}, {x, 0.345, top - 0.02}, 0.013, 12);
  b.rod({x, -0.345, base + 0.30}, {x, 0.345, base + 0.30}, 0.011, 12);
  // Amber beacon in the middle of the cross tube.
  const std::vector<Vector2d> lamp = {{0.034, 0.0}, {0.034, 0.05}, {0.024, 0.068}, {0.0, 0.072}};
  b.colour(colour_from_srgb(0xf28c1e)).place(l.upright(x, 0, 1.325)).lathe(lamp, 18);
}

void add_mast(const Layout& l, MeshBuilder& b) {
  const double x = 0.36, deck = l.deck() + 0.275, top = 1.46;
  b.colour(colour_from_srgb(kAnthracite))
      .place(l.at(x, 0, deck + 0.010))
      .box({0.06, 0.06, 0.012}, 0.004);
  b.colour(colour_from_srgb(kAluminium)).place(l.at(0, 0, 0));
  b.rod({x, 0, deck}, {x, 0, top}, 0.018, 14);
  b.rod({x - 0.14, 0, deck}, {x, 0, deck + 0.26}, 0.009, 10);
  const std::vector<Vector2d> dome = {{0.072, 0.005}, {0.076, 0.022}, {0.070, 0.045},
                                      {0.052, 0.062}, {0.026, 0.072}, {0.0, 0.075}};
  b.place(l.upright(x, 0, top)).cylinder(0.085, 0.005, 28);
  b.colour(colour_from_srgb(kCream)).lathe(dome, 28);
  // Laser scanner ahead of the mast, radio whip beside it.
  const std::vector<Vector2d> scanner = {{0.0, 0.0},     {0.048, 0.0},   {0.048, 0.024},
                                         {0.044, 0.026}, {0.044, 0.058}, {0.048, 0.060},
                                         {0.048, 0.080}, {0.040, 0.086}, {0.0, 0.086}};
  b.colour(colour_from_srgb(kBlack)).place(l.upright(x + 0.13, 0, deck + 0.002)).lathe(scanner, 24);
  b.place(l.at(0, 0, 0));
  b.rod({0.16, 0.26, deck - 0.02}, {0.13, 0.26, deck + 0.48}, 0.004, 8);
}

/// An ultrasonic ranger with its two eyes, looking along yaw.
void add_pod(const Layout& l, double x, double y, double z, double yaw_rad, MeshBuilder& b) {
  Pose pod = l.facing(x, y, z, yaw_rad);
  b.colour(colour_from_srgb(kBlack)).place(pod).box({0.042, 0.018, 0.024}, 0.006);
  b.colour(colour_from_srgb(kAluminium));
  for (const double side : {-0.02, 0.02}) {
    Pose eye = pod;
    eye.p += pod.q * Vector3d(side, 0.022, 0.0);
    b.place(eye).cylinder(0.0145, 0.008, 18);
  }
}

void add_sensors(const Layout& l, MeshBuilder& b) {
  const double z = l.deck() + 0.04;
  for (const double ey : {-1.0, 1.0}) {
    for (const double x : {-0.46, 0.46}) add_pod(l, x, ey * 0.462, z, ey * kPi / 2, b);
    b.colour(colour_from_srgb(kYellow)).place(l.at(-0.69, ey * 0.20, l.deck() + 0.176));
    b.box({0.028, 0.028, 0.008}, 0.003);
    b.colour(colour_from_srgb(kRed)).place(l.upright(-0.69, ey * 0.20, l.deck() + 0.196));
    b.cylinder(0.02, 0.012, 18);
  }
  add_pod(l, l.half_base + 0.135, 0, l.deck() + 0.01, 0.0, b);
  add_pod(l, -l.half_base - 0.09, 0, l.deck() + 0.02, kPi, b);
  b.colour(colour_from_srgb(kAnthracite)).place(l.at(-l.half_base - 0.04, 0, l.deck() - 0.01));
  b.box({0.05, 0.03, 0.012}, 0.003);
  // Tube bumpers between the wheels, low enough to meet a post before the nose does.
  b.place(l.at(0, 0, 0)).colour(colour_from_srgb(kBlack));
  for (const double ex : {-1.0, 1.0}) {
    const double at = ex * (l.half_base + 0.17), low = 0.31;
    b.rod({at, -0.20, low}, {at, 0.20, low}, 0.018, 14);
    for (const double ey : {-0.20, 0.20}) {
      b.rod({at, ey, low}, {ex * (l.half_base + 0.06), ey, l.beam()}, 0.016, 12);
    }
  }
}

}  // namespace

TriangleMesh make_four_wheel_steering_body(const FourWheelSteeringMeshParams& params) {
  const Layout layout = layout_of(params);
  MeshBuilder builder;
  add_frame(layout, builder);
  add_hood(layout, builder);
  add_tank(layout, builder);
  add_spray_columns(layout, builder);
  add_mast(layout, builder);
  add_sensors(layout, builder);
  return builder.take();
}

TriangleMesh make_steering_knuckle(const FourWheelSteeringMeshParams& params,
                                   const Corner& corner) {
  Layout l = layout_of(params);
  l.ground = l.radius;  // origin at the hub
  const double r = l.radius, in = -corner.across, leg = in * (0.5 * l.tyre + 0.035);
  const double head = l.beam() - 0.085;  // top plate, above the mudguard
  MeshBuilder b;
  // Kingpin down from the housing, plate to the inner side, leg down to the hub motor.
  b.colour(colour_from_srgb(kAluminium)).place(l.upright(0, 0, 0.5 * (head + l.beam())));
  b.cylinder(0.030, 0.5 * (l.beam() - head), 20);
  b.colour(colour_from_srgb(kAnthracite));
  b.place(l.at(0, 0.5 * leg, head)).box({0.045, 0.5 * std::abs(leg) + 0.035, 0.012}, 0.005);
  b.place(l.at(0, leg, 0.5 * (head + r))).box({0.042, 0.014, 0.5 * (head - r) + 0.012}, 0.006);
  b.colour(colour_from_srgb(kAluminium)).place(l.at(0, leg + 0.006 * corner.across, r));
  b.cylinder(0.42 * r, 0.028, 28);
  b.colour(colour_from_srgb(kOrange))
      .place(l.at(0, leg + in * 0.026, r))
      .cylinder(0.22 * r, 0.006, 24);
  // Coil spring strut along the leg, and the motor's cable.
  b.place(l.at(0, 0, r)).colour(colour_from_srgb(kOrange));
  b.rod({0.055, leg, 0.02}, {0.030, leg, head - r - 0.015}, 0.013, 12);
  b.colour(colour_from_srgb(kBlack));
  b.rod({-0.05, leg + in * 0.02, 0.0}, {-0.03, leg + in * 0.005, head - r}, 0.006, 8);
  // Mudguard that steers with the wheel.
  b.colour(colour_from_srgb(kOrange)).place(l.at(0, 0, r));
  const double from = corner.along > 0.0 ? rad_from_deg(25) : rad_from_deg(40);
  const double to = corner.along > 0.0 ? rad_from_deg(140) : rad_from_deg(155);
  b.ring_sector(1.14 * r, 1.14 * r + 0.010, 0.5 * l.tyre + 0.006, from, to, 18);
  return b.take();
}

}  // namespace vinerow::vehicles
