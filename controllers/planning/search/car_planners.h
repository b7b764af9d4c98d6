#pragma once
/// OMPL's planners, run once with a fixed number of iterations and a seed of their own.

#include <cstdint>
#include <vector>

#include "controllers/planning/search/car_sampler.h"

namespace vinerow::controllers {

struct CarProblem {
  double radius_m = 1.0;
  Eigen::Vector2d low_W = {0, 0}, high_W = {0, 0};  ///< box to search in
  const Footprint* footprint = nullptr;
  const WayCost* cost = nullptr;
  double check_step_m = 0.1;
  double range_m = 3.0;  ///< longest edge of the tree
  std::int64_t iterations = 0;
};

struct CarTree {
  std::vector<Pose2>
      way;  ///< poses to join by Dubins paths, from `from` to `to`; empty: none found
  std::int64_t nodes = 0;
  std::int64_t iterations = 0;
  std::vector<std::pair<Pose2, Pose2>> edges;
};

/// RRT* (Karaman and Frazzoli, "Sampling-based algorithms for optimal motion planning", Int. J.
/// Robotics Research 30, 2011). The tree begins with sampling.first_way.
/// @throws ompl::Exception
CarTree run_rrt_star(const CarProblem& problem, CarSampling sampling, RandomStream random);

/// RRT (LaValle and Kuffner, "Randomized kinodynamic planning", Int. J. Robotics Research 20,
/// 2001), for a first way where closed forms fail; stops at the first found. A tree from the goal
/// as in RRT-Connect would have to be grown backwards, which OMPL does not do where ways have a
/// direction.
/// @throws ompl::Exception
CarTree run_rrt(const CarProblem& problem, CarSampling sampling, RandomStream random);

}  // namespace vinerow::controllers
