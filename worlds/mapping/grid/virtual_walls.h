#pragma once
/// Virtual walls of paper A, section 3.1: segments from row ends to the parcel's boundary that
/// leave the serpentine as the only way, and the turning areas between them.
///
/// Everything is in the horizontal plane of W.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/forward.h"

namespace vinerow::mapping {

/// Which end of a row: its line's first or last point.
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

/// The free ground around a row's open end, where a vehicle turns from one alley into the next.
struct TurningArea {
  int row = 0;
  RowEnd end = RowEnd::kFirst;
  std::vector<Eigen::Vector2d> polygon_W;  ///< row ends, walls and the boundary between them
  double width_m = 0.0;                    ///< least distance between its two walls
};

/// The first point where a ray meets a polygon's edges, all of them looked at. A ray that starts on
/// an edge does not meet it there.
/// @param direction  unit @returns nullopt where no edge lies ahead
std::optional<Eigen::Vector2d> nearest_forward_hit(const Eigen::Vector2d& from_W,
                                                   const Eigen::Vector2d& direction,
                                                   const std::vector<Eigen::Vector2d>& polygon_W);

/// Even-odd rule.
bool is_inside(const Eigen::Vector2d& p_W, const std::vector<Eigen::Vector2d>& polygon_W);

/// The end at which row 0 is walled so that a serpentine that drives alley 0 from its first point
/// to its last stays open: the last point where alley 0 lies behind row 0, the first point where it
/// lies before it (worlds with alleys outside their outer rows).
RowEnd first_wall_of(const RowMap& map);

/// One wall per row, at alternating ends along the row's end tangent.
/// @param first_wall  end of row 0
/// @param notes       a sentence for each row that cannot have its wall: its end does not lie
/// inside
///                    the boundary
std::vector<VirtualWall> make_virtual_walls(const RowMap& map, RowEnd first_wall,
                                            std::vector<std::string>& notes);

/// The open end of every row between two alleys. Beside an outer row the boundary stands for the
/// missing wall. @param walls  of make_virtual_walls()
std::vector<TurningArea> make_turning_areas(const RowMap& map,
                                            const std::vector<VirtualWall>& walls);

}  // namespace vinerow::mapping
