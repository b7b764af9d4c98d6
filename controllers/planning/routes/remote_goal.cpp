#include "controllers/planning/routes/remote_goal.h"

#include <fmt/format.h>

#include <optional>

#include "controllers/planning/routes/place_route.h"
#include "engine/api/messages/event.h"
#include "engine/api/messages/motion.h"
#include "engine/api/messages/path.h"
#include "engine/api/parameter_table.h"
#include "engine/api/sees_ground.h"

namespace vinerow::controllers {
namespace {

struct RemoteGoalParams {
  bool keeps_heading = true;
  PlaceRouteParams route;
};

const ParameterTable<RemoteGoalParams>& remote_goal_table() {
  using P = RemoteGoalParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .boolean("goal_heading", &P::keeps_heading,
                   "true: arrive with the goal's heading; false: with any")
          .include(&P::route, place_route_table());
  return table;
}

/// The plan depends on the goal, the estimate at the tick and the map alone, so a replay of the
/// goals gives the same plans.
class RemoteGoal final : public Guidance, public SeesGround {
 public:
  RemoteGoal(const RemoteGoalParams& params, const ControllerContext& context,
             const std::string& who)
      : keeps_heading_(params.keeps_heading),
        part_(context.part),
        route_(params.route, *context.vehicle_description, context.map, context, who) {
    context.vehicle_description->need_wheeled(who);
  }

  void see_ground(const SceneQuery& ground) override { ground_ = &ground; }

  void connect(Ports& ports) override {
    goal_ = ports.read_from_outside<PoseTarget>("goal_pose");
    estimate_ = ports.read<Odometry>("estimate");
    plan_ = ports.write<PlannedPath>("plan");
    event_ = ports.write<Event>("guidance_event");
  }

  void step(Time now) override {
    if (!estimate_.has_value() || !goal_.is_newer_than(seen_goal_)) return;
    const Pose& goal = goal_.value().X_WB;
    const double yaw_rad = yaw_from_quaternion(goal.q);
    const Result<PlannedPath> path =
        route_.find(estimate_.value().X_WB, {goal.p.head<2>()},
                    keeps_heading_ ? std::optional(yaw_rad) : std::nullopt, ground_);
    if (!path) {
      report(now, Event::Level::kWarning,
             fmt::format("the goal is refused: {}; the vehicle keeps its plan", path.reason()));
      return;
    }
    plan_.write(now, *path);
    report(now, Event::Level::kInfo,
           fmt::format("goal ({:.2f}, {:.2f}): planned {:.2f} m with {} points", goal.p.x(),
                       goal.p.y(), path->length_m, path->points.size()));
  }

 private:
  void report(Time now, Event::Level level, const std::string& text) {
    event_.write(now, {level, part_, text});
  }

  bool keeps_heading_;
  std::string part_;
  PlaceRoute route_;
  const SceneQuery* ground_ = nullptr;
  std::uint64_t seen_goal_ = 0;
  SignalReader<PoseTarget> goal_;
  SignalReader<Odometry> estimate_;
  SignalWriter<PlannedPath> plan_;
  SignalWriter<Event> event_;
};

}  // namespace

PartSpec remote_goal_spec() {
  PartSpec spec;
  spec.name = "remote_goal";
  spec.description =
      "Drives to goals from outside the run (goal_pose): plans a path from the estimate to each "
      "new goal as the planner go_to does, for a path follower.";
  remote_goal_table().add_to(spec);
  spec.default_rate_Hz = 5.0;
  spec.reads = {"estimate", "goal_pose"};
  spec.writes = {"plan", "guidance_event"};
  return spec;
}

std::unique_ptr<Guidance> make_remote_goal(const ParameterSet& parameters,
                                           const ControllerContext& context) {
  const std::string who = context.part + " (remote_goal)";
  return std::make_unique<RemoteGoal>(remote_goal_table().read(parameters, who), context, who);
}

}  // namespace vinerow::controllers
