#pragma once
/// Lines that show where an estimate thinks a vehicle is: trail, marker and 95 % ellipses, after
/// figure 9 of paper C (Donati et al., Remote Sensing 14(6) 1374, 2022).

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "engine/playback/log_trace.h"
#include "engine/render/scene.h"

namespace vinerow::playback {

/// Lines hover this much above what they follow, so that grass does not swallow them.
inline constexpr double kHover_m = 0.06;

struct EstimateLook {
  Eigen::Vector3f colour = {1, 0, 0};
  double down_m = 0.0;    ///< the trail runs so far below the body's origin
  double marker_m = 0.2;  ///< from the marker's middle to its ends
  bool is_map = false;    ///< seen straight from above: nothing hides it
  bool inside = false;    ///< seen by a camera on the vehicle: no trail and no marker
};

/// The horizontal ellipse that holds the true position with 95 %: semi-axes are
/// sqrt(-2 ln 0.05 lambda), lambda the eigenvalues of the covariance in the plane.
/// @param estimate  with a position covariance
/// @param count  of points, at least 3
/// @returns x and y in W of the points, the first not repeated; empty where the covariance is zero,
///   negative or not finite
std::vector<Eigen::Vector2d> ellipse_95(const Odometry& estimate, int count);

/// Lines from below to above: earlier ellipses, the trail until t, the ellipse at t, and a cross
/// hair along the body's axes at the estimated position with a plumb line to the ground. Earlier
/// ellipses are as far apart as they are long, and at least 1 m.
/// @param ground_m  height of the ground at x, y
/// @returns nothing before the first estimate
std::vector<render::Polyline> draw_estimate(const Trace<Odometry>& trace, Time t,
                                            const EstimateLook& look,
                                            const std::function<double(double, double)>& ground_m);

}  // namespace vinerow::playback
