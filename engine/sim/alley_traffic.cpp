#include "engine/sim/alley_traffic.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/check.h"
#include "engine/core/constants.h"
#include "engine/core/error.h"

// Plan of the algorithm. Vehicle i is at distance s_i along its plan, whose stretches k need the
// sets needs_k of alleys between start_k and end_k. It has passed the first p_i stretches
// (`passed`) and holds a grant for the first g_i (`granted`), p_i <= g_i. holder(a) is the vehicle
// that holds alley a; i holds exactly the alleys of the stretches p_i .. g_i - 1.
//
//   passing     stretch k is passed when end_k <= s_i - length_i (its tail has left it)
//   stopping    i must stop at start_g - stop_before_i
//   requesting  i requests stretch g_i when s_i + look_ahead_i >= start_g - stop_before_i
//
// Waiting relations, with the set `wanted` = needs_g of a requesting vehicle:
//   W0(i, j)    i requests, and j holds an alley in wanted_i
//   W           transitive closure of W0 (`waits_to_get_`)
//   stuck(i)    W(i, i), or W(i, k) for a k that has stopped or has W(k, k): never served
//   Q(i, k)     i and k request, k earlier; k is not stuck; both want the same alley, which neither
//               of them holds
//   V           transitive closure of W and Q together (`waits_`)
//
// serve() grants the earliest request whose alleys are all free and that is not behind another one:
// i is behind k if Q(i, k) and not V(k, i). Without the last condition, k could block i while it
// waits for i itself. A deadlock exists if some i has W(i, i), or waits for an alley of a vehicle
// that has stopped. With n vehicles each grant costs O(n^3); n is small.

