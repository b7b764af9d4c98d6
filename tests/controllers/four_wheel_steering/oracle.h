#pragma once
/// The twelve reference cases of a 4WS rover with a = b = 0.75 m, track 0.85 m, wheels of 0.2 m:
/// axle angles and speed -> wheel angles, ICR, yaw rate, wheel speeds (fl fr rl rr). Computed by
/// another implementation (../shared/reference/A_cooperation.md, section 3).

#include <array>
#include <limits>

#include "controllers/four_wheel_steering/axle_geometry.h"
#include "engine/math/angles.h"

namespace vinerow::test {

struct OracleCase {
  double front_deg, rear_deg, speed_mps;
  std::array<double, 4> wheel_deg;
  std::array<double, 2> icr_m;
  double yaw_rate_radps;
  std::array<double, 4> wheel_radps;
  bool saturated = false;  ///< a wheel is at its limit: rolling speeds cannot be had

  AxleAngles axles() const { return {rad_from_deg(front_deg), rad_from_deg(rear_deg)}; }
};

constexpr double kFar_m = std::numeric_limits<double>::infinity();

inline constexpr std::array<OracleCase, 12> kOracle = {{
    {0, 0, 1, {0, 0, 0, 0}, {kFar_m, kFar_m}, 0, {5, 5, 5, 5}},
    {10, 10, 1, {10, 10, 10, 10}, {kFar_m, kFar_m}, 0, {5, 5, 5, 5}},
    {10, -10, 1, {11.08, 9.11, -11.08, -9.11}, {0, 4.253}, .2351, {4.5860, 5.5698, 4.5860, 5.5698}},
    {-10,
     10,
     1,
     {-9.11, -11.08, 9.11, 11.08},
     {0, -4.253},
     -.2351,
     {5.5698, 4.5860, 5.5698, 4.5860}},
    {23,
     -23,
     .8,
     {29.20, 18.89, -29.20, -18.89},
     {0, 1.767},
     .4528,
     {3.4801, 5.2446, 3.4801, 5.2446}},
    {15, 0, 1, {16.17, 13.98, 0, 0}, {-.750, 5.598}, .1771, {4.7681, 5.4948, 4.5795, 5.3320}},
    {0, -12, .6, {0, 0, -12.74, -11.34}, {.750, 7.057}, .0845, {2.8035, 3.1629, 2.8744, 3.2258}},
    {18,
     5,
     1,
     {19.21, 16.93, 5.36, 4.69},
     {-1.303, 6.318},
     .1550,
     {4.8367, 5.4632, 4.5876, 5.2439}},
    {5,
     18,
     1,
     {4.69, 5.36, 16.93, 19.21},
     {1.303, -6.318},
     -.1550,
     {5.2439, 4.5876, 5.4632, 4.8367}},
    {12,
     -8,
     -.7,
     {13.29, 10.94, -8.88, -7.28},
     {-.153, 4.248},
     -.1647,
     {-3.2344, -3.9188, -3.1860, -3.8789}},
    {10, 9.99, 1, {10, 10, 9.99, 9.99}, {-1469, 8335}, .0001, {4.9998, 5.0003, 4.9997, 5.0002}},
    {10, -10, 1.6, {11.08, 9.11, -11.08, -9.11}, {0, 4.253}, .3762, {6.7169, 8, 6.7169, 8}, true},
}};

}  // namespace vinerow::test
