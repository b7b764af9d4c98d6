#pragma once
/// The rows' centre lines as a question: which row is nearest to a place, how far along it and how
/// far beside it.
///
/// Cost: a question about the nearest row asks the one or two rows that its cell of a grid (1 m)
/// names; no heap after building.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/plant_row.h"
#include "engine/math/deviation.h"

namespace vinerow::vehicles {

/// A place seen from a row. Before its first and behind its last point the row goes straight on.
struct RowPlace {
  int row = 0;              ///< index among the rows
  double along_m = 0.0;     ///< along the line from its first point; < 0 before it, > length behind
  double lateral_m = 0.0;   ///< positive: left of the line
  double ground_m = 0.0;    ///< z of the ground on the line there; beyond its ends that of the end
  double distance_m = 0.0;  ///< from the line that ends at its ends, in the plane
  Eigen::Vector2d direction_W = Eigen::Vector2d::UnitX();  ///< of the line there, unit
};

/// The rows on both sides of a vehicle.
struct RowsBeside {
  std::optional<RowPlace> left, right;
};

class RowLines {
 public:
  /// @param rows  each with at least two points that are apart (worlds and maps see to that)
  /// @param terrain  tells RowPlace::ground_m, a height each metre; not kept. nullptr: the lines
  /// do,
  ///   which pass over hollows and through humps where they have few points
  explicit RowLines(const std::vector<PlantRow>& rows, const HeightField* terrain = nullptr);

  int count() const { return static_cast<int>(lines_.size()); }
  double length_m(int row) const { return along_m_[static_cast<std::size_t>(row)].back(); }
  /// @pre count() > 0
  RowPlace nearest(const Eigen::Vector2d& p_W) const;
  RowPlace place(int row, const Eigen::Vector2d& p_W, int hint_segment = 0) const;

  /// On each side the nearest row that runs along there: within `reach_m` beside it, at most
  /// `most_angle_rad` off the heading, not farther beyond one of its ends than `beyond_end_m`
  /// (negative: that far before its end).
  RowsBeside beside(const Eigen::Vector2d& p_W, double heading_rad, double reach_m,
                    double most_angle_rad, double beyond_end_m) const;

 private:
  struct Candidate {
    std::int32_t row;
    std::int32_t segment;  ///< nearest to the cell's middle
  };
  /// Heights of the ground along a row, evenly apart from its first point to its last.
  struct Profile {
    double apart_m = 1.0;
    std::vector<double> ground_m;
    double at(double along_m) const;
  };
  Profile make_profile(const PlantRow& row, const HeightField& terrain) const;
  void make_grid();
  RowPlace nearest_of_all(const Eigen::Vector2d& p_W) const;

  std::vector<PolylineDistance> lines_;
  std::vector<std::vector<double>> along_m_;   // of each point
  std::vector<std::vector<double>> ground_m_;  // of each point
  std::vector<Profile> profiles_;              // of each row, where a terrain was given
  std::vector<Eigen::AlignedBox2d> boxes_;
  Eigen::Vector2d corner_W_ = {0, 0};
  double cell_m_ = 1.0;
  int columns_ = 0, rows_ = 0;
  std::vector<std::int32_t> first_;  // of each cell's candidates, and one behind the last
  std::vector<Candidate> candidates_;
};

}  // namespace vinerow::vehicles
