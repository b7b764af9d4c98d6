#include "vehicles/diff_drive_rover/rover_mesh.h"

#include <array>
#include <vector>

#include "engine/math/angles.h"
#include "vehicles/parts/chassis.h"
#include "vehicles/parts/mesh_builder.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr unsigned kWhite = 0xeef0ea;
constexpr unsigned kGreen = 0x2e7d32;
constexpr unsigned kDarkGreen = 0x1d5423;
constexpr unsigned kSteel = 0x3a3d40;
constexpr unsigned kBlack = 0x1a1b1d;
constexpr unsigned kAluminium = 0xb4b8bc;
constexpr unsigned kGlass = 0x16263f;
constexpr unsigned kOrange = 0xf28c1e;
constexpr unsigned kRed = 0xc62828;
constexpr unsigned kLamp = 0xfff3c8;

/// Everything is laid out for the default size and stretched with it.
struct Layout {
  double half_base, half_track, radius, tyre, ground;

  /// Pose of a frame at (x, y, z), z from the ground.
  Pose at(double x, double y, double z) const {
    return {Eigen::Quaterniond::Identity(), {x, y, z - ground}};
  }
  double inner() const { return half_track - 0.5 * tyre - 0.05; }  // half width between the wheels
};

Eigen::Quaterniond turn(double angle_rad, const Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis));
}

void add_frame(const Layout& l, MeshBuilder& b) {
  const double x = l.half_base, r = l.radius, w = l.inner();
  // Two longitudinal tubes, cross members, and a tub for the batteries between them.
  b.colour(colour_from_srgb(kSteel));
  for (const double side : {-1.0, 1.0}) {
    b.place(l.at(0, side * (w - 0.03), r + 0.09)).box({x + 0.06, 0.03, 0.035}, 0.008);
  }
  for (const double at : {-x, -0.3 * x, 0.3 * x, x}) {
    b.place(l.at(at, 0, r + 0.09)).box({0.03, w - 0.05, 0.028}, 0.006);
  }
  b.colour(colour_from_srgb(kBlack));
  b.place(l.at(0, 0, r + 0.085)).box({0.62 * x, 0.72 * w, 0.07}, 0.02);
  // Gear motors and their brackets at the wheels.
  for (const double ex : {-1.0, 1.0}) {
    for (const double ey : {-1.0, 1.0}) {
      const double hub_y = ey * (l.half_track - 0.5 * l.tyre);
      b.colour(colour_from_srgb(kAluminium));
      b.place(l.at(ex * x, hub_y - ey * 0.055, r)).cylinder(0.32 * r, 0.05, 20);
      b.colour(colour_from_srgb(kSteel));
      b.place(l.at(ex * x, hub_y - ey * 0.13, r)).cylinder(0.24 * r, 0.03, 16);
      b.place(l.at(ex * x, ey * (w - 0.02), r + 0.045)).box({0.05, 0.022, 0.075}, 0.008);
      b.colour(colour_from_srgb(kOrange));
      b.place(l.at(0, 0, 0));
      b.rod({ex * (x - 0.16), ey * (w + 0.006), r + 0.10},
            {ex * (x - 0.03), ey * (w + 0.006), r + 0.015}, 0.006, 8);
    }
  }
}

void add_mudguards(const Layout& l, MeshBuilder& b) {
  const double r = l.radius;
  for (const double ex : {-1.0, 1.0}) {
    for (const double ey : {-1.0, 1.0}) {
      const double from = ex > 0.0 ? rad_from_deg(18) : rad_from_deg(35);
      const double to = ex > 0.0 ? rad_from_deg(145) : rad_from_deg(162);
      b.colour(colour_from_srgb(kGreen));
      b.place(l.at(ex * l.half_base, ey * l.half_track, r));
      b.ring_sector(1.20 * r, 1.20 * r + 0.012, 0.5 * l.tyre + 0.018, from, to, 16);
      b.colour(colour_from_srgb(kDarkGreen));
      b.place(l.at(ex * l.half_base, ey * (l.half_track + 0.5 * l.tyre + 0.012), r));
      b.ring_sector(1.13 * r, 1.20 * r + 0.002, 0.006, from, to, 16);
      // Stay from the frame to the mudguard's crown.
      b.colour(colour_from_srgb(kSteel));
      b.place(l.at(ex * l.half_base, ey * 0.5 * (l.inner() + l.half_track), r + 1.2 * r - 0.006));
      b.box({0.018, 0.5 * (l.half_track - l.inner()) + 0.03, 0.008}, 0.002);
    }
  }
}

