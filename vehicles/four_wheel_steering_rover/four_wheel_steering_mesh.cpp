#include "vehicles/four_wheel_steering_rover/four_wheel_steering_mesh.h"

#include <vector>

#include "vehicles/four_wheel_steering_rover/mesh_layout.h"

namespace vinerow::vehicles {
namespace {

using namespace livery;
using Eigen::Vector2d;
using Eigen::Vector3d;

void add_frame(const MeshLayout& l, MeshBuilder& b) {
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

void add_hood(const MeshLayout& l, MeshBuilder& b) {
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

}  // namespace

TriangleMesh make_four_wheel_steering_body(const ChassisParams& params) {
  const MeshLayout layout(params);
  MeshBuilder builder;
  add_frame(layout, builder);
  add_hood(layout, builder);
  add_equipment(layout, builder);
  return builder.take();
}

TriangleMesh make_steering_knuckle(const ChassisParams& params, const Corner& corner) {
  MeshLayout l(params);
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
