#include "worlds/mapping/hulls/row_hull.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <tuple>

#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "engine/math/angles.h"
#include "worlds/mapping/hulls/hull_figures.h"
#include "worlds/mapping/hulls/hull_fit.h"
#include "worlds/mapping/hulls/row_sections.h"
#include "worlds/mapping/hulls/section_directions.h"

namespace vinerow::mapping {
namespace {

constexpr double kSweepReach_m[] = {0.03, 0.02, 0.015, 0.01, 0.01, 0.01};  // of the sweeps

void check(const RowHullOptions& options) {
  const auto demand = [](bool good, const char* name, double value, const char* allowed) {
    if (!good) {
      throw ConfigError(fmt::format("row meshes: {} = {:g}, must be {}", name, value, allowed));
    }
  };
  demand(options.corners >= 5 && options.corners <= 16, "corners", options.corners, "5 to 16");
  demand(options.slice_m >= 0.02 && options.slice_m <= 5.0, "slice_m", options.slice_m,
         "0.02 to 5 m");
  demand(options.cell_m >= 0.01 && options.cell_m <= 1.0, "cell_m", options.cell_m, "0.01 to 1 m");
  demand(options.gap_m >= 0.05 && options.gap_m <= 100.0, "gap_m", options.gap_m, "0.05 to 100 m");
  demand(options.containment >= 0.5 && options.containment <= 1.0, "containment",
         options.containment, "0.5 to 1");
  demand(options.tolerance_m >= 0.0 && options.tolerance_m <= 0.5, "tolerance_m",
         options.tolerance_m, "0 to 0.5 m");
  demand(options.simplify_m >= 0.0 && options.simplify_m <= 1.0, "simplify_m", options.simplify_m,
         "0 to 1 m");
  demand(options.budget_bytes >= 0.0, "budget_bytes", options.budget_bytes, ">= 0");
  demand(options.budget_bytes_per_m >= 0.0, "budget_bytes_per_m", options.budget_bytes_per_m,
         ">= 0");
}

/// Processing of one row from points to meshes.
class RowWork {
 public:
  RowWork(const RowCanopy& row, const GroundHeight& ground, const RowHullOptions& options)
      : row_(row), ground_(ground), options_(options) {}

  void fit() {
    stretches_ =
        slice_row(row_, {options_.slice_m, options_.cell_m, options_.gap_m, options_.slices});
    if (stretches_.stretches.empty()) return;
    std::int64_t points = 0;
    for (const RowStretch& stretch : stretches_.stretches) {
      points += static_cast<std::int64_t>(stretch.points.size());
    }
    const HullDirections directions =
        choose_directions(stretches_.stretches, options_.corners);
    double area_m2 = 0.0;
    for (const RowStretch& stretch : stretches_.stretches) {
      fits_.push_back(std::make_unique<HullFit>(stretch, directions, options_.fit));
      area_m2 += fits_.back()->side_area_m2();
      length_m_ += fits_.back()->length_m();
    }
    perimeter_m_ = area_m2 / length_m_;

    const auto all = static_cast<double>(points + lost());
    const double spare = (1.0 - options_.containment) * all;
    allowed_ = static_cast<std::int64_t>(std::max(0.97 * spare - static_cast<double>(lost()),
                                                  0.5 * (1.0 - options_.containment) * all));
    per_point_m2_ = area_m2 / static_cast<double>(points);
    price_m3_ = options_.first_price_m * per_point_m2_;
    for (const double reach_m : kSweepReach_m) {
      sweep(reach_m);
      adapt_price();
    }
  }

  void find_removals(double share) {
    removals_.resize(fits_.size());
    for (std::size_t i = 0; i < fits_.size(); ++i) {
      const RowStretch& stretch = stretches_.stretches[i];
      line_W_.clear();
      for (int j = 0; j <= stretch.slices(); ++j) {
        const Eigen::Vector2d p = row_.line.point_W(stretch.knot_m(j));
        line_W_.emplace_back(p.x(), p.y(), ground_(p.x(), p.y()));
      }
      const auto fewest = static_cast<int>(0.3 * share * stretch.slices());
      fits_[i]->collect(options_.removal_reach_m);
      removals_[i] = fits_[i]->find_removals(
          price_m3_, options_.tolerance_m, free_m3(), fewest,
          [&](double from_m, double to_m) { return is_straight(stretch, from_m, to_m); });
    }
  }

