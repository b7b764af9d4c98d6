#pragma once
/// True track of a vehicle relative to its plan.

#include <vector>

#include "tools/report/line_plot.h"
#include "tools/report/vehicle_log.h"

namespace vinerow::tools::report {

/// A vehicle that stays slower than this to the end of the log has ended its work. Chosen.
constexpr double kParkedSpeed_mps = 0.02;

/// One entry per logged true pose, from the first plan until the vehicle finally stops. NaN where a
/// value does not apply.
struct Track {
  std::vector<double> t_s;
  std::vector<double> lateral_m;       ///< true distance from the planned curve, left positive;
                                       ///< rotorcraft: on legs and turns, fixed wings: on legs
  std::vector<double> height_error_m;  ///< flying vehicles on legs: true minus planned height
  std::vector<double> heading_rad;     ///< true, continuous
  std::vector<double>
      plan_heading_rad;              ///< of the planned curve there, unwrapped near the true one
  std::vector<double> speed_mps;     ///< true, in space
  std::vector<Eigen::Vector3d> p_W;  ///< true
  std::vector<char> in_turn;
  std::string turns_label;  ///< legend text of the turns

  bool empty() const { return t_s.empty(); }
  bool moves() const;
  /// True from its first to its last entry.
  bool contains(double at_s) const { return !empty() && at_s >= t_s.front() && at_s <= t_s.back(); }
  /// Time spans in which the vehicle turns from row to row.
  std::vector<PlotSpan> turns() const;
};

Track make_track(const VehicleLog& vehicle);

/// Empty plot over the time in which the vehicle is at work, with its turns shaded.
LinePlot plot_of(const Track& track, const std::string& title, const std::string& y_label,
                 const std::string& caption = "");

/// `angle_rad` plus whole turns, so that it is nearest to `near_rad`.
double next_to(double angle_rad, double near_rad);

}  // namespace vinerow::tools::report
