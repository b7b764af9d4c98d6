#include "controllers/planning/search/car_planners.h"

#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/goals/GoalState.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

#include <algorithm>

#include "controllers/planning/search/bounded_nearest.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

/// One of OMPL's tree planners with our nearest neighbours and its own generator: OMPL seeds its
/// generators from the clock.
template <typename Base>
class Seeded final : public Base {
 public:
  Seeded(const ob::SpaceInformationPtr& si, std::uint_fast32_t seed, double radius_m,
         double range_m)
      : Base(si) {
    this->rng_.setLocalSeed(seed);
    this->nn_ = std::make_shared<BoundedNearest<Motion*>>(
        [radius_m](Motion* const& from, Motion* const& to) {
          const Pose2 a = CarSpace::pose_of(from->state), b = CarSpace::pose_of(to->state);
          // A path is at least as long as the straight line and as the arc of the change of
          // heading.
          return std::max((b.p - a.p).norm(),
                          radius_m * std::abs(wrap_angle(b.yaw_rad - a.yaw_rad)) - 1e-9);
        },
        range_m);
    this->setRange(range_m);
  }

  CarTree tree() const {
    std::vector<Motion*> motions;
    this->nn_->list(motions);
    CarTree tree;
    tree.nodes = static_cast<std::int64_t>(motions.size());
    for (const Motion* motion : motions) {
      if (motion->parent == nullptr) continue;
      tree.edges.emplace_back(CarSpace::pose_of(motion->parent->state),
                              CarSpace::pose_of(motion->state));
    }
    return tree;
  }

 private:
  using Motion = typename Base::Motion;
};

/// Space, problem and random stream of one run; must outlive the planner.
struct Setup {
  Setup(const CarProblem& problem, CarSampling& sampling, RandomStream& random) {
    // Success and failure are reported by results, never on the console.
    ompl::msg::noOutputHandler();
    auto space = std::make_shared<CarSpace>(problem.radius_m, problem.low_W, problem.high_W);
    space->setStateSamplerAllocator([&sampling, &random](const ob::StateSpace* of) {
      return std::make_shared<CarSampler>(of->as<CarSpace>(), sampling, random);
    });
    si = std::make_shared<ob::SpaceInformation>(space);
    si->setStateValidityChecker([footprint = problem.footprint](const ob::State* state) {
      return footprint->is_free(CarSpace::pose_of(state));
    });
    const double longest_m = problem.range_m * (1.0 + 1e-9);
    si->setMotionValidator(std::make_shared<CarMotionValidator>(si, *problem.footprint,
                                                                problem.check_step_m, longest_m));
    si->setup();
    definition = std::make_shared<ob::ProblemDefinition>(si);
    ob::ScopedState<CarSpace> start(si), goal(si);
    CarSpace::set_pose(sampling.from, start.get());
    CarSpace::set_pose(sampling.to, goal.get());
    constexpr double kAtTheGoal_m = 1e-6;
    definition->setStartAndGoalStates(start, goal, kAtTheGoal_m);
    definition->setOptimizationObjective(
        std::make_shared<CarObjective>(si, *problem.cost, longest_m));
  }

  std::vector<Pose2> waypoints() const {
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

template <typename Base>
CarTree run(Seeded<Base>& planner, const Setup& setup, std::int64_t iterations) {
  planner.setProblemDefinition(setup.definition);
  planner.setup();
  ob::IterationTerminationCondition stop(static_cast<unsigned int>(iterations));
  planner.solve(stop);
  CarTree tree = planner.tree();
  tree.iterations = std::min<std::int64_t>(stop.getTimesCalled(), iterations);
  tree.waypoints = setup.waypoints();
  return tree;
}

}  // namespace

CarTree run_rrt_star(const CarProblem& problem, CarSampling sampling, RandomStream random) {
  const auto seed = static_cast<std::uint_fast32_t>(random.next_u64() >> 32);
  Setup setup(problem, sampling, random);
  Seeded<og::RRTstar> planner(setup.si, seed, problem.radius_m, problem.range_m);
  // Solutions found during the search narrow the sampling.
  const double known = sampling.best_cost();
  sampling.best_cost = [&planner, known] {
    const double own = planner.bestCost().value();
    return own < known ? own : known;
  };
  return run(planner, setup, problem.iterations);
}

CarTree run_rrt(const CarProblem& problem, CarSampling sampling, RandomStream random) {
  const auto seed = static_cast<std::uint_fast32_t>(random.next_u64() >> 32);
  Setup setup(problem, sampling, random);
  Seeded<og::RRT> planner(setup.si, seed, problem.radius_m, problem.range_m);
  constexpr double kGoalBias = 0.1;
  planner.setGoalBias(kGoalBias);
  return run(planner, setup, problem.iterations);
}

}  // namespace vinerow::controllers
