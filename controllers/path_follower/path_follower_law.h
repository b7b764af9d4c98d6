#pragma once
/// Path following law with feed-forward of the path's curvature.
///
/// Along a path with curvature kappa_ref the lateral error e (positive left) and heading error psi
/// obey e' = sin(psi), psi' = kappa - kappa_ref per metre driven (small e). The law
///   kappa = kappa_ref - sin(psi) 2 zeta / L - e / L^2
/// makes that a linear oscillator per metre with natural length L and damping zeta: errors decay
/// over about L whatever the speed. L is the dynamic lookahead: it grows with speed, because a
/// vehicle's response takes time and not distance, and shrinks in turns, where the speed profile
/// brakes. kappa_ref is the mean over the distance of the coming cycle, so that a perfect vehicle
/// ends each cycle on the path; a response time moves it further ahead.
///
/// psi is measured from the heading that keeps the velocity, not the nose, on the path. A
/// skid-steered vehicle slides outwards in a turn, beta = -arm w / v + beta_0: it turns about a
/// point `arm` ahead of its centre, and slides down a slope by beta_0. So the wanted heading leads
/// the path's by arm * kappa_ref (smoothed, because the nose cannot swing at once) minus beta_0.
/// Feedback of the course itself would be unstable: a harder turn first pushes the centre the other
/// way.
///
/// At a sharp corner (path_corners.h) the vehicle treats the end of the stretch as a goal, turns on
/// the spot and continues: its place on the path never runs ahead of the corner before that.

#include <limits>
#include <vector>

#include "controllers/parts/ground_drive/stop_profile.h"
#include "controllers/parts/paths/path_curve.h"
#include "controllers/path_follower/speed_profile.h"
#include "engine/api/messages/commands.h"

namespace vinerow::controllers {

/// Sideslip angle beta = -arm w / v + drift.
struct Sideslip {
  double arm_m = 0.0;
  double drift_rad = 0.0;
};

struct PathFollowerParams {
  double lookahead_s = 0.7;  ///< L = lookahead_s * v, within the two limits
  double lookahead_min_m = 0.6;
  double lookahead_max_m = 3.0;
  double damping = 1.0;          ///< zeta
  double integral = 0.0;         ///< of e over distance, as a share of 1/L^3
  double integral_max_m = 0.15;  ///< largest lateral offset of the integral
  double response_s = 0.0;
  double smoothing_m = 0.5;  ///< half the length over which the lead of the heading builds up
  double settle_m = 0.5;     ///< distance before a turn at which braking for it has ended
  double max_curvature_per_m = 2.0;
  double yaw_rate_max_radps = 1.2;
  double goal_tolerance_m = 0.05;
  double cycle_s = 0.025;
  SpeedLimits speed;
};

class PathFollowerLaw {
 public:
  explicit PathFollowerLaw(const PathFollowerParams& params)
      : params_(params), stop_(params.speed.acceleration_mps2) {}

  /// Takes over a path. Allocates. A path without length is finished at once.
  void set_path(const PlannedPath& plan);
  /// Place along the path to stop at until the next call; +infinity: none.
  void set_stop(double stop_at_m) { stop_.set_place(stop_at_m); }

  /// One cycle. No heap.
  /// @param slide         sideslip of the vehicle; zero for pure rolling
  /// @param overspeed_mps  speed minus commanded speed
  VelocityCommand step(const Pose2& pose, const Sideslip& slide = {}, double overspeed_mps = 0.0);

  bool has_path() const { return has_path_; }
  bool finished() const { return finished_; }
  const Path& path() const { return path_; }
  FollowerState state() const { return state_; }

 private:
  /// Start and end of the vehicle's stretch between two sharp corners.
  double stretch_start_m() const {
    return corners_passed_ == 0 ? -std::numeric_limits<double>::infinity()
                                : corners_m_[corners_passed_ - 1];
  }
  double stretch_end_m() const {
    return corners_passed_ == corners_m_.size() ? std::numeric_limits<double>::infinity()
                                                : corners_m_[corners_passed_];
  }
  Path::Nearest find_place(const Pose2& pose) const;
  /// Turns on the spot towards the next stretch.
  VelocityCommand turn_on_the_spot(const Path::Nearest& at, double heading_error_rad);
  double calc_lookahead_m(double speed_mps) const;
  double calc_speed(const Path::Nearest& at, double heading_error_rad);
  double calc_yaw_rate(const Path::Nearest& at, double heading_error_rad, const Sideslip& slide,
                       double speed_mps);

  PathFollowerParams params_;
  Path path_;
  std::vector<double> corners_m_;  ///< distances of the sharp corners
  std::size_t corners_passed_ = 0;
  bool is_turning_ = false;  ///< on the spot
  SpeedProfile profile_;
  StopProfile stop_;
  FollowerState state_;
  bool has_path_ = false;
  bool finished_ = false;
  double distance_m_ = 0.0;
  double speed_mps_ = 0.0;
  double integral_m_ = 0.0;  ///< as lateral offset
};

}  // namespace vinerow::controllers
