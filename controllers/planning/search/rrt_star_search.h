#pragma once
/// A turn by a first way in closed form and RRT* from there (paper A, section 4.1, and the repairs
/// of its reading: RRT* alone fails too often between vine rows).

#include <functional>

#include "controllers/planning/search/pose_search.h"
#include "controllers/planning/search/way_cost.h"
#include "engine/core/random.h"

namespace vinerow::controllers {

struct RrtStarParams {
  double radius_m = 1.0;                   ///< least of the vehicle
  double curvature_reserve = 0.05;         ///< share by which turns are wider where there is room
  std::int64_t iterations = 500;           ///< of RRT*; 0: the first way stands
  std::int64_t first_iterations = 10'000;  ///< of RRT, where no closed form fits
  double range_m = 3.0;                    ///< longest edge of the tree
  double reach_m = 8.0;                    ///< searched around both ends
  double check_step_m = 0.1;
  WayCostParams cost;
};

class RrtStarSearch final : public PoseSearch {
 public:
  /// @param random_of  the random stream of a problem
  RrtStarSearch(const RrtStarParams& params, std::function<RandomStream(int problem)> random_of);

  Result<std::vector<PathPiece>> find(const Pose2& from, const Pose2& to,
                                      const Footprint& footprint, int problem,
                                      SearchReport& report) override;

 private:
  RrtStarParams params_;
  std::function<RandomStream(int)> random_of_;
};

}  // namespace vinerow::controllers