void add_shell(const Layout& l, MeshBuilder& b) {
  const double x = l.half_base, w = l.inner() - 0.005, z = l.radius + 0.14;
  // Side view of the body: low nose, flat deck, cut tail; heights above z.
  const std::vector<Vector2d> side = {{-x - 0.06, 0.00},  {x + 0.04, 0.00},  {x + 0.10, 0.05},
                                      {x + 0.07, 0.13},   {x - 0.20, 0.235}, {x - 0.32, 0.255},
                                      {-x + 0.02, 0.255}, {-x - 0.07, 0.20}, {-x - 0.09, 0.05}};
  b.colour(colour_from_srgb(kWhite)).place(l.at(0, 0, z)).extrude(side, w, 0.03);
  // Green flanks with a dark grille, proud of the shell by some millimetres.
  const std::vector<Vector2d> flank = {{-x + 0.06, 0.045}, {x - 0.03, 0.045}, {x - 0.12, 0.125},
                                       {x - 0.30, 0.20},   {-x + 0.12, 0.20}, {-x + 0.04, 0.13}};
  const std::vector<Vector2d> grille = {
      {-0.10, 0.075}, {0.22, 0.075}, {0.19, 0.165}, {-0.10, 0.165}};
  for (const double ey : {-1.0, 1.0}) {
    b.colour(colour_from_srgb(kGreen)).place(l.at(0, ey * w, z)).extrude(flank, 0.008, 0.004);
    b.colour(colour_from_srgb(kBlack))
        .place(l.at(-0.2 * x, ey * w, z))
        .extrude(grille, 0.011, 0.003);
    b.colour(colour_from_srgb(kSteel));
    for (int i = 0; i < 4; ++i) {
      b.place(l.at(-0.2 * x + 0.045, ey * (w + 0.011), z + 0.088 + 0.022 * i));
      b.box({0.13 - 0.005 * i, 0.003, 0.005}, 0.0);
    }
    b.colour(colour_from_srgb(kRed)).place(l.at(-x - 0.085, ey * (w - 0.06), z + 0.10));
    b.box({0.008, 0.03, 0.018}, 0.004);
  }
  // Bonnet stripe along the sloping nose.
  const Vector3d low(x + 0.07, 0, 0.13), high(x - 0.20, 0, 0.235);
  const double slope = std::atan2(high.z() - low.z(), low.x() - high.x());
  Pose nose = l.at(0.5 * (low.x() + high.x()), 0, z + 0.5 * (low.z() + high.z()) + 0.001);
  nose.q = turn(slope, Vector3d::UnitY());
  b.colour(colour_from_srgb(kGreen))
      .place(nose)
      .box({0.5 * (high - low).norm() - 0.015, 0.42 * w, 0.005}, 0.002);
}

void add_deck(const Layout& l, MeshBuilder& b) {
  const double x = l.half_base, w = l.inner(), deck = l.radius + 0.14 + 0.255;
  // Solar panel with its frame and cell lines.
  b.colour(colour_from_srgb(kAluminium)).place(l.at(0.16 * x, 0, deck + 0.012));
  b.box({0.40 * x, 0.80 * w, 0.012}, 0.004);
  b.colour(colour_from_srgb(kGlass));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      b.place(l.at(0.16 * x + (i - 1) * 0.255 * x, (j - 1) * 0.51 * w, deck + 0.0245));
      b.box({0.12 * x, 0.245 * w, 0.002}, 0.0);
    }
  }
  // Battery box at the rear with lid, latches and the emergency stop.
  b.colour(colour_from_srgb(kSteel)).place(l.at(-0.66 * x, 0, deck + 0.065));
  b.box({0.20, 0.74 * w, 0.065}, 0.015);
  b.colour(colour_from_srgb(kGreen))
      .place(l.at(-0.66 * x, 0, deck + 0.137))
      .box({0.205, 0.76 * w, 0.012}, 0.006);
  b.colour(colour_from_srgb(kAluminium));
  for (const double ey : {-0.4, 0.4}) {
    b.place(l.at(-0.66 * x - 0.204, ey * w, deck + 0.115)).box({0.006, 0.02, 0.025}, 0.002);
  }
  b.colour(colour_from_srgb(0xf2c230)).place(l.at(-0.66 * x - 0.10, 0.5 * w, deck + 0.155));
  b.box({0.03, 0.03, 0.008}, 0.003);
  const std::array<Vector2d, 4> knob = {
      Vector2d{0.0, 0.02}, {0.02, 0.016}, {0.022, 0.0}, {0.012, -0.012}};
  Pose stop = l.at(-0.66 * x - 0.10, 0.5 * w, deck + 0.178);
  stop.q = turn(kPi / 2, Vector3d::UnitX());
  const std::vector<Vector2d> knob_up(knob.rbegin(), knob.rend());
  b.colour(colour_from_srgb(kRed)).place(stop).lathe(knob_up, 16);
}

