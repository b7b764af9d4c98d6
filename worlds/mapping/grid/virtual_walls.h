#pragma once
/// Virtual walls of paper A, section 3.1: segments from row ends to the parcel's boundary that
/// leave only the serpentine free, and the turning areas between them.
///
/// Everything is in the horizontal plane of W.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/forward.h"

namespace vinerow::mapping {

/// End of a row: its line's first or last point.
enum class RowEnd { kFirst, kLast };

constexpr RowEnd other_end(RowEnd end) {
  return end == RowEnd::kFirst ? RowEnd::kLast : RowEnd::kFirst;
}

/// Segment e_k - g_k.
struct VirtualWall {
  int row = 0;  ///< index into RowMap::rows
  RowEnd end = RowEnd::kLast;
  Eigen::Vector2d from_W = {0, 0};  ///< e_k, the row's end
  Eigen::Vector2d to_W = {0, 0};    ///< g_k, on the boundary
};

/// Free ground around a row's open end, in which a vehicle turns from one alley into the next.
struct TurningArea {
  int row = 0;
  RowEnd end = RowEnd::kFirst;
  std::vector<Eigen::Vector2d> polygon_W;  ///< row ends, walls and the boundary between them
  double width_m = 0.0;                    ///< smallest distance between its two walls
};

/// First intersection of a ray with the edges of a polygon. A ray that starts on an edge does not
/// intersect it there. @param direction  unit @returns nullopt if no edge is ahead
std::optional<Eigen::Vector2d> nearest_forward_hit(const Eigen::Vector2d& from_W,
                                                   const Eigen::Vector2d& direction,
                                                   const std::vector<Eigen::Vector2d>& polygon_W);

/// End of row 0 at which its wall leaves free a serpentine that drives alley 0 from its first point
/// to its last: the last point if alley 0 is after row 0, the first point if it is before it
/// (worlds with alleys outside their outer rows).
RowEnd first_wall_of(const RowMap& map);

/// One wall per row, at alternating ends along the row's end tangent.
/// @param first_wall  end of row 0
/// @param notes       a sentence for each row without a wall because its end is outside the
///                    boundary
std::vector<VirtualWall> make_virtual_walls(const RowMap& map, RowEnd first_wall,
                                            std::vector<std::string>& notes);

/// Turning area at the open end of every row between two alleys. Next to an outer row the boundary
/// takes the place of the missing wall. @param walls  of make_virtual_walls()
std::vector<TurningArea> make_turning_areas(const RowMap& map,
                                            const std::vector<VirtualWall>& walls);

}  // namespace vinerow::mapping
