#pragma once
/// Local planner without signals: from pose, speed and steering to a LocalCommand.
///
/// Each tick, in this order: locate the vehicle on the plan; check whether the plan is free over
/// stopping distance and horizon (then the tracking controller may follow it); if not, search a
/// free path beside the plan; choose the best of the sampled commands; or drive back along the
/// trace.

#include <array>

#include "controllers/dwa/dwa_law.h"
#include "controllers/dwa/obstacle_memory.h"
#include "controllers/dwa/plan_ahead.h"
#include "controllers/dwa/recovery.h"
#include "controllers/parts/ground_drive/stop_profile.h"
#include "engine/api/messages/commands.h"

namespace vinerow::controllers {

enum class DwaMode {
  kAssist,  ///< follow the plan while it is free
  kPure     ///< always drive by samples (paper A)
};

struct DwaGuideParams {
  DwaMode mode = DwaMode::kAssist;
  DwaParams law;
  PlanAheadParams plan;
  RecoveryParams recovery;
  double speed_mps = 0.8;  ///< if the plan wants none
  double speed_limit_mps = 1.6;
  double reverse_speed_mps = 0.4;
  double lookahead_m = 1.4;
  double finish_m = 0.3;    ///< nearer to the end the tracking controller takes over
  double reaction_s = 0.3;  ///< delay before braking starts
};

/// An event to report.
struct DwaEvent {
  enum class Kind { kSeen, kReverse, kBlocked, kFollow };
  Kind kind = Kind::kSeen;
  Eigen::Vector2d p_W = Eigen::Vector2d::Zero();  ///< obstacle (kSeen) or vehicle
  double distance_m = 0.0;  ///< to the obstacle; infinity: no obstacle that the map lacks
};

class DwaGuide {
 public:
  /// @param known  must outlive this
  DwaGuide(const DwaGuideParams& params, DiscOutline outline,
           std::vector<Eigen::Vector2d> outline_B, const DistanceField& known);
  DwaGuide(const DwaGuide&) = delete;
  DwaGuide& operator=(const DwaGuide&) = delete;

  /// Takes over a plan. Allocates.
  void set_plan(const PlannedPath& plan, Time now);
  bool has_plan() const { return !plan_.empty(); }
  /// Place along the plan to stop at until the next call; +infinity: none. A stop there is no jam.
  void set_stop(double stop_at_m) { stop_.set_place(stop_at_m); }

  /// One cycle. No heap. @pre has_plan()
  LocalCommand step(Time now, const DwaState& state, const ObstacleMemory& memory);
  /// The oldest event not yet reported. @returns false if there is no further event
  bool take_event(DwaEvent* event);

  int reversals() const { return recovery_.reversals(); }
  double distance_m() const { return plan_.distance_m(); }

 private:
  double wanted_speed_mps() const;
  LocalCommand drive_forward(Time now, const DwaState& state, const ObstacleMemory& memory);
  LocalCommand drive_back(Time now, const DwaState& state);
  DwaChoice choose_forward(const DwaState& state, const ObstacleMemory& memory, double speed_mps);
  LocalCommand make_follow(const DwaState& state, double speed_mps, double free_m) const;
  LocalCommand make_drive(const DwaChoice& choice) const;
  LocalCommand make_stop(const DwaState& state) const;
  double calc_follow_score(double speed_mps, double free_m, const DwaTask& task) const;
  void report_event(DwaEvent::Kind kind, const Eigen::Vector2d& p_W, double distance_m);
  void report_obstacles(Time now, const Pose2& pose, const ObstacleMemory& memory);

  DwaGuideParams params_;
  std::vector<Eigen::Vector2d> outline_B_;
  PointField unknown_;
  FreeSpaceFinder free_space_;
  DwaLaw law_;
  DiscOutline polygon_;  ///< the true outline, for checks of following
  double front_m_ = 0.0;
  double half_width_m_ = 0.0;
  PlanAhead plan_;
  Recovery recovery_;
  StopProfile stop_;
  DrivenTrace trace_;
  LocalPath lane_;
  LocalPath back_;
  double lane_left_m_ = 0.0;
  bool is_off_plan_ = false;
  Time free_since_;
  bool has_seen_ = false;
  Time last_seen_;
  static constexpr int kEventCapacity = 8;
  std::array<DwaEvent, kEventCapacity> events_;
  int event_count_ = 0;
};

}  // namespace vinerow::controllers
