#include "vehicles/payloads/canopy_patches.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>

#include "engine/api/file_shelf.h"
#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/hash.h"
#include "vehicles/payloads/canopy_cutting.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Vector3d;

/// Share of step times band; smaller patches are merged into a neighbour.
constexpr double kSliver = 0.2;

bool is_canopy(const MeshInstance& instance) {
  return instance.collides && instance.surface == SurfaceClass::kCanopy && instance.mesh;
}

std::vector<CanopyPoint> points_of(const RowLines& rows, const MeshInstance& instance) {
  std::vector<CanopyPoint> points;
  points.reserve(instance.mesh->vertices.size());
  for (const Eigen::Vector3f& vertex : instance.mesh->vertices) {
    points.push_back(canopy_point(rows, instance.X_WM * vertex.cast<double>()));
  }
  return points;
}

}  // namespace

CanopyPatches::CanopyPatches(const WorldModel& world, double step_m, double band_m)
    : step_m_(step_m),
      band_m_(band_m),
      rows_(world.rows->rows, world.terrain ? &*world.terrain : nullptr) {
  if (rows_.count() == 0) return;
  for (int row = 0; row < rows_.count(); ++row) {
    const int steps =
        std::max(1, static_cast<int>(std::ceil(rows_.length_m(row) / step_m_ - 1e-9)));
    layout_.push_back({steps, step_count_});
    step_count_ += 2 * steps;
  }
  std::vector<std::vector<CanopyPoint>> points;
  for (const MeshInstance& instance : world.meshes) {
    if (!is_canopy(instance)) continue;
    points.push_back(points_of(rows_, instance));
    for (const CanopyPoint& point : points.back()) {
      bands_ = std::max(bands_, static_cast<int>(std::ceil(point.height_m / band_m_ - 1e-9)));
    }
  }

  std::vector<CanopyPatch> cells(static_cast<std::size_t>(step_count_) *
                                 static_cast<std::size_t>(bands_));
  const std::function<void(const CanopyPiece&)> take = [&](const CanopyPiece& piece) {
    const int along =
        std::clamp(piece.along, 0, layout_[static_cast<std::size_t>(piece.row)].steps - 1);
    const int band = std::clamp(piece.band, 0, bands_ - 1);
    CanopyPatch& patch = cells[cell(piece.row, piece.side, along, band)];
    patch.row = piece.row;
    patch.side = piece.side;
    patch.along = along;
    patch.band = band;
    patch.area_m2 += piece.area_m2;
    patch.p_W += piece.area_m2 * piece.middle_W;
  };
  std::size_t number = 0;
  for (const MeshInstance& instance : world.meshes) {
    if (!is_canopy(instance)) continue;
    const std::vector<CanopyPoint>& corners = points[number++];
    for (const auto& [a, b, c] : instance.mesh->triangles) {
      cut_canopy_triangle(rows_, corners[a], corners[b], corners[c], step_m_, band_m_, take);
    }
  }
  take_over(cells);
  for (CanopyPatch& patch : patches_) {
    patch.row = world.rows->rows[static_cast<std::size_t>(patch.row)].id;
  }
}

void CanopyPatches::take_over(std::vector<CanopyPatch>& cells) {
  // Receiver of a cell's area: itself, a neighbour, or -1 without area.
  const double min_m2 = kSliver * step_m_ * band_m_;
  std::vector<std::int32_t> heirs(cells.size(), -1);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const CanopyPatch& patch = cells[i];
    if (!(patch.area_m2 > 0.0)) continue;
    heirs[i] = static_cast<std::int32_t>(i);
    if (patch.area_m2 >= min_m2) continue;
    double largest_m2 = min_m2;
    for_each_neighbour(patch.row, patch.side, patch.along, patch.band, [&](std::size_t other) {
      if (cells[other].area_m2 < largest_m2) return;
      largest_m2 = cells[other].area_m2;
      heirs[i] = static_cast<std::int32_t>(other);
    });
  }
  std::vector<CanopyPatch> merged = cells;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (heirs[i] < 0 || heirs[i] == static_cast<std::int32_t>(i)) continue;
    CanopyPatch& heir = merged[static_cast<std::size_t>(heirs[i])];
    heir.area_m2 += cells[i].area_m2;
    heir.p_W += cells[i].p_W;
  }
  patch_of_cell_.assign(cells.size(), -1);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (heirs[i] != static_cast<std::int32_t>(i)) continue;
    CanopyPatch& patch = merged[i];
    patch.p_W /= patch.area_m2;
    area_m2_ += patch.area_m2;
    patch_of_cell_[i] = static_cast<std::int32_t>(patches_.size());
    patch_step_.push_back(step_index(patch.row, patch.side, patch.along));
    patches_.push_back(patch);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    // A receiver is large enough and keeps its own area.
    if (heirs[i] >= 0) patch_of_cell_[i] = patch_of_cell_[static_cast<std::size_t>(heirs[i])];
  }
}

