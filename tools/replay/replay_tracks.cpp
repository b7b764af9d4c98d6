#include "tools/replay/replay_tracks.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>

#include "engine/api/world_model.h"
#include "engine/math/statistics.h"
#include "engine/playback/vehicle_colours.h"
#include "tools/replay/replay_plans.h"

namespace vinerow::tools {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "tracks copy memory as little-endian");

constexpr double kMaxRate_Hz = 10.0, kMinRate_Hz = 0.1;
/// A link that moves less than this relative to its vehicle counts as fixed. Chosen.
constexpr double kFixed_m = 5e-4, kFixed_rad = 2e-3;
/// A link turns too fast for its samples if three quarters of the angles between them exceed this.
constexpr double kSpin_rad = 1.0;
template <class T>
std::size_t append_block(std::string& bytes, const std::vector<T>& values) {
  while (bytes.size() % 4 != 0) bytes += '\0';
  const std::size_t begin = bytes.size();
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  return begin;
}

template <class T>
T steps_of(double value, double step) {
  return static_cast<T>(std::clamp<double>(
      std::round(value / step), std::numeric_limits<T>::lowest(), std::numeric_limits<T>::max()));
}

/// Makes the signs of successive quaternions consistent (q and -q are the same rotation).
template <class T>
void append_rotations(const std::vector<Eigen::Quaterniond>& rotations, std::vector<T>& values) {
  Eigen::Quaterniond last = Eigen::Quaterniond::Identity();
  for (Eigen::Quaterniond q : rotations) {
    q.normalize();
    if (q.dot(last) < 0.0) q.coeffs() *= -1.0;
    for (const double c : {q.x(), q.y(), q.z(), q.w()}) {
      values.push_back(steps_of<T>(c, 1.0 / 32767.0));
    }
    last = q;
  }
}

/// Samples of one vehicle.
struct Samples {
  std::vector<Time> times;
  std::vector<Pose> X_WB;
  std::vector<std::vector<Pose>> X_BL;  ///< [link][sample]
};

bool same(const Pose& a, const Pose& b) {
  return (a.p - b.p).norm() < kFixed_m && a.q.angularDistance(b.q) < kFixed_rad;
}

/// Sample times: every 1 / rate_Hz, or the times of the logged poses if those are fewer. Logged
/// poses may be sparse, and false stamps may be centuries apart.
std::vector<Time> sample_times(const playback::VehicleTrace& trace, double rate_Hz) {
  const std::vector<Time>& poses = trace.truth.times;
  const Time first = poses.front(), last = poses.back();
  const double count = std::ceil((last - first).s() * rate_Hz);
  std::vector<Time> times;
  if (count > static_cast<double>(poses.size() + trace.links.times.size())) {
    std::set_union(poses.begin(), poses.end(), trace.links.times.begin(), trace.links.times.end(),
                   std::back_inserter(times));
    std::erase_if(times, [&](Time t) { return t < first || t > last; });
    return times;
  }
  for (std::int64_t k = 0; k <= static_cast<std::int64_t>(count); ++k) {
    times.push_back(std::min(last, first + duration_from_s(static_cast<double>(k) / rate_Hz)));
  }
  return times;
}

Samples take_samples(const playback::VehicleTrace& trace, std::size_t links, double rate_Hz) {
  Samples all;
  all.X_BL.resize(links);
  for (const Time t : sample_times(trace, rate_Hz)) {
    all.times.push_back(t);
    all.X_WB.push_back(trace.truth_at(t).X_WB);
    const std::vector<Pose> X_WL = trace.links_at(t);
    for (std::size_t l = 0; l < links; ++l) {
      all.X_BL[l].push_back(l < X_WL.size() ? all.X_WB.back().inverse() * X_WL[l] : Pose{});
    }
  }
  // A sample that equals both neighbours is redundant.
  const auto still = [&](std::size_t a, std::size_t b) {
    if (!same(all.X_WB[a], all.X_WB[b])) return false;
    return std::all_of(all.X_BL.begin(), all.X_BL.end(),
                       [&](const auto& poses) { return same(poses[a], poses[b]); });
  };
  Samples kept;
  kept.X_BL.resize(links);
  std::size_t last_kept = 0;
  for (std::size_t i = 0; i < all.times.size(); ++i) {
    // Compare with the last kept sample, so that slow creeping is not dropped.
    const bool inside = i > 0 && i + 1 < all.times.size();
    if (inside && still(i, i + 1) && still(i, last_kept)) continue;
    last_kept = i;
    kept.times.push_back(all.times[i]);
    kept.X_WB.push_back(all.X_WB[i]);
    for (std::size_t l = 0; l < links; ++l) kept.X_BL[l].push_back(all.X_BL[l][i]);
  }
  return kept;
}

