#pragma once
/// Recovery of a blocked vehicle: it drives back a little along its own trace and tries again, a
/// few times. Then it stops, and tries again periodically. Every kLookBack-th try drives back
/// farther first: from there the sensors see obstacles that are beside their cones at close range.

#include <vector>

#include "controllers/dwa/local_path.h"
#include "engine/core/time.h"

namespace vinerow::controllers {

/// Past poses of the vehicle. Fixed capacity: the last kCapacity * kPitch_m metres.
class DrivenTrace {
 public:
  static constexpr int kCapacity = 90;
  static constexpr double kPitch_m = 0.05;

  DrivenTrace() : poses_(kCapacity) {}
  void clear() { count_ = 0; }
  /// While driving forward: adds the pose if it is new.
  void record(const Pose2& pose);
  /// While driving backwards: removes the poses that the vehicle has passed.
  void drive_back(const Pose2& pose);
  /// The path back, nearest first, with the original headings.
  void copy_back(LocalPath* path) const;
  int size() const { return count_; }

 private:
  std::vector<Pose2> poses_;  // oldest first
  int count_ = 0;
};

struct RecoveryParams {
  double stall_s = 2.0;      ///< no progress for this long is a jam
  double stopped_s = 0.5;    ///< a stop without admissible motion for this long is a jam
  double reverse_s = 2.0;    ///< longest drive back
  int max_recoveries = 3;    ///< then it stops
  double retry_s = 5.0;      ///< period of tries after that
  double look_back_s = 6.0;  ///< longest drive back of every kLookBack-th try
  double progress_m = 0.05;  ///< less along the plan is no progress
  double past_m = 1.0;       ///< a jam is forgotten this far past its place
};

/// State machine of the recovery; it uses times and distances only.
class Recovery {
 public:
  enum class State { kForward, kReverse, kStop };
  enum class Change { kNone, kReverse, kStop };

  explicit Recovery(const RecoveryParams& params) : params_(params) {}
  void reset(Time now);

  State state() const { return state_; }
  int reversals() const { return reversals_; }
  /// True from the start of a jam until the vehicle is past_m past it.
  bool is_in_trouble() const { return recoveries_ > 0 || is_reported_; }

  /// Every tick of kForward. @param distance_m  along the plan  @param is_free  the plan is
  /// followed freely  @param can_move  an admissible motion was found
  Change forward(Time now, double distance_m, double v_mps, bool is_free, bool can_move);
  /// Every tick of kReverse. @param can_move  backwards
  void reverse(Time now, double distance_m, double v_mps, bool can_move);
  /// Every tick of kStop.
  void stand(Time now, double distance_m);

 private:
  double reverse_time_s() const {
    return is_looking_back_ ? params_.look_back_s : params_.reverse_s;
  }
  void try_again(Time now, double distance_m);

  RecoveryParams params_;
  State state_ = State::kForward;
  static constexpr int kLookBack = 4;
  int recoveries_ = 0;
  int tries_ = 0;      // from a stop
  int reversals_ = 0;  // since reset()
  bool is_reported_ = false;
  double jam_m_ = 0.0;
  double progress_m_ = 0.0;
  Time progress_;
  Time moving_;
  bool is_reversing_ = false;
  bool is_looking_back_ = false;
  Time until_;
};

}  // namespace vinerow::controllers