template <class F>
void CanopyPatches::for_each_neighbour(int row, int side, int along, int band, F&& f) const {
  if (band > 0) f(cell(row, side, along, band - 1));
  if (band + 1 < bands_) f(cell(row, side, along, band + 1));
  if (along > 0) f(cell(row, side, along - 1, band));
  if (along + 1 < layout_[static_cast<std::size_t>(row)].steps) {
    f(cell(row, side, along + 1, band));
  }
  f(cell(row, -side, along, band));
}

int CanopyPatches::along_of(int row, double along_m) const {
  return std::clamp(static_cast<int>(std::floor(along_m / step_m_)), 0,
                    layout_[static_cast<std::size_t>(row)].steps - 1);
}

int CanopyPatches::step_index(int row, int side, int along) const {
  const Layout& layout = layout_[static_cast<std::size_t>(row)];
  return layout.first_step + (side > 0 ? 0 : layout.steps) + along;
}

int CanopyPatches::step_of(int row, int side, double along_m) const {
  return step_index(row, side, along_of(row, along_m));
}

std::size_t CanopyPatches::cell(int row, int side, int along, int band) const {
  return static_cast<std::size_t>(step_index(row, side, along)) * static_cast<std::size_t>(bands_) +
         static_cast<std::size_t>(band);
}

int CanopyPatches::patch_near(const RowPlace& at, double height_m) const {
  const int side = at.lateral_m >= 0.0 ? 1 : -1;
  const int along = along_of(at.row, at.along_m);
  const int band = std::clamp(static_cast<int>(std::floor(height_m / band_m_)), 0, bands_ - 1);
  int found = patch_of_cell_[cell(at.row, side, along, band)];
  if (found >= 0) return found;
  for_each_neighbour(at.row, side, along, band, [&](std::size_t other) {
    if (found < 0) found = patch_of_cell_[other];
  });
  return found;
}

int CanopyPatches::find(const Vector3d& p_W) const {
  if (patches_.empty()) return -1;
  const RowPlace at = rows_.nearest(p_W.head<2>());
  return patch_near(at, p_W.z() - at.ground_m);
}

int CanopyPatches::spread(const Vector3d& p_W, std::array<PatchShare, 4>& shares) const {
  if (patches_.empty()) return 0;
  const RowPlace at = rows_.nearest(p_W.head<2>());
  const double height_m = p_W.z() - at.ground_m;
  const int side = at.lateral_m >= 0.0 ? 1 : -1;
  const int steps = layout_[static_cast<std::size_t>(at.row)].steps;
  const double along = at.along_m / step_m_ - 0.5, band = height_m / band_m_ - 0.5;
  const double first_along = std::floor(along), first_band = std::floor(band);
  int count = 0;
  double sum = 0.0;
  for (const int i : {0, 1}) {
    for (const int j : {0, 1}) {
      const int column = static_cast<int>(first_along) + i, row = static_cast<int>(first_band) + j;
      if (column < 0 || column >= steps || row < 0 || row >= bands_) continue;
      const int patch = patch_of_cell_[cell(at.row, side, column, row)];
      const double share =
          std::abs(1 - i - (along - first_along)) * std::abs(1 - j - (band - first_band));
      if (patch < 0 || !(share > 0.0)) continue;
      shares[static_cast<std::size_t>(count++)] = {patch, share};
      sum += share;
    }
  }
  if (count == 0) {
    shares[0] = {patch_near(at, height_m), 1.0};
    return shares[0].patch >= 0 ? 1 : 0;
  }
  for (int k = 0; k < count; ++k) shares[static_cast<std::size_t>(k)].share /= sum;
  return count;
}