  /// @param counts  of the removals of each stretch
  void apply_removals(const std::vector<std::size_t>& counts) {
    for (std::size_t i = 0; i < fits_.size(); ++i) {
      fits_[i]->apply(removals_[i], counts[i]);
      if (counts[i] > 0) worst_m3_ = std::max(worst_m3_, removals_[i][counts[i] - 1].added_m3);
    }
  }

  RowHulls finish() {
    RowHulls hulls;
    hulls.row = row_.row;
    hulls.dropped = lost();
    hulls.figures.row = row_.row;
    hulls.figures.points = static_cast<std::int64_t>(row_.points.size());
    if (fits_.empty()) {
      hulls.notes.push_back(fmt::format(
          "row {}: its {} canopy points are too few for a mesh once sparse ones are dropped",
          row_.row, row_.points.size()));
      return hulls;
    }
    for (int n = 0; n < 3; ++n) {
      adapt_price();
      sweep(0.01);
    }
    for (const auto& fit : fits_) fit->smooth_lower_edge();
    settle(hulls);
    for (const auto& fit : fits_) {
      hulls.chains.push_back(fit->chain());
      hulls.meshes_W.push_back(make_chain_mesh(hulls.chains.back(), row_.line, ground_));
    }
    fill_figures(hulls);
    return hulls;
  }

  double length_m() const { return length_m_; }
  /// Cost below which removals are made without need.
  double free_m3() const { return options_.simplify_m * perimeter_m_ * options_.slice_m; }
  std::int64_t bytes() const {
    std::int64_t sum = 0;
    for (const auto& fit : fits_) sum += ply_bytes(options_.corners, fit->sections());
    return sum;
  }
  const std::vector<std::vector<Removal>>& removals() const { return removals_; }

 private:
  std::int64_t lost() const { return stretches_.sparse + stretches_.lone + stretches_.not_finite; }

  void sweep(double max_m) {
    for (const auto& fit : fits_) {
      fit->collect(max_m + 0.01);
      fit->sweep(price_m3_, options_.tolerance_m, max_m);
    }
  }

  /// Adapts the price so that as many points are outside as allowed.
  void adapt_price() {
    const double ratio =
        (static_cast<double>(exactly_outside()) + 1.0) / (static_cast<double>(allowed_) + 1.0);
    price_m3_ =
        std::clamp(price_m3_ * std::clamp(ratio, 0.3, 3.0), options_.low_price_m * per_point_m2_,
                   options_.high_price_m * per_point_m2_);
  }

  ExcessCounts count() const {
    ExcessCounts counts(options_.corners);
    for (const auto& fit : fits_) fit->count_excess(counts);
    return counts;
  }

  /// Number of points outside, of those in the stretches.
  std::int64_t exactly_outside() const {
    // At a corner of 90 degrees the distance is 1.41 times the excess.
    constexpr double kSurelyInside = 0.7;
    std::vector<HullChain> chains;
    std::vector<Eigen::Vector3f> doubtful;
    for (const auto& fit : fits_) {
      chains.push_back(fit->chain());
      fit->find_above(kSurelyInside * options_.tolerance_m, doubtful);
    }
    const HullContainment containment(chains, options_.tolerance_m);
    return static_cast<std::int64_t>(doubtful.size()) - containment.count(doubtful);
  }

  bool is_straight(const RowStretch& stretch, double from_m, double to_m) const {
    const auto knot = [&](double s_m) {
      return static_cast<int>(std::lround((s_m - stretch.from_m) / stretch.slice_m()));
    };
    const int a = knot(from_m), b = knot(to_m);
    for (int j = a + 1; j < b; ++j) {
      const double share = static_cast<double>(j - a) / (b - a);
      if (((1.0 - share) * line_W_[a] + share * line_W_[b] - line_W_[j]).norm() >
          options_.straight_m) {
        return false;
      }
    }
    return true;
  }

  /// Volume between the hull's sides and the middle of the points' scatter about them.
  double shell_m3(const ExcessCounts& counts) const {
    double max_per_m2 = 0.0;
    std::vector<double> area_m2(options_.corners, 0.0);
    for (int k = 0; k < options_.corners; ++k) {
      for (const auto& fit : fits_) area_m2[k] += fit->side_area_m2(k);
      if (area_m2[k] < 0.02 * perimeter_m_ * length_m_) continue;
      max_per_m2 = std::max(max_per_m2, static_cast<double>(counts.count(k)) / area_m2[k]);
    }
    double shell = 0.0;
    for (int k = 0; k < options_.corners; ++k) {
      if (static_cast<double>(counts.count(k)) < options_.unseen * max_per_m2 * area_m2[k])
        continue;
      const double middle_m = counts.middle_m(k);
      if (std::isfinite(middle_m)) shell -= middle_m * area_m2[k];
    }
    return shell;
  }