namespace vinerow {
namespace {

void check(const TrafficVehicle& vehicle) {
  const std::pair<const char*, double> lengths[] = {{"length_m", vehicle.length_m},
                                                    {"stop_before_m", vehicle.stop_before_m},
                                                    {"look_ahead_m", vehicle.look_ahead_m},
                                                    {"approach_m", vehicle.use.approach_m},
                                                    {"headland_m", vehicle.use.headland_m}};
  for (const auto& [name, value] : lengths) {
    if (value >= 0.0) continue;
    throw ConfigError(fmt::format("alley traffic: {} of vehicle '{}' is {}, must be >= 0", name,
                                  vehicle.name, value));
  }
}

}  // namespace

AlleyTraffic::AlleyTraffic(std::vector<Alley> alleys, std::vector<TrafficVehicle> vehicles)
    : alleys_(std::move(alleys)), holder_(alleys_.size(), -1) {
  if (vehicles.size() < 2) {
    throw ConfigError(
        fmt::format("alley traffic: {} vehicle{} cannot share alleys, give at least 2",
                    vehicles.size(), vehicles.size() == 1 ? "" : "s"));
  }
  for (const Alley& alley : alleys_) {
    if (alley.line_W.size() >= 2) continue;
    throw ConfigError(
        fmt::format("alley traffic: the centre line of alley {} has {} points, "
                    "must have at least 2",
                    alley.id, alley.line_W.size()));
  }
  for (TrafficVehicle& vehicle : vehicles) {
    check(vehicle);
    for (const Lane& other : lanes_) {
      if (other.self.name != vehicle.name) continue;
      throw ConfigError(fmt::format("alley traffic: vehicle '{}' is named twice", vehicle.name));
    }
    Lane lane;
    lane.self = std::move(vehicle);
    lane.authority.stop_at_m = kInfinity;
    lanes_.push_back(std::move(lane));
  }
  waits_to_get_.assign(lanes_.size() * lanes_.size(), 0);
  waits_ = waits_to_get_;
  is_stuck_.assign(lanes_.size(), 0);
}

void AlleyTraffic::begin(int vehicle, Time now, const PlannedPath& plan, double distance_m) {
  Lane& lane = lanes_[vehicle];
  lane.works = true;
  lane.stays = lane.asks = false;
  lane.distance_m = distance_m;
  lane.stretches = find_alley_stretches(plan, alleys_, lane.self.use);
  lane.passed = 0;
  const int count = static_cast<int>(lane.stretches.size());
  while (lane.passed < count &&
         lane.stretches[lane.passed].end_m <= distance_m - lane.self.length_m) {
    ++lane.passed;
  }
  lane.granted = lane.passed;
  release(vehicle);
  // Take the stretches that the vehicle already stands in, if they are free.
  while (lane.granted < count && lane.stretches[lane.granted].start_m <= distance_m &&
         are_free_for(vehicle, wanted(lane))) {
    take(vehicle, wanted(lane));
    ++lane.granted;
  }
  advance(vehicle, now, distance_m);
}

void AlleyTraffic::advance(int vehicle, Time now, double distance_m) {
  Lane& lane = lanes_[vehicle];
  if (!lane.works) return;
  lane.distance_m = distance_m;
  // Passing: release only after extend(), which may still need the alleys of a passed stretch.
  const int passed = lane.passed;
  const double tail_m = distance_m - lane.self.length_m;
  while (lane.passed < lane.granted && lane.stretches[lane.passed].end_m <= tail_m) ++lane.passed;
  extend(vehicle);
  if (lane.passed != passed) release(vehicle);
  // Requesting.
  if (lane.asks || lane.granted == static_cast<int>(lane.stretches.size())) return;
  const double stop_at_m = lane.stretches[lane.granted].start_m - lane.self.stop_before_m;
  if (distance_m + lane.self.look_ahead_m < stop_at_m) return;
  lane.asks = true;
  lane.since = now;
}

void AlleyTraffic::leave(int vehicle, Leaving leaving) {
  Lane& lane = lanes_[vehicle];
  if (!lane.works) return;
  lane.works = lane.asks = false;
  lane.stays = leaving == Leaving::kStaysThere;
  lane.authority = {};
  lane.authority.stop_at_m = kInfinity;
  // It occupies at most one length behind and ahead of s. Grants beyond that are released.
  const double front_m = lane.distance_m + lane.self.length_m;
  while (lane.granted > lane.passed && lane.stretches[lane.granted - 1].start_m > front_m) {
    --lane.granted;
  }
  if (!lane.stays) lane.granted = lane.passed;
  release(vehicle);
}

void AlleyTraffic::serve() {
  // One grant at a time, because each one changes the waiting relations.
  for (bool has_granted = true; has_granted;) {
    has_granted = false;
    calc_waiting();
    int next = -1;
    for (int i = 0; i < vehicles(); ++i) {
      if (!is_requesting(i) || find_taken(i) >= 0 || is_behind(i)) continue;
      if (next < 0 || requested_earlier(i, next)) next = i;
    }
    if (next < 0) break;
    take(next, wanted(lanes_[next]));
    ++lanes_[next].granted;
    lanes_[next].asks = false;
    extend(next);
    has_granted = true;
  }
  for (int i = 0; i < vehicles(); ++i) write_authority(i);
}

void AlleyTraffic::take(int vehicle, const std::vector<int>& alleys) {
  for (const int alley : alleys) holder_[alley] = vehicle;
}

void AlleyTraffic::release(int vehicle) {
  const Lane& lane = lanes_[vehicle];
  for (std::size_t alley = 0; alley < holder_.size(); ++alley) {
    if (holder_[alley] != vehicle) continue;
    bool is_needed = false;
    for (int i = lane.passed; i < lane.granted && !is_needed; ++i) {
      const std::vector<int>& needs = lane.stretches[i].needs;
      is_needed = std::binary_search(needs.begin(), needs.end(), static_cast<int>(alley));
    }
    if (!is_needed) holder_[alley] = -1;
  }
}

bool AlleyTraffic::are_free_for(int vehicle, const std::vector<int>& alleys) const {
  return std::all_of(alleys.begin(), alleys.end(),
                     [&](int alley) { return holder_[alley] < 0 || holder_[alley] == vehicle; });
}

void AlleyTraffic::extend(int vehicle) {
  Lane& lane = lanes_[vehicle];
  while (lane.granted < static_cast<int>(lane.stretches.size())) {
    const std::vector<int>& needs = wanted(lane);
    if (!std::all_of(needs.begin(), needs.end(),
                     [&](int alley) { return holder_[alley] == vehicle; })) {
      return;
    }
    ++lane.granted;
    lane.asks = false;
  }
}

int AlleyTraffic::find_taken(int vehicle) const {
  for (const int alley : wanted(lanes_[vehicle])) {
    if (holder_[alley] >= 0 && holder_[alley] != vehicle) return alley;
  }
  return -1;
}

bool AlleyTraffic::requested_earlier(int a, int b) const {
  const Time first = lanes_[a].since, second = lanes_[b].since;
  return first.ns != second.ns ? first.ns < second.ns : a < b;
}

bool AlleyTraffic::want_the_same(int a, int b) const {
  const std::vector<int>& others = wanted(lanes_[b]);
  for (const int alley : wanted(lanes_[a])) {
    // An alley that one of them holds is already in W0.
    if (holder_[alley] == a || holder_[alley] == b) continue;
    if (std::binary_search(others.begin(), others.end(), alley)) return true;
  }
  return false;
}

bool AlleyTraffic::is_behind(int vehicle) const {
  for (int i = 0; i < vehicles(); ++i) {
    if (i == vehicle || !is_requesting(i) || !requested_earlier(i, vehicle)) continue;
    if (!want_the_same(i, vehicle)) continue;
    if (!is_stuck_[i] && !at(waits_, i, vehicle)) return true;
  }
  return false;
}

void AlleyTraffic::close_paths(std::vector<char>& leads) const {
  // Warshall's algorithm.
  const int n = vehicles();
  for (int via = 0; via < n; ++via) {
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b < n; ++b) {
        if (at(leads, a, via) != 0 && at(leads, via, b) != 0) at(leads, a, b) = 1;
      }
    }
  }
}