CanopyCoverage CanopyPatches::empty_coverage() const {
  CanopyCoverage coverage;
  coverage.step_m = step_m_;
  coverage.band_m = band_m_;
  coverage.patches = patches_;
  return coverage;
}

namespace {

/// Digest of everything that the patches depend on, apart from their size.
std::string digest_of_canopy(const WorldModel& world) {
  Hasher hasher;
  const auto add = [&](const auto& list) {
    hasher.add(static_cast<std::uint64_t>(list.size()));
    if (!list.empty()) hasher.add_bytes(list.data(), list.size() * sizeof(list[0]));
  };
  for (const PlantRow& row : world.rows->rows) {
    hasher.add(row.id);
    add(row.line_W);
  }
  if (world.terrain) {
    const HeightField& field = *world.terrain;
    hasher.add(field.columns);
    hasher.add(field.cell_m);
    hasher.add(field.corner_W.x());
    hasher.add(field.corner_W.y());
    add(field.heights_m);
  }
  for (const MeshInstance& instance : world.meshes) {
    if (!is_canopy(instance)) continue;
    for (const double value : instance.X_WM.q.coeffs()) hasher.add(value);
    for (const double value : instance.X_WM.p) hasher.add(value);
    add(instance.mesh->vertices);
    add(instance.mesh->triangles);
  }
  return hasher.hex();
}

/// The patches made last, of one size.
struct LastPatches {
  std::mutex mutex;
  std::string canopy;
  std::shared_ptr<const CanopyPatches> patches;
};

}  // namespace

std::shared_ptr<const CanopyPatches> make_canopy_patches(const WorldModel& world, double step_m,
                                                         double band_m, FileShelf* shelf) {
  if (!shelf) return std::make_shared<const CanopyPatches>(world, step_m, band_m);
  using Kept = std::shared_ptr<LastPatches>;
  const std::string size = fmt::format("canopy patches of {} by {} m", step_m, band_m);
  LastPatches& last = **keep<Kept>(shelf, size, [] { return std::make_shared<LastPatches>(); });
  const std::string canopy = digest_of_canopy(world);
  const std::lock_guard lock(last.mutex);
  if (!last.patches || last.canopy != canopy) {
    last.patches = std::make_shared<const CanopyPatches>(world, step_m, band_m);
    last.canopy = canopy;
  }
  return last.patches;
}

CanopyNumbers calc_canopy_numbers(const CanopyPatches& patches, const CanopyCoverage& coverage,
                                  const std::vector<std::uint8_t>& of) {
  double area = 0.0, covered = 0.0, sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < coverage.patches.size(); ++i) {
    const CanopyPatch& patch = coverage.patches[i];
    const auto step = static_cast<std::size_t>(patches.step_of_patch(static_cast<int>(i)));
    if (!of.empty() && of[step] == 0) continue;
    area += patch.area_m2;
    covered += patch.amount >= coverage.wanted ? patch.area_m2 : 0.0;
    sum += patch.area_m2 * patch.amount;
    squares += patch.area_m2 * patch.amount * patch.amount;
  }
  CanopyNumbers numbers;
  numbers.area_m2 = area;
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  numbers.covered_share = area > 0.0 ? covered / area : nothing;
  numbers.mean = area > 0.0 ? sum / area : nothing;
  numbers.variation =
      sum > 0.0
          ? std::sqrt(std::max(0.0, squares / area - numbers.mean * numbers.mean)) / numbers.mean
          : nothing;
  return numbers;
}

}  // namespace vinerow::vehicles
