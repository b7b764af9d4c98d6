#pragma once
/// Patches of a world's true canopy: pieces of a row's surface on one side of its line, one step
/// along it and one band of height.
///
/// Canopy is the whole surface that rays meet (class kCanopy, collides): sides, top and underside.
/// Every triangle belongs to the nearest row and is cut along the borders of the patches. Surface
/// beyond a row's end belongs to its last step. Bands are by height above the ground at the row's
/// line; surface below it belongs to the lowest band. A patch smaller than a fifth of step times
/// band is merged into its largest neighbour above that size, because a quantity per area means
/// little there. Areas are exact, or to a hundredth of a patch if a row bends; their sum is always
/// exact.
///
/// Cost: 0.15 s for Parcel F's 16 rows (94 thousand patches); find() about 0.1 us; no heap after
/// construction. Nothing of the world is referred to afterwards.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/api/payload.h"
#include "vehicles/payloads/worked_rows.h"

namespace vinerow::vehicles {

/// Share of a quantity that arrives at a point, and the patch that receives it.
struct PatchShare {
  int patch = -1;
  double share = 0.0;
};

class CanopyPatches {
 public:
  /// @param step_m,band_m  > 0
  CanopyPatches(const WorldModel& world, double step_m, double band_m);

  /// Ordered by row (order of WorldModel::rows), side (left first), along, band; all areas > 0.
  const std::vector<CanopyPatch>& patches() const { return patches_; }
  double area_m2() const { return area_m2_; }
  double step_m() const { return step_m_; }
  double band_m() const { return band_m_; }
  const RowLines& rows() const { return rows_; }

  /// Patch at a point of the canopy's surface, or a neighbour of it if rounding moved the point.
  /// @returns index into patches(), or -1 without a patch
  int find(const Eigen::Vector3d& p_W) const;

  /// Divides a quantity at a point among the up to four patches of that side whose middles surround
  /// it, by bilinear weights, so that few samples per patch give smooth amounts.
  /// @returns number of filled `shares` (their sum is 1), or 0 if there is no patch
  int spread(const Eigen::Vector3d& p_W, std::array<PatchShare, 4>& shares) const;

  /// Number of steps along all rows and sides, and the step of a place. Worked stretches are
  /// recorded by step. @param side  +1 or -1
  int step_count() const { return step_count_; }
  int step_of(int row, int side, double along_m) const;
  /// Step of a patch.
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
  /// Makes patches from the areas of the cells (patch.p_W: middle times area).
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

/// The patches of a world. The shelf keeps those of the last canopy for each step and band: several
/// payloads of a run, and later runs of a session, need the same ones.
/// @param shelf  null: none
std::shared_ptr<const CanopyPatches> make_canopy_patches(const WorldModel& world, double step_m,
                                                         double band_m, FileShelf* shelf);

/// Statistics of a quantity on the patches, weighted by area. NaN without area.
struct CanopyNumbers {
  double area_m2 = 0.0;
  double covered_share = 0.0;  ///< share of the area with at least the wanted amount
  double mean = 0.0;
  double variation = 0.0;  ///< coefficient of variation: standard deviation over mean
};

/// @param of  patches that count have of[step_of_patch] != 0; empty: all patches
CanopyNumbers calc_canopy_numbers(const CanopyPatches& patches, const CanopyCoverage& coverage,
                                  const std::vector<std::uint8_t>& of = {});

}  // namespace vinerow::vehicles
