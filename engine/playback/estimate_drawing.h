#pragma once
/// Lines that show an estimated position: trail, marker and 95 % ellipses, after figure 9 of paper
/// C (Donati et al., Remote Sensing 14(6) 1374, 2022).

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "engine/playback/log_trace.h"
#include "engine/render/scene.h"

namespace vinerow::playback {

/// Height of lines above the surface that they follow, so that grass does not hide them.
inline constexpr double kHover_m = 0.06;

struct EstimateLook {
  Eigen::Vector3f colour = {1, 0, 0};
  double down_m = 0.0;    ///< distance of the trail below the body's origin
  double marker_m = 0.2;  ///< from the marker's middle to its ends
  bool is_map = false;    ///< view from straight above: nothing hides the lines
  bool inside = false;    ///< view of a camera on the vehicle: no trail and no marker
};

/// Horizontal ellipse that contains the true position with a probability of 95 %. Its semi-axes are
/// sqrt(-2 ln 0.05 lambda), with the eigenvalues lambda of the covariance in the plane.
/// @param estimate  with a position covariance
/// @param count  number of points, at least 3
/// @returns x and y in W of the points, the first not repeated; empty if the covariance is zero,
///   negative or not finite
std::vector<Eigen::Vector2d> ellipse_95(const Odometry& estimate, int count);

/// Lines from bottom to top: earlier ellipses, the trail until t, the ellipse at t, and a cross
/// hair along the body's axes at the estimated position with a plumb line to the ground. The
/// spacing of earlier ellipses is their length, and at least 1 m.
/// @param ground_m  height of the ground at x, y
/// @returns an empty list before the first estimate
std::vector<render::Polyline> draw_estimate(const Trace<Odometry>& trace, Time t,
                                            const EstimateLook& look,
                                            const std::function<double(double, double)>& ground_m);

}  // namespace vinerow::playback
