#pragma once
/// Queries on the centre lines of rows: nearest row to a point, with distances along and across it.
///
/// No heap after construction.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/plant_row.h"
#include "engine/math/polyline_index.h"

namespace vinerow::vehicles {

/// Position relative to a row. The row is extended straight beyond its first and last points.
struct RowPlace {
  int row = 0;              ///< index among the rows
  double along_m = 0.0;     ///< along the line from its first point; < 0 before it, > length behind
  double lateral_m = 0.0;   ///< positive: left of the line
  double ground_m = 0.0;    ///< z of the ground on the line there; beyond its ends that of the end
  double distance_m = 0.0;  ///< horizontal distance from the line without its extensions
  Eigen::Vector2d direction_W = Eigen::Vector2d::UnitX();  ///< of the line there, unit
};

/// Rows on both sides of a vehicle.
struct AdjacentRows {
  std::optional<RowPlace> left, right;
};

class RowLines {
 public:
  /// @param rows  each with at least two distinct points (worlds and maps ensure that)
  /// @param terrain  source of RowPlace::ground_m, one height each metre; not kept. nullptr: the
  ///   lines themselves, which miss hollows and humps between their points
  explicit RowLines(const std::vector<PlantRow>& rows, const HeightField* terrain = nullptr);

  int count() const { return static_cast<int>(index_.lines().size()); }
  double length_m(int row) const { return line(row).length_m(); }
  /// @pre count() > 0
  RowPlace nearest(const Eigen::Vector2d& p_W) const;
  RowPlace place(int row, const Eigen::Vector2d& p_W) const;

  /// Nearest row on each side that is within `reach_m`, at most `max_angle_rad` off the heading,
  /// and ends no more than `beyond_end_m` before the position (negative: extends that far beyond
  /// it).
  AdjacentRows adjacent(const Eigen::Vector2d& p_W, double heading_rad, double reach_m,
                        double max_angle_rad, double beyond_end_m) const;

 private:
  /// Heights of the ground along a row, at equal distances from its first point to its last.
  struct Profile {
    double apart_m = 1.0;
    std::vector<double> ground_m;
    double at(double along_m) const;
  };
  static Profile make_profile(const PlantRow& row, const Polyline& line,
                              const HeightField& terrain);
  const Polyline& line(int row) const { return index_.lines()[static_cast<std::size_t>(row)]; }
  RowPlace place_at(int row, const Polyline::Nearest& found, const Eigen::Vector2d& p_W) const;

  PolylineIndex index_;
  std::vector<std::vector<double>> ground_m_;  // of each point
  std::vector<Profile> profiles_;              // of each row, if a terrain is given
};

}  // namespace vinerow::vehicles
