#pragma once
/// Runs of OMPL's planners with a fixed number of iterations and a given random stream.

#include <cstdint>
#include <vector>

#include "controllers/planning/search/car_sampler.h"

namespace vinerow::controllers {

struct CarProblem {
  double radius_m = 1.0;
  Eigen::Vector2d low_W = {0, 0}, high_W = {0, 0};  ///< box to search in
  const Footprint* footprint = nullptr;
  const PathCost* cost = nullptr;
  double check_step_m = 0.1;
  double range_m = 3.0;  ///< longest edge of the tree
  std::int64_t iterations = 0;
};

struct CarTree {
  std::vector<Pose2>
      waypoints;  ///< poses to join by Dubins paths, from `from` to `to`; empty: none found
  std::int64_t nodes = 0;
  std::int64_t iterations = 0;
  std::vector<std::pair<Pose2, Pose2>> edges;
};

/// RRT* (Karaman and Frazzoli, "Sampling-based algorithms for optimal motion planning", Int. J.
/// Robotics Research 30, 2011). The tree starts with sampling.initial_path.
/// @throws ompl::Exception
CarTree run_rrt_star(const CarProblem& problem, CarSampling sampling, RandomStream random);

/// RRT (LaValle and Kuffner, "Randomized kinodynamic planning", Int. J. Robotics Research 20,
/// 2001), for an initial path if closed forms fail; stops at the first path. A tree from the goal
/// as in RRT-Connect would have to grow backwards, which OMPL does not support for directed paths.
/// @throws ompl::Exception
CarTree run_rrt(const CarProblem& problem, CarSampling sampling, RandomStream random);

}  // namespace vinerow::controllers
