#pragma once
/// A made vineyard for studies of localisation: straight rows on a slope with rough canopy walls,
/// the low-complexity map of it, and how both differ. The world of paper C's reference study
/// (docs/papers/localisation.md): rows 2.5 m apart at azimuth -30 deg, grade 18 % along and 17 % across.
///
/// Row coordinates: s along the rows from the block's origin, t to the left of it, h above ground.

#include <memory>
#include <vector>

#include "controllers/estimation/row_localisation/row_mesh_index.h"
#include "engine/api/map.h"
#include "engine/core/random.h"

namespace vinerow::test {

/// A stretch of a row without plants, m along the rows.
struct Gap {
  int row = 0;
  double from_m = 0.0, to_m = 0.0;
};

struct LocalisationWorldSetup {
  int rows = 4;
  double spacing_m = 2.5;
  double azimuth_rad = -0.5235987755982988;
  double grade_along = 0.18, grade_across = 0.17;
  double length_m = 110.0;                          ///< from s = -10 m
  double section_min_m = 1.0, section_max_m = 2.0;  ///< between sections of the canopy
  double wall_std_m = 0.07;                         ///< sigma_v, of the half width, per section
  bool symmetric = true;               ///< a section's half widths are the same on both sides
  double centre_std_m = 0.05;          ///< of the centre line, per section
  double level_std_m = 0.03;           ///< of the half width, per section and level
  double surface_std_m = 0.03;         ///< sigma_m: true wall less map, along its normal
  double correlation_length_m = 0.3;   ///< ell: exp(-|ds| / ell)
  double stated_surface_std_m = -1.0;  ///< what the map states; < 0: the truth
  Eigen::Vector3d map_offset_W = Eigen::Vector3d::Zero();
  std::vector<Gap> true_gaps, map_gaps;
};

class LocalisationWorld {
 public:
  LocalisationWorld(const LocalisationWorldSetup& setup, std::uint64_t seed);

  const LocalisationWorldSetup& setup() const { return setup_; }
  const RowMap& map() const { return map_; }
  const controllers::RowMeshIndex& map_index() const { return *map_index_; }
  /// True first return along a ray, +infinity beyond max_range_m. @param dir_W  unit
  double true_range(const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W,
                    double max_range_m) const;

  Eigen::Vector3d along_W() const { return along_W_; }  ///< horizontal, unit
  Eigen::Vector3d left_W() const { return left_W_; }
  double row_t(int row) const { return (row - 0.5 * (setup_.rows - 1)) * setup_.spacing_m; }
  /// Row coordinates to W.
  Eigen::Vector3d place(double s, double t, double h) const;
  /// Where the row's canopy stands over t = 0 of its own, for a check of clearance: its surface
  /// towards `side` (+1 left, -1 right) at a height above ground.
  double wall_t(int row, int side, double s, double h) const;

 private:
  struct Section {
    double s = 0.0;
    double t[2][4];  // of the walls: right and left, by level
  };
  std::vector<Section> draw_row(int row, RandomStream& random) const;
  RowMap make_map(const std::vector<Gap>& gaps, const Eigen::Vector3d& offset_W) const;
  void add_piece(RowMesh& mesh, int row, double from_m, double to_m,
                 const Eigen::Vector3d& offset_W) const;
  Section section_at(int row, double s) const;
  double surface_error(int row, int side, double s) const;

  LocalisationWorldSetup setup_;
  Eigen::Vector3d along_W_, left_W_;
  std::vector<std::vector<Section>> sections_;
  std::vector<std::vector<double>> errors_;  // by row and side, every kErrorStep_m
  RowMap map_, truth_;
  std::unique_ptr<controllers::RowMeshIndex> map_index_, truth_index_;
};

}  // namespace vinerow::test
