#pragma once
/// A vehicle's true track beside its plan.

#include <vector>

#include "tools/report/line_plot.h"
#include "tools/report/vehicle_log.h"

namespace vinerow::tools::report {

/// One entry for each logged true pose from when there is a plan to when the vehicle stands still
/// for good. NaN where it does not apply.
struct Track {
  std::vector<double> t_s;
  std::vector<double> lateral_m;       ///< true distance from the planned curve, left positive; of
                                       ///< what flies on legs and turns, with wings on legs alone
  std::vector<double> height_error_m;  ///< of what flies, on legs: true height less the plan's
  std::vector<double> heading_rad;     ///< true, continuous
  std::vector<double> plan_heading_rad;  ///< of the planned curve there, next to the true one
  std::vector<double> speed_mps;         ///< true, in space
  std::vector<Eigen::Vector3d> p_W;      ///< true
  std::vector<char> in_turn;
  std::string turns_label;  ///< what its turns are called

  bool empty() const { return t_s.empty(); }
  /// The stretches in which it turns from row to row.
  std::vector<PlotSpan> turns() const;
};

Track make_track(const VehicleLog& vehicle);

/// An empty plot over the time that the vehicle is at work, its turns shaded.
LinePlot plot_of(const Track& track, const std::string& title, const std::string& y_label,
                 const std::string& caption = "");

/// Adds whole turns, so that `angle_rad` is the one next to `near_rad`.
double next_to(double angle_rad, double near_rad);

}  // namespace vinerow::tools::report