/// Axis, in the link, about which it spins; nullopt if the samples resolve its rotation.
std::optional<Eigen::Vector3d> spin_axis(const playback::Trace<LinkPoses>& links, std::size_t link,
                                         const playback::Trace<Odometry>& truth) {
  std::vector<double> turns_rad;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::optional<Eigen::Quaterniond> last;
  for (std::size_t i = 0; i < links.values.size(); ++i) {
    if (link >= links.values[i].X_WL.size()) return std::nullopt;
    const Eigen::Quaterniond q = playback::odometry_at(truth, links.times[i]).X_WB.q.conjugate() *
                                 links.values[i].X_WL[link].q;
    if (last) {
      const Eigen::AngleAxisd turn(last->conjugate() * q);
      const double angle_rad = std::abs(std::remainder(turn.angle(), 2.0 * EIGEN_PI));
      if (angle_rad > kFixed_rad) {
        turns_rad.push_back(angle_rad);
        sum += turn.axis().cwiseAbs();
      }
    }
    last = q;
  }
  if (turns_rad.size() < 4) return std::nullopt;
  if (value_in_order(turns_rad, 3 * turns_rad.size() / 4) < kSpin_rad) return std::nullopt;
  Eigen::Index axis = 0;
  sum.maxCoeff(&axis);
  return Eigen::Vector3d(Eigen::Vector3d::Unit(axis));
}

json fixed_pose(const Pose& X_BL) {
  return {X_BL.p.x(), X_BL.p.y(), X_BL.p.z(), X_BL.q.x(), X_BL.q.y(), X_BL.q.z(), X_BL.q.w()};
}

json link_index(const std::string& name, const std::vector<Pose>& X_BL,
                const std::optional<Eigen::Vector3d>& spin, std::string& bytes) {
  json index = {{"name", name}, {"pose", fixed_pose(X_BL.front())}};
  double moved_m = 0.0, turned_rad = 0.0;
  for (const Pose& pose : X_BL) {
    moved_m = std::max(moved_m, (pose.p - X_BL.front().p).norm());
    turned_rad = std::max(turned_rad, pose.q.angularDistance(X_BL.front().q));
  }
  if (moved_m > kFixed_m) {
    std::vector<std::int16_t> positions;
    for (const Pose& pose : X_BL) {
      for (int c = 0; c < 3; ++c) positions.push_back(steps_of<std::int16_t>(pose.p[c], 1e-3));
    }
    index["positions"] = append_block(bytes, positions);
  }
  if (spin) {
    std::vector<std::uint8_t> spins;
    for (std::size_t i = 0; i < X_BL.size(); ++i) {
      const std::size_t next = std::min(i + 1, X_BL.size() - 1),
                        from = std::min(i, next - (next > 0));
      spins.push_back(X_BL[from].q.angularDistance(X_BL[next].q) > kFixed_rad);
    }
    index["spins"] = append_block(bytes, spins);
    index["axis"] = {spin->x(), spin->y(), spin->z()};
  } else if (turned_rad > kFixed_rad) {
    std::vector<Eigen::Quaterniond> rotations;
    for (const Pose& pose : X_BL) rotations.push_back(pose.q);
    std::vector<std::int16_t> values;
    append_rotations(rotations, values);
    index["rotations"] = append_block(bytes, values);
  }
  return index;
}