  /// 1 sigma of the points across the sides: outwards of the middle the scatter is noise, inwards
  /// it is the roundness of the canopy too.
  double find_noise_m(const ExcessCounts& counts) const {
    double sum = 0.0, weight = 0.0;
    for (int k = 0; k < options_.corners; ++k) {
      const auto points = static_cast<double>(counts.count(k));
      const double above_m = counts.share_m(k, 0.9), middle_m = counts.share_m(k, 0.5);
      if (!std::isfinite(above_m)) continue;
      sum += points * (above_m - middle_m) / 1.2816;
      weight += points;
    }
    return weight > 0.0 ? sum / weight : 0.0;
  }

  /// Moves all sides so that as many points are outside as allowed, but not so far in that the
  /// volume is below that of the canopy.
  void settle(RowHulls& hulls) {
    ExcessCounts counts = count();
    double volume = 0.0, area_m2 = 0.0;
    for (const auto& fit : fits_) {
      volume += fit->volume_m3();
      area_m2 += fit->side_area_m2();
    }
    const double shell = shell_m3(counts);
    hulls.canopy_volume_m3 = volume - shell;
    hulls.noise_m = find_noise_m(counts);
    const double own_m = -shell / area_m2;
    // Points that this does not bring inside are not scatter.
    const double max_m = std::max(0.01, 2.0 * hulls.noise_m);
    // By their excess over a section more points are outside than by their distance from the
    // surface. The search adapts the count by excess to the exact one.
    std::vector<std::vector<double>> begun;
    for (const auto& fit : fits_) begun.push_back(fit->offsets());
    const auto place = [&](double out_m) {
      for (std::size_t i = 0; i < fits_.size(); ++i) {
        fits_[i]->set_offsets(begun[i]);
        fits_[i]->offset(out_m);
      }
    };
    double by_excess = static_cast<double>(allowed_);
    double good_m = std::numeric_limits<double>::infinity();
    double bad_m = own_m;
    for (int n = 0; n < 6; ++n) {
      double out_m = counts.level_m(std::llround(by_excess)) - options_.tolerance_m;
      if (n > 0 && std::isfinite(good_m) && !(out_m > bad_m && out_m < good_m)) {
        out_m = 0.5 * (bad_m + good_m);
      }
      out_m = std::max(std::min(out_m, max_m), own_m);
      place(out_m);
      const std::int64_t outside = exactly_outside();
      if (outside <= allowed_) {
        good_m = std::min(good_m, out_m);
        if (out_m <= own_m || outside > 0.96 * static_cast<double>(allowed_)) break;
      } else {
        bad_m = std::max(bad_m, out_m);
      }
      if (good_m - bad_m < 2e-4) break;
      const double ratio = static_cast<double>(allowed_ + 1) / static_cast<double>(outside + 1);
      by_excess *= 0.99 * std::clamp(ratio, 0.25, 4.0);
    }
    place(std::isfinite(good_m) ? good_m : bad_m);
  }

