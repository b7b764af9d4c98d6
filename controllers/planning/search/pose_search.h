#pragma once
/// Interface of searches for a drivable path between two poses on an occupancy grid.

#include <cstdint>
#include <vector>

#include "controllers/parts/paths/footprint.h"
#include "controllers/parts/paths/path_pieces.h"
#include "engine/core/result.h"

namespace vinerow::controllers {

/// Report of one search.
struct SearchReport {
  std::int64_t nodes = 0;  ///< in the tree
  std::int64_t iterations = 0;
  /// Length of the first path found, before any improvement; 0 if the search does not improve
  /// paths.
  double first_length_m = 0.0;
  /// Edges of the tree for pictures, two points each, curved edges as several; W, m.
  std::vector<Eigen::Vector2d> tree_W;
};

class PoseSearch {
 public:
  virtual ~PoseSearch() = default;

  /// @param footprint  of the vehicle on the grid, margin included
  /// @param problem    number of the search in a mission, the key of its random stream, so that an
  /// additional alley changes no other turn
  /// @returns straights and arcs of kind kTurn from `from` to `to` (forward, curvature within the
  /// vehicle's limit), or one sentence with numbers that gives the reason for the failure
  virtual Result<std::vector<PathSegment>> find(const Pose2& from, const Pose2& to,
                                                const Footprint& footprint, int problem,
                                                SearchReport& report) = 0;
};

}  // namespace vinerow::controllers
