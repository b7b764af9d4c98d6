#pragma once
/// Paths around a mission's fences: inside every inclusion fence, outside every exclusion fence.
///
/// Shortest paths around polygons bend only at corners. Corners are moved off the fence by a
/// margin. Circles are polygons of 48 corners, circumscribed for exclusion and inscribed for
/// inclusion. Dijkstra's algorithm finds the shortest chain of straights that cross no fence; among
/// equals, the one through the earlier corners, so that the result is reproducible.

#include <optional>
#include <vector>

#include "engine/io/missions/mission_file.h"
#include "engine/math/polygon.h"

namespace vinerow::controllers {

class FencePaths {
 public:
  /// @param margin_m  distance of bends from the fences, > 0
  FencePaths(const io::MissionFile& mission, const GeoOrigin& origin, double margin_m);

  bool empty() const { return fences_.empty(); }
  /// Whether a point violates no fence.
  bool is_free(const Eigen::Vector2d& p_W) const;
  /// Whether a straight line violates no fence; exact except for rounding.
  bool is_free(const Eigen::Vector2d& from_W, const Eigen::Vector2d& to_W) const;
  /// Bends of the path; empty if the straight line is free. @returns nullopt if the fences separate
  /// the points
  std::optional<std::vector<Eigen::Vector2d>> find_path(const Eigen::Vector2d& from_W,
                                                        const Eigen::Vector2d& to_W) const;

 private:
  struct Fence {
    bool inclusion = true;
    Polygon polygon;
  };
  void add(bool inclusion, Polygon polygon);
  void add_bends(const Fence& fence, double margin_m);

  std::vector<Fence> fences_;
  std::vector<Eigen::Vector2d> bends_W_;
};

}  // namespace vinerow::controllers
