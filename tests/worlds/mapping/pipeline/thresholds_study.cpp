// Prints the table of docs/models/thresholds.md: maps of one simulated cloud with each threshold of
// the mapping 20 % lower and 20 % higher.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/registry.h"
#include "engine/core/error.h"
#include "engine/physics/world_scene.h"
#include "tests/worlds/mapping/photogrammetry/cloud_scene.h"
#include "worlds/mapping/photogrammetry/cloud_truth.h"
#include "worlds/mapping/photogrammetry/map_comparison.h"
#include "worlds/mapping/photogrammetry/photogrammetry.h"
#include "worlds/mapping/pipeline/make_cloud_map.h"
#include "worlds/register_worlds.h"

namespace vinerow::mapping {
namespace {

struct Threshold {
  std::string name, unit;
  std::function<double&(MappingThresholds&)> in;
};

/// Thresholds of one option struct.
template <class Options>
class Group {
 public:
  using Of = std::function<Options&(MappingThresholds&)>;
  Group(std::vector<Threshold>& all, std::string name, Of of)
      : all_(all), name_(std::move(name)), of_(std::move(of)) {}

  Group& add(const char* name, const char* unit, double Options::*field) {
    all_.push_back({name_ + "." + name, unit,
                    [of = of_, field](MappingThresholds& t) -> double& { return of(t).*field; }});
    return *this;
  }

