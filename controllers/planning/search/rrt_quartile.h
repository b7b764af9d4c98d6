#pragma once
/// Search of paper A, section 4.1, on the occupancy grid.

#include "controllers/planning/search/pose_search.h"
#include "controllers/planning/search/quartile_tree.h"
#include "engine/api/part.h"

namespace vinerow::controllers {

/// Limit of one search: a node takes about 250 bytes, so the tree at most half a gigabyte.
inline constexpr double kMaxQuartileIterations = 2e6;

struct RrtQuartileParams {
  QuartileTreeParams tree;
  DistanceKind heuristic = DistanceKind::kGeodesic;
  std::int64_t max_iterations = 1'000'000;  ///< expansions, over all refinements of one search
  int refinements = 1;  ///< further trees, each with half the step and half the cells
  bool smooth = true;
};

/// Searches with a QuartileTree. If the tree is exhausted, it searches again with finer steps and
/// cells, since an exhausted tree proves only that no sequence of its own arcs leads to the goal.
/// The iterations are limited. The same call gives the same bits.
class RrtQuartile final : public PoseSearch {
 public:
  /// @param context  seed and names of its random streams
  RrtQuartile(const RrtQuartileParams& params, PartContext context);

  Result<std::vector<PathSegment>> find(const Pose2& from, const Pose2& to,
                                        const Footprint& footprint, int problem,
                                        SearchReport& report) override;

 private:
  RrtQuartileParams params_;
  PartContext context_;
};

}  // namespace vinerow::controllers
