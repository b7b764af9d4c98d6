#pragma once
/// Finding a drivable way between two poses on an occupancy grid: what the route planners exchange.

#include <cstdint>
#include <vector>

#include "controllers/parts/paths/footprint.h"
#include "controllers/parts/paths/path_pieces.h"
#include "engine/core/result.h"

namespace vinerow::controllers {

/// What one search did.
struct SearchReport {
  std::int64_t nodes = 0;  ///< in the tree
  std::int64_t iterations = 0;
  /// Of the first way found, before any improvement; 0 where the search does not improve.
  double first_length_m = 0.0;
  /// Edges of the tree for pictures, two points each, curved edges as several; W, m.
  std::vector<Eigen::Vector2d> tree_W;
};

class PoseSearch {
 public:
  virtual ~PoseSearch() = default;

  /// @param footprint  of the vehicle on the grid, margin included
  /// @param problem    number of the search inside a mission: the key of its random stream, so that
  ///                   one alley more changes no other turn
  /// @returns straights and arcs of kind kTurn from `from` to `to` (forward, curvature within the
  /// vehicle's), or why there are none, in one sentence with numbers
  virtual Result<std::vector<PathPiece>> find(const Pose2& from, const Pose2& to,
                                              const Footprint& footprint, int problem,
                                              SearchReport& report) = 0;
};

}  // namespace vinerow::controllers
