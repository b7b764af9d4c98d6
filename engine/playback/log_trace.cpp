#include "engine/playback/log_trace.h"

#include <algorithm>

namespace vinerow::playback {
namespace {

/// The two samples around an instant, and the instant's share of the time between them, 0 to 1.
struct Bracket {
  std::size_t before;
  std::size_t after;
  double share;
};

Bracket bracket(const std::vector<Time>& times, Time t) {
  const auto next = std::upper_bound(times.begin(), times.end(), t);
  if (next == times.begin()) return {0, 0, 0.0};
  const std::size_t after = static_cast<std::size_t>(next - times.begin());
  if (after == times.size()) return {after - 1, after - 1, 0.0};
  const double span_s = (times[after] - times[after - 1]).s();
  return {after - 1, after, (t - times[after - 1]).s() / span_s};
}

Pose pose_between(const Pose& a, const Pose& b, double share) {
  return {a.q.slerp(share, b.q), a.p + share * (b.p - a.p)};
}

}  // namespace

bool is_truth_of_reading(const record::LogReader& log, const std::string& topic) {
  constexpr std::string_view kEnd = "_truth";
  return topic.ends_with(kEnd) && log.has_topic(topic.substr(0, topic.size() - kEnd.size()));
}

template <class T>
std::size_t Trace<T>::index_at(Time t) const {
  return bracket(times, t).before;
}
template struct Trace<Odometry>;
template struct Trace<LinkPoses>;
template struct Trace<PlannedPath>;
template struct Trace<LineList>;
template struct Trace<RangeSample>;
template struct Trace<LaserScan>;
template struct Trace<CameraShot>;

Odometry odometry_at(const Trace<Odometry>& trace, Time t) {
  const Bracket at = bracket(trace.times, t);
  const Odometry& a = trace.values[at.before];
  const Odometry& b = trace.values[at.after];
  Odometry result = a;
  result.X_WB = pose_between(a.X_WB, b.X_WB, at.share);
  result.v_WB_B = a.v_WB_B + at.share * (b.v_WB_B - a.v_WB_B);
  result.w_WB_B = a.w_WB_B + at.share * (b.w_WB_B - a.w_WB_B);
  result.set_position_covariance((1.0 - at.share) * a.position_covariance() +
                                 at.share * b.position_covariance());
  return result;
}

std::vector<Pose> VehicleTrace::links_at(Time t) const {
  if (links.empty()) return {};
  const Bracket at = bracket(links.times, t);
  const std::vector<Pose>& before = links.values[at.before].X_WL;
  const std::vector<Pose>& after = links.values[at.after].X_WL;
  std::vector<Pose> poses;
  // The number of links may vary between messages of a log by another program.
  for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
    poses.push_back(pose_between(before[i], after[i], at.share));
  }
  return poses;
}

LogTrace read_trace(const record::LogReader& log, const std::vector<std::string>& vehicles,
                    const TraceWishes& wishes) {
  LogTrace trace;
  trace.first = log.info().first;
  trace.last = log.info().last;
  record::LogPass pass(log);
  for (const record::ChannelInfo& channel : log.info().channels) {
    if (channel.topic != "/run/map") continue;
    pass.read<OccupancyGrid>(channel.topic,
                             [&](Time, const OccupancyGrid& map) { trace.map = map; });
  }
  for (const std::string& name : vehicles) {
    VehicleTrace& vehicle = trace.vehicles[name];
    for (const record::ChannelInfo& channel : log.info().channels) {
      const std::string prefix = "/" + name + "/";
      if (channel.topic == prefix + "truth") read_into(pass, channel.topic, vehicle.truth);
      if (channel.topic == prefix + "links") read_into(pass, channel.topic, vehicle.links);
      if (channel.topic == prefix + "plan") read_into(pass, channel.topic, vehicle.plan);
      if (channel.topic == prefix + "plan_tree") read_into(pass, channel.topic, vehicle.plan_tree);
      const auto type = channel.metadata.find("vinerow_type");
      if (type == channel.metadata.end() || !channel.topic.starts_with(prefix)) continue;
      const std::string sensor = channel.topic.substr(prefix.size());
      if (is_truth_of_reading(log, channel.topic)) continue;
      if (type->second == Odometry::kType && wishes.estimates && sensor != "truth") {
        read_into(pass, channel.topic, vehicle.estimates[sensor]);
      }
      if (sensor == "map_edges" && wishes.map_edges) {
        pass.read<LineList>(channel.topic,
                            [&vehicle](Time, const LineList& edges) { vehicle.map_edges = edges; });
      }
      if (type->second == RangeSample::kType) {
        read_into(pass, channel.topic, vehicle.ranges[sensor]);
      }
      if (type->second == LaserScan::kType && wishes.scans) {
        read_into(pass, channel.topic, vehicle.scans[sensor]);
      }
      if (type->second == CameraShot::kType) read_into(pass, channel.topic, vehicle.shots[sensor]);
    }
  }
  pass.run();
  return trace;
}

}  // namespace vinerow::playback
