#pragma once
/// The true canopy of a world as patches: pieces of a row's surface on one side of its line, a step
/// along it and a band of height wide.
///
/// Canopy is what rays meet (class kCanopy, collides), all of its surface: sides, top and
/// underside. Every triangle belongs to the nearest row and is cut along the borders of the
/// patches; what lies beyond a row's end counts to its last step. Bands are of height above the
/// ground at the row's line; what lies below it counts to the lowest one. A patch with less than a
/// fifth of step times band is given to the largest neighbour that has more, because a quantity per
/// area means little there. Areas are exact (to a hundredth of a patch where a row bends), their
/// sum always.
///
/// Cost: Parcel F's 16 rows (94 thousand patches) 0.2 s, once; find() some 0.1 us; no heap after
/// building.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/api/payload.h"
#include "vehicles/payloads/worked_rows.h"

namespace vinerow::vehicles {

/// A share of what arrives at a point, and the patch that gets it.
struct PatchShare {
  int patch = -1;
  double share = 0.0;
};

class CanopyPatches {
 public:
  /// @param step_m,band_m  > 0
  CanopyPatches(const WorldModel& world, double step_m, double band_m);

  /// By row (order of WorldModel::rows), side (left first), along, band; all with area > 0.
  const std::vector<CanopyPatch>& patches() const { return patches_; }
  double area_m2() const { return area_m2_; }
  double step_m() const { return step_m_; }
  double band_m() const { return band_m_; }
  const RowLines& rows() const { return rows_; }

  /// The patch around a point of the canopy's surface; where rounding put the point beside it, a
  /// neighbour. @returns index into patches(), -1: there is none
  int find(const Eigen::Vector3d& p_W) const;

  /// What arrives around a point, divided among the up to four patches of that side whose middles
  /// surround it, by bilinear weights: so that few samples a patch give smooth amounts.
  /// @returns how many of `shares` are filled (their shares sum up to 1), 0: there is no patch
  int spread(const Eigen::Vector3d& p_W, std::array<PatchShare, 4>& shares) const;

  /// Number of steps along all rows and sides, and the one of a place: what was worked is told by
  /// these. @param side  +1 or -1
  int step_count() const { return step_count_; }
  int step_of(int row, int side, double along_m) const;
  /// The same of a patch.
  int step_of_patch(int patch) const { return patch_step_[static_cast<std::size_t>(patch)]; }

  /// An amount of zero everywhere.
  CanopyCoverage empty_coverage() const;

 private:
  struct Layout {
    int steps = 0;       ///< along the row
    int first_step = 0;  ///< among those of all rows and sides
  };
  int along_of(int row, double along_m) const;
  int step_index(int row, int side, int along) const;
  std::size_t cell(int row, int side, int along, int band) const;
  /// Makes patches of the cells' areas (patch.p_W: the middle times the area).
  void take_over(std::vector<CanopyPatch>& cells);
  template <class F>
  void for_each_neighbour(int row, int side, int along, int band, F&& f) const;
  int patch_near(const RowPlace& at, double height_m) const;

  double step_m_;
  double band_m_;
  RowLines rows_;
  std::vector<Layout> layout_;
  int step_count_ = 0;
  int bands_ = 1;
  std::vector<std::int32_t> patch_of_cell_;  // steps of all rows and sides, times bands
  std::vector<CanopyPatch> patches_;
  std::vector<std::int32_t> patch_step_;
  double area_m2_ = 0.0;
};

/// What a quantity on the patches amounts to; weighted by area. NaN where there is no area.
struct CanopyNumbers {
  double area_m2 = 0.0;
  double covered_share = 0.0;  ///< with at least the wanted amount
  double mean = 0.0;
  double variation = 0.0;  ///< coefficient of variation: standard deviation over mean
};

/// @param of  which patches count: of[step_of_patch] != 0; empty: all of them
CanopyNumbers calc_canopy_numbers(const CanopyPatches& patches, const CanopyCoverage& coverage,
                                  const std::vector<std::uint8_t>& of = {});

}  // namespace vinerow::vehicles