 private:
  std::vector<Threshold>& all_;
  std::string name_;
  Of of_;
};

/// All fields of the option structs but those that CloudMapOptions or the cloud overwrites.
std::vector<Threshold> all_thresholds() {
  using T = MappingThresholds;
  std::vector<Threshold> all;
  {
    // These assertions fail if a field is added. Here none is overwritten.
    static_assert(sizeof(CloudTerrainOptions) == 10 * sizeof(double));
    using O = CloudTerrainOptions;
    Group<O>(all, "terrain", [](T& t) -> O& { return t.terrain; })
        .add("coarse_cell_m", "m", &O::coarse_cell_m)
        .add("coarse_share", "1", &O::coarse_share)
        .add("low_share", "1", &O::low_share)
        .add("peak_reach_bins", "2 cm", &O::peak_reach_bins)
        .add("small_reach_m", "m", &O::small_reach_m)
        .add("small_step_m", "m", &O::small_step_m)
        .add("wide_reach_m", "m", &O::wide_reach_m)
        .add("wide_step_m", "m", &O::wide_step_m)
        .add("filled_weight", "1", &O::filled_weight)
        .add("full_points", "points", &O::full_points);
  }
  {
    // Two are overwritten: spacing_low_m, spacing_high_m.
    static_assert(sizeof(RowPatchOptions) == (15 + 2) * sizeof(double));
    using O = RowPatchOptions;
    Group<O>(all, "direction", [](T& t) -> O& { return t.direction; })
        .add("radius_m", "m", &O::radius_m)
        .add("min_canopy", "1", &O::min_canopy)
        .add("min_chord", "radius", &O::min_chord)
        .add("first_peak", "1", &O::first_peak)
        .add("min_peak", "1", &O::min_peak)
        .add("row_peak_over", "1", &O::row_peak_over)
        .add("row_reach", "spacing", &O::row_reach)
        .add("likely", "1", &O::likely)
        .add("clear", "1", &O::clear)
        .add("agreeing", "1", &O::agreeing)
        .add("parallel_deg", "deg", &O::parallel_deg)
        .add("narrow", "1", &O::narrow)
        .add("wide", "1", &O::wide)
        .add("other_parallel_deg", "deg", &O::other_parallel_deg)
        .add("other_spacing", "1", &O::other_spacing);
  }
  {
    // One is overwritten: spacing_m.
    static_assert(sizeof(RowTrackingOptions) == (16 + 1) * sizeof(double));
    using O = RowTrackingOptions;
    Group<O>(all, "tracking", [](T& t) -> O& { return t.tracking; })
        .add("open_gap_m", "m", &O::open_gap_m)
        .add("longest_gap_m", "m", &O::longest_gap_m)
        .add("longest_join_m", "m", &O::longest_join_m)
        .add("row_reach", "spacing", &O::row_reach)
        .add("max_turn", "step", &O::max_turn)
        .add("along_m", "m", &O::along_m)
        .add("sigma", "reach", &O::sigma)
        .add("centre_hold", "1", &O::centre_hold)
        .add("support", "1", &O::support)
        .add("max_side_step", "step", &O::max_side_step)
        .add("beside", "1", &O::beside)
        .add("farther_loss", "1", &O::farther_loss)
        .add("neighbour", "spacing", &O::neighbour)
        .add("off_line", "spacing", &O::off_line)
        .add("off_per_length", "1", &O::off_per_length)
        .add("max_bend_rad", "rad", &O::max_bend_rad);
  }
  {
    // Two are overwritten: spacing_m, length_low_m.
    static_assert(sizeof(RowLineOptions) == (24 + 2) * sizeof(double));
    using O = RowLineOptions;
    Group<O>(all, "lines", [](T& t) -> O& { return t.lines; })
        .add("across", "spacing", &O::across)
        .add("half_window_m", "m", &O::half_window_m)
        .add("min_weight", "squares", &O::min_weight)
        .add("straight_m", "m", &O::straight_m)
        .add("mean_m", "m", &O::mean_m)
        .add("smooth_reach_m", "m", &O::smooth_reach_m)
        .add("min_side_m", "m", &O::min_side_m)
        .add("max_shift_m", "m", &O::max_shift_m)
        .add("beyond_ends_m", "m", &O::beyond_ends_m)
        .add("longest_gap_m", "m", &O::longest_gap_m)
        .add("core", "half alley", &O::core)
        .add("low", "median", &O::low)
        .add("run_m", "m", &O::run_m)
        .add("wide", "1", &O::wide)
        .add("wide_over", "1", &O::wide_over)
        .add("cut_off_m", "m", &O::cut_off_m)
        .add("covered", "1", &O::covered)
        .add("min_canopy_m2", "m2", &O::min_canopy_m2)
        .add("contrast", "1", &O::contrast)
        .add("row_share", "spacing", &O::row_share)
        .add("alley_from", "spacing", &O::alley_from)
        .add("alley_to", "spacing", &O::alley_to)
        .add("neighbour_near", "spacing", &O::neighbour_near)
        .add("neighbour_far", "spacing", &O::neighbour_far);
  }
  {
    // Four are overwritten: corners, slice_m, gap_m, budget_bytes.
    static_assert(sizeof(RowHullOptions) ==
                  (11 + 4) * sizeof(double) + sizeof(RowSliceThresholds) + sizeof(HullFitOptions));
    using O = RowHullOptions;
    Group<O>(all, "hulls", [](T& t) -> O& { return t.hulls; })
        .add("cell_m", "m", &O::cell_m)
        .add("containment", "1", &O::containment)
        .add("tolerance_m", "m", &O::tolerance_m)
        .add("simplify_m", "m", &O::simplify_m)
        .add("budget_bytes_per_m", "B/m", &O::budget_bytes_per_m)
        .add("removal_reach_m", "m", &O::removal_reach_m)
        .add("straight_m", "m", &O::straight_m)
        .add("unseen", "1", &O::unseen)
        .add("first_price_m", "m", &O::first_price_m)
        .add("low_price_m", "m", &O::low_price_m)
        .add("high_price_m", "m", &O::high_price_m);
  }
  {
    static_assert(sizeof(RowSliceThresholds) == 10 * sizeof(double));
    using O = RowSliceThresholds;
    Group<O>(all, "hulls.slices", [](T& t) -> O& { return t.hulls.slices; })
        .add("local", "median", &O::local)
        .add("row", "median", &O::row)
        .add("stray", "points", &O::stray)
        .add("stray_row", "median", &O::stray_row)
        .add("occupied", "median", &O::occupied)
        .add("shortest_m", "m", &O::shortest_m)
        .add("fewest_points", "points", &O::fewest_points)
        .add("points_per_slice", "points", &O::points_per_slice)
        .add("end_share", "1", &O::end_share)
        .add("end_m", "m", &O::end_m);
  }
  {
    static_assert(sizeof(HullFitOptions) == 6 * sizeof(double));
    using O = HullFitOptions;
    Group<O>(all, "hulls.fit", [](T& t) -> O& { return t.hulls.fit; })
        .add("down_price", "points", &O::down_price)
        .add("looks_down", "1", &O::looks_down)
        .add("edge_reach_m", "m", &O::edge_reach_m)
        .add("edge_band_m", "m", &O::edge_band_m)
        .add("edge_few_per_m", "1/m", &O::edge_few_per_m)
        .add("removal_move_m", "m", &O::removal_move_m);
  }
  return all;
}

struct Parcel {
  ParcelCloud cloud;
  CloudTruth truth;
};

/// Five curved rows of 40 m on a slope, a sixth of the vines missing, seen by pictures straight
/// down from 40 m, 600 points/m2.
Parcel make_parcel() {
  Registry registry;
  worlds::register_worlds(registry);
  ParameterSet parameters(registry.spec(PartKind::kWorld, "vineyard").parameters, "vineyard");
  parameters.set("row_count", 5.0).set("row_length_m", 40.0).set("row_bend_deg", 12.0);
  parameters.set("missing_vine_share", 0.16).set("leaf_cards_per_m", 10.0);
  const auto world = registry.make_world("vineyard", parameters, WorldContext{});
  const physics::WorldScene scene(*world);
  Parcel parcel;
  parcel.truth = measure_truth(scene, *world);

  constexpr double kMargin_m = 5.0, kAbove_m = 40.0, kApart_m = 8.0;
  const SurveyArea area(parcel.truth.boundary_W, 0.0);
  const Eigen::AlignedBox2d box = area.box_W();
  const Eigen::Vector2d middle = box.center();
  const double ground_m = world->terrain->height_m(middle.x(), middle.y());
  std::vector<Pose> poses;
  for (double x = box.min().x() - kMargin_m; x <= box.max().x() + kMargin_m; x += kApart_m) {
    for (double y = box.min().y() - kMargin_m; y <= box.max().y() + kMargin_m; y += kApart_m) {
      poses.push_back(test::looking_down(x, y, ground_m + kAbove_m));
    }
  }
  PhotogrammetryOptions options;
  options.density_per_m2 = 600.0;
  parcel.cloud.origin_W = {std::round(middle.x()), std::round(middle.y()), std::round(ground_m)};
  sample_photogrammetry(
      scene, *world, test::square_camera(), poses, area, options,
      [&](std::span<const SampledPoint> points) {
        for (const SampledPoint& point : points) {
          parcel.cloud.points.push_back((point.p_W - parcel.cloud.origin_W).cast<float>());
        }
      });
  return parcel;
}

/// Figures of a map, in units of the table's columns.
struct Figures {
  static constexpr std::array<const char*, 5> kNames = {
      "rows found", "worst end, cm", "worst direction, mdeg", "mesh volume, %", "containment, %"};
  static constexpr std::array<int, 5> kDigits = {0, 1, 0, 1, 2};
  std::array<double, 5> of{};