  void fill_figures(RowHulls& hulls) const {
    MappedRowFigures& figures = hulls.figures;
    const auto on_ground = [&](double s_m) {
      const Eigen::Vector2d p = row_.line.point_W(s_m);
      return Eigen::Vector3d(p.x(), p.y(), ground_(p.x(), p.y()));
    };
    const double from_m = hulls.chains.front().from_m(), to_m = hulls.chains.back().to_m();
    figures.first_W = on_ground(from_m);
    figures.last_W = on_ground(to_m);
    figures.length_m = to_m - from_m;
    const Eigen::Vector3d along = figures.last_W - figures.first_W;
    figures.bearing_deg = deg_from_rad(std::atan2(along.x(), along.y()));
    if (figures.bearing_deg < 0.0) figures.bearing_deg += 360.0;
    const SectionMeans means = mean_sections(hulls.chains);
    figures.canopy_base_m = means.base_m;
    figures.canopy_top_m = means.top_m;
    figures.canopy_width_m = means.width_m;
    for (const TriangleMesh& mesh : hulls.meshes_W) {
      figures.volume_m3 += mesh_volume_m3(mesh);
      figures.triangles += static_cast<std::int64_t>(mesh.triangles.size());
    }
    const HullContainment containment(hulls.chains, options_.tolerance_m);
    figures.containment = static_cast<double>(containment.count(row_.points)) /
                          static_cast<double>(row_.points.size());
    figures.gaps_m = stretches_.gaps_m;
    hulls.simplify_error_m = worst_m3_ / (perimeter_m_ * options_.slice_m);
    hulls.mesh_bytes = bytes();
    if (stretches_.not_finite > 0) {
      hulls.notes.push_back(fmt::format("row {}: {} points are not finite and are left out",
                                        row_.row, stretches_.not_finite));
    }
    if (figures.containment < options_.containment) {
      hulls.notes.push_back(
          fmt::format("row {}: {:.1f} % of the canopy points lie within {:g} cm of its meshes, "
                      "fewer than the required {:g} %; {} of {} points are too sparse to be canopy",
                      row_.row, 100.0 * figures.containment, 100.0 * options_.tolerance_m,
                      100.0 * options_.containment, lost(), row_.points.size()));
    }
  }

  const RowCanopy& row_;
  const GroundHeight& ground_;
  const RowHullOptions& options_;
  RowStretches stretches_;
  std::vector<std::unique_ptr<HullFit>> fits_;  // one per stretch
  std::vector<std::vector<Removal>> removals_;
  std::vector<Eigen::Vector3d> line_W_;  // of the stretch at hand, at its first sections
  std::int64_t allowed_ = 0;  // points outside
  double per_point_m2_ = 0.0, price_m3_ = 0.0, perimeter_m_ = 0.0, length_m_ = 0.0, worst_m3_ = 0.0;
};

/// Number of removals of each stretch of each row with which the meshes meet the budget.
std::vector<std::vector<std::size_t>> count_removals(
    const std::vector<std::unique_ptr<RowWork>>& rows, double max_bytes, int corners) {
  struct Entry {
    double added_m3;
    bool free;
    std::size_t row, stretch;
  };
  std::vector<Entry> entries;
  std::vector<std::vector<std::size_t>> counts;
  double bytes = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    bytes += static_cast<double>(rows[i]->bytes());
    counts.emplace_back(rows[i]->removals().size(), 0);
    for (std::size_t k = 0; k < counts[i].size(); ++k) {
      for (const Removal& removal : rows[i]->removals()[k]) {
        entries.push_back({removal.added_m3, removal.added_m3 <= rows[i]->free_m3(), i, k});
      }
    }
  }
  // Costs never fall within a stretch, so that its removals stay in their order.
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.added_m3 < b.added_m3; });
  const auto each = static_cast<double>(ply_bytes(corners, 3) - ply_bytes(corners, 2));
  for (const Entry& entry : entries) {
    if (!entry.free && bytes <= max_bytes) break;
    bytes -= each;
    ++counts[entry.row][entry.stretch];
  }
  return counts;
}

}  // namespace

std::vector<RowHulls> make_row_hulls(std::span<const RowCanopy> rows, const GroundHeight& ground,
                                     const RowHullOptions& options) {
  check(options);
  std::vector<std::unique_ptr<RowWork>> works;
  for (const RowCanopy& row : rows)
    works.push_back(std::make_unique<RowWork>(row, ground, options));
  const auto each = [&](const auto& body) {
    for_chunks(works.size(), 1, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) body(i);
    });
  };
  each([&](std::size_t i) { works[i]->fit(); });
  double bytes = 0.0, length_m = 0.0;
  for (const auto& work : works) {
    bytes += static_cast<double>(work->bytes());
    length_m += work->length_m();
  }
  double max_bytes = std::numeric_limits<double>::infinity();
  if (options.budget_bytes > 0.0) max_bytes = options.budget_bytes;
  if (options.budget_bytes_per_m > 0.0) {
    max_bytes = std::min(max_bytes, options.budget_bytes_per_m * length_m);
  }
  const double share = bytes > max_bytes ? max_bytes / bytes : 1.0;
  each([&](std::size_t i) { works[i]->find_removals(share); });
  const auto counts = count_removals(works, max_bytes, options.corners);
  std::vector<RowHulls> result(works.size());
  each([&](std::size_t i) {
    works[i]->apply_removals(counts[i]);
    result[i] = works[i]->finish();
  });
  return result;
}

}  // namespace vinerow::mapping