json vehicle_index(const ReplayInput& input, std::size_t v, double rate_Hz, std::string& bytes) {
  const scenario::VehicleConfig& config = input.scenario->vehicles[v];
  const Vehicle& vehicle = *(*input.vehicles)[v];
  const playback::VehicleTrace& trace = input.trace->vehicles.at(config.name);
  const VehicleDescription& description = vehicle.description();
  const Samples samples = take_samples(trace, vehicle.links().size(), rate_Hz);

  std::vector<std::uint32_t> times;
  std::vector<std::int32_t> positions;
  std::vector<Eigen::Quaterniond> rotations;
  for (std::size_t i = 0; i < samples.times.size(); ++i) {
    times.push_back(steps_of<std::uint32_t>((samples.times[i] - input.trace->first).s(), 1e-3));
    for (int c = 0; c < 3; ++c) {
      positions.push_back(steps_of<std::int32_t>(samples.X_WB[i].p[c], 1e-3));
    }
    rotations.push_back(samples.X_WB[i].q);
  }
  std::vector<std::int16_t> rotation_values;
  append_rotations(rotations, rotation_values);

  json index = {
      {"name", config.name},
      {"type", config.vehicle.type},
      {"index", v},
      {"colour", playback::hex_colour(playback::vehicle_colour(v).rgb)},
      {"flies", description.flies()},
      {"foot_m", description.height_above_ground_m},
      {"size_m", 2.0 * description.collision_half_extents_m.head<2>().maxCoeff()},
      {"top_m", description.collision_centre_B.z() + description.collision_half_extents_m.z()},
      {"samples", times.size()}};
  index["times"] = append_block(bytes, times);
  index["positions"] = append_block(bytes, positions);
  index["rotations"] = append_block(bytes, rotation_values);
  if (description.flies() && input.world->terrain) {
    std::vector<float> heights_m;
    for (const Pose& X_WB : samples.X_WB) {
      heights_m.push_back(
          static_cast<float>(X_WB.p.z() - input.world->terrain->height_m(X_WB.p.x(), X_WB.p.y())));
    }
    index["heights"] = append_block(bytes, heights_m);
  }
  index["links"] = json::array();
  for (std::size_t l = 0; l < vehicle.links().size(); ++l) {
    index["links"].push_back(link_index(vehicle.links()[l].name, samples.X_BL[l],
                                        spin_axis(trace.links, l, trace.truth), bytes));
  }
  return index;
}

}  // namespace

ReplayTracks make_replay_tracks(const ReplayInput& input, const ReplayLimits& limits) {
  ReplayTracks tracks;
  tracks.index["vehicles"] = json::array();
  std::vector<std::size_t> shown;
  for (std::size_t v = 0; v < input.vehicles->size(); ++v) {
    const std::string& name = input.scenario->vehicles[v].name;
    const auto trace = input.trace->vehicles.find(name);
    if (trace == input.trace->vehicles.end() || trace->second.truth.empty()) {
      tracks.notes.push_back(
          fmt::format("'{}' is not shown: the log has no true poses of it", name));
      continue;
    }
    shown.push_back(v);
  }
  if (input.vehicles->empty()) tracks.notes.push_back("the run has no vehicles");

  double rate_Hz = kMaxRate_Hz;
  const auto sample_all = [&] {
    tracks.bytes.clear();
    tracks.index["vehicles"] = json::array();
    for (const std::size_t v : shown) {
      tracks.index["vehicles"].push_back(vehicle_index(input, v, rate_Hz, tracks.bytes));
    }
  };
  sample_all();
  while (tracks.bytes.size() > limits.track_bytes && rate_Hz > kMinRate_Hz) {
    rate_Hz *= 0.5;
    sample_all();
  }
  if (rate_Hz < kMaxRate_Hz) {
    tracks.notes.push_back(fmt::format(
        "poses are sampled {:.2g} times a second, with straight motion between", rate_Hz));
  }
  add_plans(input, limits, tracks);
  return tracks;
}

}  // namespace vinerow::tools