  std::string text(std::size_t k, const char* format) const {
    return fmt::format(fmt::runtime(format), of[k], kDigits[k]);
  }
};

/// @returns nothing if no map is made
std::optional<Figures> map_figures(const Parcel& parcel, const MappingThresholds& thresholds) {
  CloudMapOptions options;
  options.thresholds = thresholds;
  options.occupancy.cell_m = 0.0;
  ParcelCloud cloud = parcel.cloud;
  try {
    const CloudMap map = make_cloud_map(cloud, options);
    const MapComparison comparison = compare_with_truth(map, parcel.truth);
    double direction_deg = 0.0;
    for (const RowComparison& row : comparison.rows) {
      direction_deg = std::max(direction_deg, std::abs(row.bearing_deg));
    }
    // Extra rows, which do not exist, count against those found.
    const auto found =
        static_cast<double>(comparison.found()) - static_cast<double>(comparison.extra_rows.size());
    return Figures{{found, 100.0 * comparison.worst_end_m(), 1000.0 * direction_deg,
                    100.0 * comparison.volume_share, 100.0 * map.report.containment}};
  } catch (const ConfigError&) {
    return std::nullopt;
  }
}

/// Change of figure k as printed; one that rounds to zero is "0".
std::string change_text(const Figures& normal, const std::optional<Figures>& varied,
                        std::size_t k) {
  if (!varied) return "no map";
  Figures difference = *varied;
  difference.of[k] -= normal.of[k];
  const std::string text = difference.text(k, "{:+.{}f}");
  const bool is_zero = text.find_first_of("123456789") == std::string::npos;
  return is_zero ? std::string("0") : text;
}

void run() {
  const Parcel parcel = make_parcel();
  const std::optional<Figures> normal = map_figures(parcel, {});
  if (!normal) throw ConfigError("no map is made with the defaults");
  fmt::print("{} points, {} rows. Defaults:", parcel.cloud.points.size(), parcel.truth.rows.size());
  for (std::size_t k = 0; k < normal->of.size(); ++k) {
    fmt::print("{} {} {}", k > 0 ? "," : "", Figures::kNames[k], normal->text(k, "{:.{}f}"));
  }
  fmt::print("\n\n| threshold | default | unit |");
  for (const char* name : Figures::kNames) fmt::print(" {} |", name);
  fmt::print("\n|---|---|---|---|---|---|---|---|\n");

  const std::vector<Threshold> all = all_thresholds();
  int without = 0;
  for (const Threshold& threshold : all) {
    MappingThresholds defaults;
    const double value = threshold.in(defaults);
    std::array<std::optional<Figures>, 2> varied;
    for (const int side : {0, 1}) {
      MappingThresholds thresholds;
      threshold.in(thresholds) = (side == 0 ? 0.8 : 1.2) * value;
      varied[static_cast<std::size_t>(side)] = map_figures(parcel, thresholds);
    }
    std::string line = fmt::format("| `{}` | {:g} | {} |", threshold.name, value, threshold.unit);
    bool changes = false;
    for (std::size_t k = 0; k < normal->of.size(); ++k) {
      std::string cell;
      bool cell_changes = false;
      for (const std::optional<Figures>& figures : varied) {
        const std::string change = change_text(*normal, figures, k);
        cell_changes |= change != "0";
        cell += (cell.empty() ? "" : " / ") + change;
      }
      changes |= cell_changes;
      line += cell_changes ? fmt::format(" {} |", cell) : " |";
    }
    without += changes ? 0 : 1;
    if (changes) fmt::print("{}\n", line);
    std::fflush(stdout);
  }
  fmt::print("\nNo change of these figures: {} of {} thresholds.\n", without, all.size());
}

}  // namespace
}  // namespace vinerow::mapping

int main() {
  try {
    vinerow::mapping::run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
