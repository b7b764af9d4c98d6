#pragma once
/// Search for turns: an initial path in closed form, improved by RRT* (paper A, section 4.1, with
/// an addition: RRT* alone fails too often between vine rows).

#include <functional>

#include "controllers/planning/search/path_cost.h"
#include "controllers/planning/search/pose_search.h"
#include "engine/core/random.h"

namespace vinerow::controllers {

struct RrtStarParams {
  double radius_m = 1.0;                   ///< minimum of the vehicle
  double curvature_reserve = 0.05;         ///< share by which turns are wider if there is clearance
  std::int64_t iterations = 500;           ///< of RRT*; 0: the initial path is the result
  std::int64_t first_iterations = 10'000;  ///< of RRT, if no closed form fits
  double range_m = 3.0;                    ///< longest edge of the tree
  double reach_m = 8.0;                    ///< searched around both ends
  double check_step_m = 0.1;
  PathCostParams cost;
};

class RrtStarSearch final : public PoseSearch {
 public:
  /// @param random_of  the random stream of a problem
  RrtStarSearch(const RrtStarParams& params, std::function<RandomStream(int problem)> random_of);

  Result<std::vector<PathSegment>> find(const Pose2& from, const Pose2& to,
                                        const Footprint& footprint, int problem,
                                        SearchReport& report) override;

 private:
  RrtStarParams params_;
  std::function<RandomStream(int)> random_of_;
};

}  // namespace vinerow::controllers
