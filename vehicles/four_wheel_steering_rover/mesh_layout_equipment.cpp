/// What the rover carries.

#include <vector>

#include "vehicles/four_wheel_steering_rover/mesh_layout.h"

namespace vinerow::vehicles {
namespace {

using namespace livery;
using Eigen::Vector2d;
using Eigen::Vector3d;

void add_tank(const MeshLayout& l, MeshBuilder& b) {
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

void add_spray_columns(const MeshLayout& l, MeshBuilder& b) {
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

void add_mast(const MeshLayout& l, MeshBuilder& b) {
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
void add_pod(const MeshLayout& l, double x, double y, double z, double yaw_rad, MeshBuilder& b) {
  Pose pod = l.facing(x, y, z, yaw_rad);
  b.colour(colour_from_srgb(kBlack)).place(pod).box({0.042, 0.018, 0.024}, 0.006);
  b.colour(colour_from_srgb(kAluminium));
  for (const double side : {-0.02, 0.02}) {
    Pose eye = pod;
    eye.p += pod.q * Vector3d(side, 0.022, 0.0);
    b.place(eye).cylinder(0.0145, 0.008, 18);
  }
}

void add_sensors(const MeshLayout& l, MeshBuilder& b) {
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

void add_equipment(const MeshLayout& layout, MeshBuilder& builder) {
  add_tank(layout, builder);
  add_spray_columns(layout, builder);
  add_mast(layout, builder);
  add_sensors(layout, builder);
}

}  // namespace vinerow::vehicles
