#include "controllers/planning/car_planners.h"

#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/goals/GoalState.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <limits>

#include "controllers/planning/bounded_nearest.h"
#include "engine/math/angles.h"

namespace vinerow {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

/// A generator that only this planner uses: OMPL seeds its own from the clock.
class SeededRrtStar final : public og::RRTstar {
 public:
  SeededRrtStar(const ob::SpaceInformationPtr& si, std::uint_fast32_t seed, double radius_m)
      : RRTstar(si) {
    rng_.setLocalSeed(seed);
    nn_ = std::make_shared<BoundedNearest<Motion*>>(
        [radius_m](Motion* const& from, Motion* const& to) {
          const Pose2 a = CarSpace::pose_of(from->state), b = CarSpace::pose_of(to->state);
          // A way is at least as long as the straight line, and as the arc that turns the heading.
          return std::max((b.p - a.p).norm(),
                          radius_m * std::abs(wrap_angle(b.yaw_rad - a.yaw_rad)) - 1e-9);
        });
  }

  std::vector<std::pair<Pose2, Pose2>> edges() const {
    std::vector<Motion*> motions;
    nn_->list(motions);
    std::vector<std::pair<Pose2, Pose2>> edges;
    for (const Motion* motion : motions) {
      if (motion->parent == nullptr) continue;
      edges.emplace_back(CarSpace::pose_of(motion->parent->state),
                         CarSpace::pose_of(motion->state));
    }
    return edges;
  }
  std::int64_t nodes() const { return static_cast<std::int64_t>(nn_->size()); }
};

class SeededRrtConnect final : public og::RRTConnect {
 public:
  SeededRrtConnect(const ob::SpaceInformationPtr& si, std::uint_fast32_t seed) : RRTConnect(si) {
    rng_.setLocalSeed(seed);
  }

  std::int64_t nodes() const { return static_cast<std::int64_t>(tStart_->size() + tGoal_->size()); }
};

/// Space, problem and random stream of one run; outlives the planner.
struct Setup {
  Setup(const CarProblem& problem, CarSampling& sampling, RandomStream& random) {
    // Reports of what goes right and wrong come through results here, never on the console.
    ompl::msg::noOutputHandler();
    auto space = std::make_shared<CarSpace>(problem.radius_m, problem.low_W, problem.high_W);
    space->setStateSamplerAllocator([&sampling, &random](const ob::StateSpace* of) {
      return std::make_shared<CarSampler>(of->as<CarSpace>(), sampling, random);
    });
    si = std::make_shared<ob::SpaceInformation>(space);
    si->setStateValidityChecker([footprint = problem.footprint](const ob::State* state) {
      return footprint->is_free(CarSpace::pose_of(state));
    });
    si->setMotionValidator(
        std::make_shared<CarMotionValidator>(si, *problem.footprint, problem.check_step_m));
    si->setup();
    definition = std::make_shared<ob::ProblemDefinition>(si);
    ob::ScopedState<CarSpace> start(si), goal(si);
    CarSpace::set_pose(sampling.from, start.get());
    CarSpace::set_pose(sampling.to, goal.get());
    constexpr double kAtTheGoal_m = 1e-6;
    definition->setStartAndGoalStates(start, goal, kAtTheGoal_m);
    definition->setOptimizationObjective(std::make_shared<CarObjective>(si, *problem.cost));
  }

  std::vector<Pose2> way() const {
    std::vector<Pose2> poses;
    if (!definition->hasExactSolution()) return poses;
    const auto* path = definition->getSolutionPath()->as<og::PathGeometric>();
    for (std::size_t i = 0; i < path->getStateCount(); ++i) {
      poses.push_back(CarSpace::pose_of(path->getState(static_cast<unsigned int>(i))));
    }
    return poses;
  }

  ob::SpaceInformationPtr si;
  ob::ProblemDefinitionPtr definition;
};

}  // namespace

CarTree run_rrt_star(const CarProblem& problem, CarSampling sampling, RandomStream random) {
  const auto seed = static_cast<std::uint_fast32_t>(random.next_u64() >> 32);
  Setup setup(problem, sampling, random);
  SeededRrtStar planner(setup.si, seed, problem.radius_m);
  // Ways found on the way narrow down where to look.
  const auto known = sampling.best_cost;
  sampling.best_cost = [&planner, known] {
    const double own = planner.bestCost().value();
    return own < known() ? own : known();
  };
  planner.setRange(problem.range_m);
  planner.setProblemDefinition(setup.definition);
  planner.setup();
  ob::IterationTerminationCondition stop(static_cast<unsigned int>(problem.iterations));
  planner.solve(stop);
  return {setup.way(), planner.bestCost().value(), planner.nodes(), planner.edges()};
}

CarTree run_rrt_connect(const CarProblem& problem, CarSampling sampling, RandomStream random) {
  const auto seed = static_cast<std::uint_fast32_t>(random.next_u64() >> 32);
  Setup setup(problem, sampling, random);
  SeededRrtConnect planner(setup.si, seed);
  planner.setRange(problem.range_m);
  planner.setProblemDefinition(setup.definition);
  planner.setup();
  ob::IterationTerminationCondition stop(static_cast<unsigned int>(problem.iterations));
  planner.solve(stop);
  return {setup.way(), 0.0, planner.nodes(), {}};
}

}  // namespace vinerow
