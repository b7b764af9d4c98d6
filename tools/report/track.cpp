#include "tools/report/track.h"

#include <algorithm>
#include <cmath>

#include "engine/api/plan_stretch.h"
#include "engine/math/angles.h"

namespace vinerow::tools::report {
namespace {

/// Time after the end of the work that is still shown. Chosen.
constexpr double kShown_s = 2.0;

/// Index after the last shown sample.
std::size_t end_of_work(const playback::Trace<Odometry>& truth) {
  std::size_t last = 0;
  for (std::size_t i = 0; i < truth.values.size(); ++i) {
    if (truth.values[i].v_WB_B.norm() > kParkedSpeed_mps) last = i;
  }
  std::size_t end = last;
  while (end < truth.times.size() && (truth.times[end] - truth.times[last]).s() <= kShown_s) ++end;
  return end;
}

/// Latest reference of a fixed wing's guidance at t; null before the first. @param at  start index
/// of the search, advanced
const AirReference* last_reported(const playback::Trace<AirReference>& trace, Time t,
                                  std::size_t& at) {
  while (at + 1 < trace.times.size() && trace.times[at + 1] <= t) ++at;
  return at < trace.times.size() && trace.times[at] <= t ? &trace.values[at] : nullptr;
}

struct PlaceValues {
  double lateral_m = kNone, height_error_m = kNone, heading_rad = kNone;
  bool in_turn = false;
};

PlaceValues values_at(PlanStretch& plan, const Odometry& truth, const VehicleLog& vehicle) {
  PlaceValues values;
  const Eigen::Vector3d& p = truth.X_WB.p;
  const PlanStretch::Place at = plan.find(p);
  const bool leg = plan.is_leg(at.segment);
  values.in_turn = plan.is(PathKind::kTurn, at.segment);
  if (vehicle.flies && !leg && !values.in_turn) return values;
  if (vehicle.has_wings && plan.lane(p, truth.X_WB.q * truth.v_WB_B) < 0) return values;
  const auto& nearest = plan.line().nearest_within(p.head<2>(), at.segment, at.segment);
  const double distance_m = vehicle.flies ? at.lateral_m : plan.curve_distance_m(at, p.head<2>());
  values.lateral_m = std::copysign(distance_m, nearest.signed_distance_m);
  if (vehicle.flies && leg) values.height_error_m = p.z() - at.plan_z_m;
  const PathPoint& here = plan.points()[at.segment];
  values.heading_rad = here.yaw_rad;
  if (at.segment + 1 < static_cast<int>(plan.points().size())) {
    const double next_rad = next_to(plan.points()[at.segment + 1].yaw_rad, here.yaw_rad);
    values.heading_rad += at.fraction * (next_rad - here.yaw_rad);
  }
  return values;
}

}  // namespace

double next_to(double angle_rad, double near_rad) {
  return near_rad + wrap_angle(angle_rad - near_rad);
}

bool Track::moves() const {
  return std::any_of(speed_mps.begin(), speed_mps.end(),
                     [](double speed) { return speed > kParkedSpeed_mps; });
}

Track make_track(const VehicleLog& vehicle) {
  Track track;
  if (vehicle.truth.empty()) return track;
  track.turns_label = vehicle.has_wings ? "turns between lanes" : "turns between rows";
  const std::size_t end = end_of_work(vehicle.truth);
  PlanStretch plan;
  std::size_t plans_seen = 0, air_at = 0;
  double heading_rad = yaw_from_quaternion(vehicle.truth.values.front().X_WB.q);
  for (std::size_t i = 0; i < end; ++i) {
    const Time t = vehicle.truth.times[i];
    const Odometry& truth = vehicle.truth.values[i];
    while (plans_seen < vehicle.plan.times.size() && vehicle.plan.times[plans_seen] <= t) {
      plan.take_over(vehicle.plan.values[plans_seen++]);
    }
    const bool waits = !vehicle.plan.empty() && !plan.has_plan();
    if (waits) continue;
    PlaceValues values;
    if (plan.has_plan()) values = values_at(plan, truth, vehicle);
    if (const AirReference* reference = last_reported(vehicle.air_reference, t, air_at)) {
      values.in_turn = reference->phase == AirReference::Phase::kTurn;
      const bool straight = reference->phase == AirReference::Phase::kStraight;
      if (!straight) values.lateral_m = values.height_error_m = kNone;
    }
    heading_rad = next_to(yaw_from_quaternion(truth.X_WB.q), heading_rad);
    track.t_s.push_back(t.s());
    track.lateral_m.push_back(values.lateral_m);
    track.height_error_m.push_back(values.height_error_m);
    track.heading_rad.push_back(heading_rad);
    track.plan_heading_rad.push_back(next_to(values.heading_rad, heading_rad));
    track.speed_mps.push_back(truth.v_WB_B.norm());
    track.p_W.push_back(truth.X_WB.p);
    track.in_turn.push_back(values.in_turn ? 1 : 0);
  }
  return track;
}

LinePlot plot_of(const Track& track, const std::string& title, const std::string& y_label,
                 const std::string& caption) {
  LinePlot plot;
  plot.title = title;
  plot.y_label = y_label;
  plot.caption = caption;
  plot.spans = track.turns();
  plot.spans_label = track.turns_label;
  return plot;
}

std::vector<PlotSpan> Track::turns() const {
  std::vector<PlotSpan> spans;
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    if (!in_turn[i]) continue;
    if (i == 0 || !in_turn[i - 1]) spans.push_back({t_s[i], t_s[i]});
    spans.back().to = t_s[i];
  }
  return spans;
}

}  // namespace vinerow::tools::report