void add_mast(const Layout& l, MeshBuilder& b) {
  const double x = l.half_base, deck = l.radius + 0.14 + 0.255, mast_x = -0.30 * x, top = 1.42;
  b.place(l.at(0, 0, 0)).colour(colour_from_srgb(kAluminium));
  b.rod({mast_x, 0, deck}, {mast_x, 0, top}, 0.018, 14);
  b.rod({mast_x + 0.16, 0, deck}, {mast_x, 0, deck + 0.34}, 0.009, 10);
  b.colour(colour_from_srgb(kSteel));
  b.place(l.at(mast_x, 0, deck + 0.012)).box({0.06, 0.06, 0.012}, 0.004);
  // GNSS antenna: a mushroom on a ground plate.
  Pose upright = l.at(mast_x, 0, top);
  upright.q = turn(kPi / 2, Vector3d::UnitX());  // y of the lathe points up
  b.place(upright).colour(colour_from_srgb(kAluminium));
  b.cylinder(0.085, 0.005, 28);
  const std::vector<Vector2d> dome = {{0.072, 0.005}, {0.076, 0.022}, {0.070, 0.045},
                                      {0.052, 0.062}, {0.026, 0.072}, {0.0, 0.075}};
  b.colour(colour_from_srgb(0xf7f8f4)).lathe(dome, 28);
  // Amber beacon on a short arm, and a radio whip.
  b.place(l.at(0, 0, 0)).colour(colour_from_srgb(kSteel));
  b.rod({mast_x, 0, 1.16}, {mast_x, -0.12, 1.16}, 0.007, 8);
  Pose beacon = l.at(mast_x, -0.12, 1.16);
  beacon.q = upright.q;
  const std::vector<Vector2d> lamp = {{0.032, 0.0}, {0.032, 0.045}, {0.022, 0.062}, {0.0, 0.066}};
  b.colour(colour_from_srgb(kOrange)).place(beacon).lathe(lamp, 18);
  b.place(l.at(0, 0, 0)).colour(colour_from_srgb(kBlack));
  b.rod({-x + 0.04, -0.75 * l.inner(), deck - 0.01}, {-x - 0.01, -0.75 * l.inner(), deck + 0.52},
        0.004, 8);
}

void add_sensors(const Layout& l, MeshBuilder& b) {
  const double x = l.half_base, front = x + 0.16, z = l.radius + 0.20, half = l.half_track - 0.08;
  // Sensor bar across the nose on two brackets, with ultrasound eyes, camera and lamps.
  b.colour(colour_from_srgb(kSteel));
  for (const double ey : {-0.55, 0.55}) {
    b.place(l.at(x + 0.115, ey * l.inner(), z - 0.03)).box({0.05, 0.014, 0.022}, 0.004);
  }
  b.colour(colour_from_srgb(kBlack)).place(l.at(front, 0, z)).box({0.026, half, 0.034}, 0.010);
  Pose eye;
  eye.q = turn(-kPi / 2, Vector3d::UnitZ());  // y of the cylinder points forward
  for (const double ey : {-0.92, -0.5, 0.0, 0.5, 0.92}) {
    for (const double pair : {-0.028, 0.028}) {
      if (ey == 0.0 && pair > 0.0) continue;
      eye.p = l.at(front + 0.028, ey == 0.0 ? 0.0 : ey * half + pair, z).p;
      b.place(eye).colour(colour_from_srgb(ey == 0.0 ? kGlass : kAluminium));
      b.cylinder(ey == 0.0 ? 0.024 : 0.017, 0.006, 18);
    }
  }
  for (const double ey : {-0.26, 0.26}) {
    eye.p = l.at(front + 0.027, ey * half, z).p;
    b.place(eye).colour(colour_from_srgb(kLamp)).cylinder(0.026, 0.006, 20);
  }
  // Laser scanner above the nose.
  Pose upright = l.at(x - 0.26, 0, l.radius + 0.14 + 0.255);
  upright.q = turn(kPi / 2, Vector3d::UnitX());
  b.colour(colour_from_srgb(kSteel))
      .place(l.at(x - 0.26, 0, l.radius + 0.14 + 0.26))
      .box({0.06, 0.06, 0.014}, 0.004);
  const std::vector<Vector2d> scanner = {{0.0, 0.014},   {0.048, 0.014}, {0.048, 0.036},
                                         {0.044, 0.038}, {0.044, 0.07},  {0.048, 0.072},
                                         {0.048, 0.092}, {0.040, 0.098}, {0.0, 0.098}};
  b.colour(colour_from_srgb(kBlack)).place(upright).lathe(scanner, 24);
  // Tube bumpers front and rear.
  b.colour(colour_from_srgb(kSteel)).place(l.at(0, 0, 0));
  for (const double ex : {-1.0, 1.0}) {
    const double at = ex * (x + 0.13), low = l.radius + 0.06, w = l.inner();
    b.rod({at, -0.62 * w, low}, {at, 0.62 * w, low}, 0.016, 12);
    for (const double ey : {-1.0, 1.0}) {
      b.rod({at, ey * 0.62 * w, low}, {ex * (x + 0.02), ey * 0.9 * w, low + 0.03}, 0.016, 12);
    }
  }
}

}  // namespace

TriangleMesh make_rover_mesh(const ChassisParams& params) {
  const Layout layout{0.5 * params.wheel_base_m, 0.5 * params.track_m, params.wheel_radius_m,
                      params.tyre_width_m, params.com_height_m};
  MeshBuilder builder;
  add_frame(layout, builder);
  add_mudguards(layout, builder);
  add_shell(layout, builder);
  add_deck(layout, builder);
  add_mast(layout, builder);
  add_sensors(layout, builder);
  return builder.take();
}

}  // namespace vinerow::vehicles
