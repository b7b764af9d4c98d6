#pragma once
/// The local planner without signals: from pose, speed and steering to a LocalCommand.
///
/// Each tick, in this order: where is the vehicle on the plan; is the way along the plan free over
/// stopping distance and horizon (then the tracking controller may follow it); if not, is there a
/// way beside the plan; the best of the sampled commands; or back along the trace.

#include <array>

#include "controllers/dwa/dwa_law.h"
#include "controllers/dwa/obstacle_memory.h"
#include "controllers/dwa/plan_ahead.h"
#include "controllers/dwa/recovery.h"
#include "controllers/parts/ground_drive/stop_profile.h"
#include "engine/api/messages/commands.h"

namespace vinerow::controllers {

enum class DwaMode {
  kAssist,  ///< follow the plan where it is free
  kPure     ///< always drive by samples (paper A)
};

struct DwaGuideParams {
  DwaMode mode = DwaMode::kAssist;
  DwaParams law;
  PlanAheadParams plan;
  RecoveryParams recovery;
  double speed_mps = 0.8;  ///< where the plan wants none
  double speed_limit_mps = 1.6;
  double reverse_speed_mps = 0.4;
  double lookahead_m = 1.4;
  double finish_m = 0.3;    ///< so near the end the tracking controller takes over
  double reaction_s = 0.3;  ///< before braking begins
};

/// Something to tell people.
struct DwaNews {
  enum class Kind { kSeen, kReverse, kBlocked, kFollow };
  Kind kind = Kind::kSeen;
  Eigen::Vector2d p_W = Eigen::Vector2d::Zero();  ///< obstacle (kSeen) or vehicle
  double distance_m = 0.0;  ///< to the obstacle; infinity: none that the map does not have
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
  /// Where to stand still until told otherwise, along the plan; +infinity: nowhere. Standing there
  /// is no jam.
  void set_stop(double stop_at_m) { stop_.set_place(stop_at_m); }

  /// One cycle. No heap. @pre has_plan()
  LocalCommand step(Time now, const DwaState& state, const ObstacleMemory& memory);
  /// The oldest news not yet told. @returns false if there is none
  bool take_news(DwaNews* news);

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
  void tell(DwaNews::Kind kind, const Eigen::Vector2d& p_W, double distance_m);
  void tell_what_is_seen(Time now, const Pose2& pose, const ObstacleMemory& memory);

  DwaGuideParams params_;
  std::vector<Eigen::Vector2d> outline_B_;
  PointField unknown_;
  RoomFinder rooms_;
  DwaLaw law_;
  DiscOutline polygon_;  ///< following is checked with the true outline
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
  static constexpr int kNewsCapacity = 8;
  std::array<DwaNews, kNewsCapacity> news_;
  int news_count_ = 0;
};

}  // namespace vinerow::controllers
