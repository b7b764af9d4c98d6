#pragma once
/// Ways around a mission's fences: inside every inclusion fence, outside every exclusion fence.
///
/// Shortest ways around polygons bend at their corners only. Corners are moved off the fence by a
/// margin, circles are polygons of 48 corners (around those to be kept out of, inside those to be
/// kept in), and the shortest chain of straights that cross no fence is found by Dijkstra's
/// algorithm, of equal ones the one through the earlier corners: the same way every time.

#include <optional>
#include <vector>

#include "controllers/planning/survey/survey_area.h"
#include "engine/io/missions/mission_file.h"

namespace vinerow::controllers {

class FenceWays {
 public:
  /// @param margin_m  that bends keep from the fences, > 0
  FenceWays(const io::MissionFile& mission, const GeoOrigin& origin, double margin_m);

  bool empty() const { return fences_.empty(); }
  /// Whether a place breaks no fence.
  bool is_free(const Eigen::Vector2d& p_W) const;
  /// Whether a straight way breaks none; exact but for rounding.
  bool is_free(const Eigen::Vector2d& from_W, const Eigen::Vector2d& to_W) const;
  /// Where to bend on the way; empty: straight on. @returns nothing where the fences part the
  /// places
  std::optional<std::vector<Eigen::Vector2d>> find_way(const Eigen::Vector2d& from_W,
                                                       const Eigen::Vector2d& to_W) const;

 private:
  struct Fence {
    bool inclusion = true;
    Polygon2 polygon;
  };
  void add(bool inclusion, Polygon2 polygon);
  void add_bends(const Fence& fence, double margin_m);

  std::vector<Fence> fences_;
  std::vector<Eigen::Vector2d> bends_W_;
};

}  // namespace vinerow::controllers
