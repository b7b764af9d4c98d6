#pragma once
/// Who may drive or fly where among rows that several vehicles share: movement authority as on
/// railways.
///
/// A stretch of a plan (alley_stretches.h) is entered only by a vehicle that holds all alleys it
/// needs, and each alley has one holder at a time. A vehicle asks for the next stretch when it is
/// look_ahead_m from where it would have to stand, gets all its alleys or none, and gives an alley
/// back when its tail has left the last stretch granted that needs it. Requests are served in the
/// order of asking, then of priority. A later one overtakes an earlier one only where that one
/// cannot be served before it anyway. So whoever waits for ever is part of, or stands before, a
/// circle of vehicles each of which waits for what the next one holds, or a vehicle that stays
/// where it stands: deadlock() tells. Circles are found and told, not avoided: that is the order of
/// the plans.
///
/// No signals, no physics: the caller tells distances and passes the authorities on.

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
  double length_m = 2.0;       ///< its tail is so far behind the distance it tells
  double stop_before_m = 2.0;  ///< stands so far before what it has not got; its front fits in
  double look_ahead_m = 8.0;   ///< asks so far before that place: more than it takes to stop
  AlleyUse use;
};

class AlleyTraffic {
 public:
  /// @param alleys    those to be shared; which of them a leg runs in is found by place
  /// @param vehicles  in the order of priority
  /// @throws ConfigError for fewer than two vehicles, equal names, lengths below zero; alleys with
  ///   less than two points
  AlleyTraffic(std::vector<Alley> alleys, std::vector<TrafficVehicle> vehicles);

  int vehicles() const { return static_cast<int>(lanes_.size()); }
  const std::string& name(int vehicle) const { return lanes_[vehicle].self.name; }

  /// A vehicle begins to work along a plan, for the first time or again. What it stands in it gets
  /// at once where nobody has it. Allocates.
  /// @param distance_m  along the plan
  void begin(int vehicle, Time now, const PlannedPath& plan, double distance_m = 0.0);
  /// Every tick, of every vehicle that has begun; before serve(). Others are passed over. No heap.
  void advance(int vehicle, Time now, double distance_m);
  /// What a vehicle leaves behind that works no more.
  enum class Leaving {
    kGone,       ///< finished and out of the way: it holds nothing
    kStaysThere  ///< crashed or stopped: the alleys it stands in stay closed
  };
  void leave(int vehicle, Leaving leaving);
  /// Every tick, after all have told their distances.
  void serve();

  /// As of the last serve(). Alleys are told by Alley::id. Of a vehicle that has not begun or has
  /// left: +infinity.
  const MovementAuthority& authority(int vehicle) const { return lanes_[vehicle].authority; }
  /// Index of the vehicle that has an alley, -1 for nobody. @param alley  index into the list
  int holder(int alley) const { return holder_[alley]; }
  /// Distances between which a vehicle needs which alleys. @pre it has begun
  const std::vector<AlleyStretch>& stretches(int vehicle) const {
    return lanes_[vehicle].stretches;
  }

  /// A sentence about vehicles that wait for ever, as of the last serve(): "rover holds alley 5 and
  /// waits for alley 6, which drone holds, waiting for alley 5"; "rover waits for alley 6, in which
  /// drone has stopped". Allocates where there is one.
  std::optional<std::string> deadlock() const;

 private:
  struct Lane {
    TrafficVehicle self;
    bool works = false;
    bool stays = false;  ///< works no more, stands where it is
    std::vector<AlleyStretch> stretches;
    double distance_m = 0.0;
    int passed = 0;   ///< stretches its tail has left
    int granted = 0;  ///< stretches it has got
    bool asks = false;
    Time since;
    MovementAuthority authority;
  };

  bool is_asking(int vehicle) const { return lanes_[vehicle].works && lanes_[vehicle].asks; }
  /// Of a vehicle that has not got all of its stretches.
  const std::vector<int>& wanted(const Lane& lane) const {
    return lane.stretches[lane.granted].needs;
  }
  void take(int vehicle, const std::vector<int>& alleys);
  /// Gives back what no stretch from `passed` to `granted` needs.
  void release(int vehicle);
  /// Nobody else has one of these.
  bool are_free_for(int vehicle, const std::vector<int>& alleys) const;
  /// Grants what needs nothing more than is held.
  void extend(int vehicle);
  /// The first alley that it asks for and another one has, -1 if there is none.
  int find_taken(int vehicle) const;
  /// Another one asked earlier for one of the same alleys and can be served first.
  bool is_behind(int vehicle) const;
  bool asked_earlier(int a, int b) const;
  bool want_the_same(int a, int b) const;
  /// Works out who waits for whom.
  void calc_waiting();
  void close_paths(std::vector<char>& leads) const;
  char& at(std::vector<char>& pairs, int a, int b) const { return pairs[a * vehicles() + b]; }
  bool at(const std::vector<char>& pairs, int a, int b) const {
    return pairs[a * vehicles() + b] != 0;
  }
  void write_authority(int vehicle);
  std::string tell_circle(int vehicle) const;

  std::vector<Alley> alleys_;
  std::vector<Lane> lanes_;
  std::vector<int> holder_;  ///< by alley
  // Who waits for whom, directly or not: for what the other one holds; and also in the queue.
  std::vector<char> waits_to_get_, waits_;
  std::vector<char> is_stuck_;  ///< by vehicle: is never served
};

}  // namespace vinerow
