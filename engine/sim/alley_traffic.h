#pragma once
/// Reservation of alleys that several vehicles share: movement authority as on railways.
///
/// A vehicle enters a stretch of its plan (alley_stretches.h) only if it holds all alleys that the
/// stretch needs. Each alley has at most one holder. A vehicle requests its next stretch when it is
/// look_ahead_m from the point at which it would have to stop. It gets all alleys of the stretch or
/// none, and releases an alley when its tail has left the last granted stretch that needs it.
/// Requests are served in order of time, then of priority. A later request overtakes an earlier one
/// only if the earlier one cannot be served first anyway. A vehicle therefore waits forever only if
/// it is part of a cycle of vehicles that wait for each other's alleys, or waits, directly or not,
/// for such a cycle or for a vehicle that has stopped in an alley. deadlock() detects and reports
/// this; the order of the plans has to prevent it.
///
/// The class uses no signals and no physics: the caller passes distances in and authorities on.

#include <optional>
#include <string>
#include <vector>

#include "engine/api/messages/path.h"
#include "engine/core/time.h"
#include "engine/sim/alley_stretches.h"

namespace vinerow {

/// A vehicle that shares the alleys.
struct TrafficVehicle {
  std::string name;
  double length_m = 2.0;       ///< from the distance it reports back to its tail
  double stop_before_m = 2.0;  ///< stopping distance before an alley it lacks, front included
  double look_ahead_m = 8.0;   ///< requests this far before that point: more than it needs to stop
  AlleyUse use;
};

class AlleyTraffic {
 public:
  /// @param alleys    shared alleys; the alley of a leg is found by position
  /// @param vehicles  in order of priority
  /// @throws ConfigError for fewer than two vehicles, equal names, lengths below zero; alleys with
  ///   less than two points
  AlleyTraffic(std::vector<Alley> alleys, std::vector<TrafficVehicle> vehicles);

  int vehicles() const { return static_cast<int>(lanes_.size()); }
  const std::string& name(int vehicle) const { return lanes_[vehicle].self.name; }

  /// Starts a vehicle on a plan, for the first time or again. It gets the alleys that it stands in
  /// at once if they are free. Allocates.
  /// @param distance_m  along the plan
  void begin(int vehicle, Time now, const PlannedPath& plan, double distance_m = 0.0);
  /// Updates a vehicle's distance. Call it every tick for every vehicle that has begun, before
  /// serve(). Ignores other vehicles. Does not allocate.
  void advance(int vehicle, Time now, double distance_m);
  /// State of a vehicle that works no longer.
  enum class Leaving {
    kGone,       ///< finished and out of the way: it holds nothing
    kStaysThere  ///< crashed or stopped: the alleys it stands in stay closed
  };
  void leave(int vehicle, Leaving leaving);
  /// Grants requests. Call it every tick, after advance() of all vehicles.
  void serve();

  /// Authority as of the last serve(). It names alleys by Alley::id. Its distance is +infinity for
  /// a vehicle that has not begun or has left.
  const MovementAuthority& authority(int vehicle) const { return lanes_[vehicle].authority; }
  /// Index of the vehicle that holds an alley, -1 if it is free. @param alley  index into the list
  int holder(int alley) const { return holder_[alley]; }
  /// Stretches of a vehicle's plan that need alleys. @pre the vehicle has begun
  const std::vector<AlleyStretch>& stretches(int vehicle) const {
    return lanes_[vehicle].stretches;
  }

  /// Sentence about a vehicle that waits forever, as of the last serve(): "rover holds alley 5 and
  /// waits for alley 6, which drone holds, waiting for alley 5"; "rover waits for alley 6, in which
  /// drone has stopped"; "cart waits for alley 5, which rover holds; rover waits for ...". Empty
  /// for one that can still be served. Allocates if there is a deadlock.
  std::optional<std::string> deadlock(int vehicle) const;

 private:
  struct Lane {
    TrafficVehicle self;
    bool works = false;
    bool stays = false;  ///< works no longer and remains where it is
    std::vector<AlleyStretch> stretches;
    double distance_m = 0.0;
    int passed = 0;   ///< number of stretches that its tail has left
    int granted = 0;  ///< number of stretches granted so far
    bool asks = false;
    Time since;  ///< of the request
    MovementAuthority authority;
  };

  bool is_requesting(int vehicle) const { return lanes_[vehicle].works && lanes_[vehicle].asks; }
  /// Alleys of the next stretch. @pre not all stretches are granted
  const std::vector<int>& wanted(const Lane& lane) const {
    return lane.stretches[lane.granted].needs;
  }
  void take(int vehicle, const std::vector<int>& alleys);
  /// Releases the alleys that no stretch from `passed` to `granted` needs.
  void release(int vehicle);
  /// No other vehicle holds any of these alleys.
  bool are_free_for(int vehicle, const std::vector<int>& alleys) const;
  /// Grants the next stretches that need only alleys the vehicle already holds.
  void extend(int vehicle);
  /// First alley that it requests and another vehicle holds, or -1.
  int find_taken(int vehicle) const;
  /// Another vehicle requested one of the same alleys earlier and can be served first.
  bool is_behind(int vehicle) const;
  bool requested_earlier(int a, int b) const;
  bool want_the_same(int a, int b) const;
  /// Recomputes waits_to_get_, waits_ and is_stuck_.
  void calc_waiting();
  /// Transitive closure of a relation.
  void close_paths(std::vector<char>& leads) const;
  char& at(std::vector<char>& pairs, int a, int b) const { return pairs[a * vehicles() + b]; }
  bool at(const std::vector<char>& pairs, int a, int b) const {
    return pairs[a * vehicles() + b] != 0;
  }
  void write_authority(int vehicle);
  std::string describe_cycle(int vehicle) const;

  std::vector<Alley> alleys_;
  std::vector<Lane> lanes_;
  std::vector<int> holder_;  ///< by alley
  // [a, b]: a waits for b, directly or not. waits_to_get_: for alleys that b holds; waits_: also
  // for b's turn in the queue.
  std::vector<char> waits_to_get_, waits_;
  std::vector<char> is_stuck_;  ///< by vehicle: it can never be served
};

}  // namespace vinerow