void AlleyTraffic::calc_waiting() {
  const int n = vehicles();
  // W0 and its closure W.
  std::fill(waits_to_get_.begin(), waits_to_get_.end(), 0);
  for (int i = 0; i < n; ++i) {
    if (!is_requesting(i)) continue;
    for (const int alley : wanted(lanes_[i])) {
      const int other = holder_[alley];
      if (other >= 0 && other != i) at(waits_to_get_, i, other) = 1;
    }
  }
  waits_ = waits_to_get_;
  close_paths(waits_to_get_);
  for (int i = 0; i < n; ++i) {
    is_stuck_[i] = at(waits_to_get_, i, i) != 0 ? 1 : 0;
    for (int k = 0; k < n; ++k) {
      const bool never = lanes_[k].stays || at(waits_to_get_, k, k) != 0;
      if (never && at(waits_to_get_, i, k) != 0) is_stuck_[i] = 1;
    }
  }
  // Q, and the closure V of W0 and Q. A stuck vehicle is excluded, so that it does not block the
  // queue forever.
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      if (i == k || !is_requesting(i) || !is_requesting(k) || is_stuck_[k]) continue;
      if (requested_earlier(k, i) && want_the_same(k, i)) at(waits_, i, k) = 1;
    }
  }
  close_paths(waits_);
}

void AlleyTraffic::write_authority(int vehicle) {
  Lane& lane = lanes_[vehicle];
  MovementAuthority& authority = lane.authority;
  authority.stop_at_m = kInfinity;
  authority.alley = -1;
  authority.holder.clear();
  if (!lane.works || lane.granted == static_cast<int>(lane.stretches.size())) return;
  authority.stop_at_m = lane.stretches[lane.granted].start_m - lane.self.stop_before_m;
  if (!lane.asks) return;
  int alley = find_taken(vehicle);
  if (alley >= 0) {
    authority.holder = lanes_[holder_[alley]].self.name;
  } else {
    alley = wanted(lane).front();  // free, but requested earlier by another vehicle
  }
  authority.alley = alleys_[alley].id;
}

std::string AlleyTraffic::describe_cycle(int vehicle) const {
  // steps[i]: length of the shortest chain of W0 from i back to `vehicle`; by[i]: the alley for
  // which i waits on that chain. Bellman-Ford with n rounds.
  const int n = vehicles();
  std::vector<int> steps(n, n + 1), by(n, -1);
  for (int round = 0; round < n; ++round) {
    for (int i = 0; i < n; ++i) {
      if (!is_requesting(i)) continue;
      for (const int alley : wanted(lanes_[i])) {
        const int other = holder_[alley];
        if (other < 0 || other == i) continue;
        const int step_count = other == vehicle ? 1 : steps[other] + 1;
        if (step_count >= steps[i]) continue;
        steps[i] = step_count;
        by[i] = alley;
      }
    }
  }
  std::string text;
  int held = -1;
  int i = vehicle;
  do {
    held = by[i];
    const int id = alleys_[held].id;
    text += text.empty() ? fmt::format(" and waits for alley {}", id)
                         : fmt::format(", which {} holds, waiting for alley {}", name(i), id);
    i = holder_[held];
  } while (i != vehicle);
  return fmt::format("{} holds alley {}{}", name(vehicle), alleys_[held].id, text);
}

std::optional<std::string> AlleyTraffic::deadlock(int vehicle) const {
  if (!is_requesting(vehicle) || is_stuck_[vehicle] == 0) return std::nullopt;
  if (at(waits_to_get_, vehicle, vehicle)) return describe_cycle(vehicle);
  std::optional<std::string> reason;
  for (const int alley : wanted(lanes_[vehicle])) {
    const int other = holder_[alley];
    if (other < 0 || other == vehicle) continue;
    const std::string waits =
        fmt::format("{} waits for alley {}", name(vehicle), alleys_[alley].id);
    if (lanes_[other].stays) return fmt::format("{}, in which {} has stopped", waits, name(other));
    if (reason || is_stuck_[other] == 0) continue;
    // Not a cycle, so the chain of holders ends. It may have been broken since the last serve().
    const std::optional<std::string> further = deadlock(other);
    if (further) reason = fmt::format("{}, which {} holds; {}", waits, name(other), *further);
  }
  return reason;
}

}  // namespace vinerow
