#pragma once
/// What to do when there is no way ahead: go back a little along the own trace and try again, a
/// few times; then stand, and try again now and then. Every kLookBack-th try goes back farther
/// first: from there the sensors see what lies beside their cones when they are close up.

#include <vector>

#include "controllers/dwa/local_path.h"
#include "engine/core/time.h"

namespace vinerow::controllers {

/// The poses the vehicle came along. Fixed capacity: the last kCapacity * kPitch_m metres.
class DrivenTrace {
 public:
  static constexpr int kCapacity = 90;
  static constexpr double kPitch_m = 0.05;

  DrivenTrace() : poses_(kCapacity) {}
  void clear() { count_ = 0; }
  /// Forward: adds the pose if it is new.
  void record(const Pose2& pose);
  /// Backwards: forgets what the vehicle has driven back.
  void drive_back(const Pose2& pose);
  /// The way back, nearest first, headings as they were.
  void copy_back(LocalPath* path) const;
  int size() const { return count_; }

 private:
  std::vector<Pose2> poses_;  // oldest first
  int count_ = 0;
};

struct RecoveryParams {
  double stall_s = 2.0;      ///< no progress for this long is a jam
  double stopped_s = 0.5;    ///< so is standing with no admissible motion for this long
  double reverse_s = 2.0;    ///< longest way back
  int max_recoveries = 3;    ///< then it stands
  double retry_s = 5.0;      ///< and tries again this often
  double look_back_s = 6.0;  ///< longest way back of a look from afar
  double progress_m = 0.05;  ///< less along the plan is none
  double past_m = 1.0;       ///< this far past the place of a jam, it is forgotten
};

/// The state machine; knows times and distances only.
class Recovery {
 public:
  enum class State { kForward, kReverse, kStand };
  enum class Change { kNone, kReverse, kStand };

  explicit Recovery(const RecoveryParams& params) : params_(params) {}
  void reset(Time now);

  State state() const { return state_; }
  int reversals() const { return reversals_; }
  /// True from the start of a jam until it lies past_m behind.
  bool is_in_trouble() const { return recoveries_ > 0 || is_told_; }

  /// Every tick of kForward. @param distance_m  along the plan  @param is_free  the plan is
  /// followed freely  @param can_move  an admissible motion was found
  Change forward(Time now, double distance_m, double v_mps, bool is_free, bool can_move);
  /// Every tick of kReverse. @param can_move  backwards
  void reverse(Time now, double distance_m, double v_mps, bool can_move);
  /// Every tick of kStand.
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
  int tries_ = 0;      // from standing
  int reversals_ = 0;  // since reset()
  bool is_told_ = false;
  double jam_m_ = 0.0;
  double progress_m_ = 0.0;
  Time progress_;
  Time moving_;
  bool is_reversing_ = false;
  bool is_looking_back_ = false;
  Time until_;
};

}  // namespace vinerow::controllers
