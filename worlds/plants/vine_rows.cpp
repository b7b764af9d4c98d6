#include "worlds/plants/vine_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "worlds/parts/foliage.h"
#include "worlds/parts/leaf_area.h"
#include "worlds/plants/leaf_outline.h"
#include "worlds/plants/plant_instance.h"
#include "worlds/plants/vine_meshes.h"

namespace vinerow::worlds {
namespace {

/// Vines without a gap between them, and the canopy's extent.
struct Run {
  std::size_t first_vine, vine_count;
  double start_m, end_m;
};

std::vector<Run> find_runs(const VineRow& row) {
  constexpr double kGap = 1.6;
  std::vector<Run> runs;
  const auto& s = row.vine_s_m;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const bool joined = i > 0 && s[i] - s[i - 1] <= kGap * row.vine_spacing_m;
    if (!joined) runs.push_back({i, 0, s[i] - 0.5 * row.vine_spacing_m, 0.0});
    ++runs.back().vine_count;
    runs.back().end_m = s[i] + 0.5 * row.vine_spacing_m;
  }
  return runs;
}

/// A piece of a run that is drawn as one.
struct Chunk {
  std::size_t first_vine, vine_count;
  double start_m, end_m;
};

std::vector<Chunk> cut_run(const VineRow& row, const Run& run, double chunk_m) {
  const auto per_chunk =
      static_cast<std::size_t>(std::max(1.0, std::round(chunk_m / row.vine_spacing_m)));
  std::vector<Chunk> chunks;
  for (std::size_t i = 0; i < run.vine_count; i += per_chunk) {
    const std::size_t count = std::min(per_chunk, run.vine_count - i);
    const std::size_t first = run.first_vine + i, last = first + count - 1;
    const auto& s = row.vine_s_m;
    const double start = i == 0 ? run.start_m : 0.5 * (s[first - 1] + s[first]);
    const double end = i + count == run.vine_count ? run.end_m : 0.5 * (s[last] + s[last + 1]);
    chunks.push_back({first, count, start, end});
  }
  return chunks;
}

/// Largest distance of a row from the chord of a chunk, in its middle.
double largest_sag_m(const VineRow& row, const std::vector<Chunk>& chunks) {
  double largest_m = 0.0;
  for (const Chunk& chunk : chunks) {
    const Eigen::Vector2d chord_middle =
        0.5 * (row.curve.point_W(chunk.start_m) + row.curve.point_W(chunk.end_m));
    const Eigen::Vector2d middle = row.curve.point_W(0.5 * (chunk.start_m + chunk.end_m));
    largest_m = std::max(largest_m, (middle - chord_middle).norm());
  }
  return largest_m;
}

/// Organs of a chunk grow along a straight line: where the row bends, chunks are so short that its
/// trunks, posts and hull stay with them.
std::vector<Chunk> cut_bent_run(const VineRow& row, const Run& run, double chunk_m) {
  constexpr double kSag_m = 0.03, kShorter = 0.8;
  std::vector<Chunk> chunks = cut_run(row, run, chunk_m);
  while (largest_sag_m(row, chunks) > kSag_m && chunk_m > row.vine_spacing_m) {
    chunk_m *= kShorter;
    chunks = cut_run(row, run, chunk_m);
  }
  return chunks;
}

class Planter {
 public:
  Planter(WorldModel& world, const mapping::GroundHeight& ground, const VinePlanting& planting,
          MeshStore& store)
      : world_(world), ground_(ground), planting_(planting), store_(store) {}

  void plant(std::size_t number, const VineRow& row) {
    const std::string row_name = fmt::format("row_{:02}", number);
    int run_number = 0, chunk_number = 0;
    for (const Run& run : find_runs(row)) {
      std::vector<CanopyStretch> stretches;
      leaf_area_m2_ = 0.0;
      const auto cut = planting_.growth ? cut_bent_run : cut_run;
      for (const Chunk& chunk : cut(row, run, planting_.chunk_m)) {
        const std::string chunk_name = fmt::format("{}/chunk_{:02}", row_name, chunk_number++);
        const std::string shape_key = shape_of(chunk, chunk_name);
        stretches.push_back({chunk.start_m, chunk.end_m, &shapes_.at(shape_key)});
        if (planting_.growth) {
          add_organs(row, chunk, chunk_name, shape_key);
        } else {
          add_leaves(row, chunk, chunk_name, shape_key);
        }
        add_trunks(row, chunk, chunk_name);
      }
      if (planting_.has_leaves) add_hull(row, row_name, run_number++, stretches);
    }
    if (row.post_s_m.size() >= 2) add_posts(row, row_name);
  }

 private:
  RandomStream random(const std::string& name) const {
    return RandomStream(planting_.seed, "", "world.plants." + name);
  }

  /// Stretches of the same number of vines and (to a centimetre) length share a few shapes.
  std::string shape_of(const Chunk& chunk, const std::string& chunk_name) {
    const long length_cm = std::lround(100.0 * (chunk.end_m - chunk.start_m));
    const auto variant =
        random(chunk_name).next_u64() % static_cast<std::uint64_t>(planting_.variants);
    const std::string key =
        fmt::format("{}_vines_{}_cm_variant_{}", chunk.vine_count, length_cm, variant);
    if (shapes_.find(key) == shapes_.end()) {
      shapes_.emplace(key, CanopyShape(planting_.canopy, 0.01 * static_cast<double>(length_cm),
                                       static_cast<int>(chunk.vine_count), random("shape." + key)));
    }
    return key;
  }

  void add_hull(const VineRow& row, const std::string& row_name, int number,
                const std::vector<CanopyStretch>& stretches) {
    const std::string name = fmt::format("canopy_hull/{}/run_{}", row_name, number);
    MeshInstance hull = plant_instance(
        name,
        store_.get(
            name,
            [&] { return make_canopy_hull(row.curve, ground_, stretches, planting_.canopy); }),
        SurfaceClass::kCanopy);
    hull.visible = false;
    hull.light = planting_.growth ? Light::kPasses : Light::kMeets;
    if (planting_.growth) {
      hull.foliage =
          foliage_in(*hull.mesh, leaf_area_m2_, std::sqrt(planting_.growth->variety.leaf_area_m2));
    }
    world_.meshes.push_back(std::move(hull));
  }

  const VineOrgans& organs_of(const std::string& shape_key, const Chunk& chunk) {
    const auto found = organs_.find(shape_key);
    if (found != organs_.end()) return found->second;
    const double length_m = shapes_.at(shape_key).length_m();
    return organs_
        .emplace(shape_key, grow_vines(*planting_.growth, planting_.space, length_m,
                                       static_cast<int>(chunk.vine_count), planting_.seed,
                                       "world.plants.organs." + shape_key))
        .first->second;
  }

  void add_organs(const VineRow& row, const Chunk& chunk, const std::string& chunk_name,
                  const std::string& shape_key) {
    const Pose X_WM = mapping::stretch_frame(row.curve, ground_, chunk.start_m, chunk.end_m);
    const VineOrgans& organs = organs_of(shape_key, chunk);
    for (const LeafOrgan& leaf : organs.leaves) leaf_area_m2_ += leaf.area_m2;
    const auto add = [&](const char* what, Label label, const auto& list, const auto& make) {
      if (list.empty()) return;
      for (int level = 0; level < 3; ++level) {
        MeshInstance instance =
            plant_instance(fmt::format("{}/{}#lod{}", what, chunk_name, level),
                           store_.get(fmt::format("{}/{}#lod{}", what, shape_key, level),
                                      [&] { return make(list, level); }),
                           SurfaceClass::kCanopy);
        instance.X_WM = X_WM;
        instance.label = label;
        instance.collides = false;
        if (level > 0) instance.light = Light::kPasses;
        world_.meshes.push_back(std::move(instance));
      }
    };
    add("canopy", Label::kLeaf, organs.leaves, make_leaf_mesh);
    add("shoots", Label::kWood, organs.shoots, make_shoot_mesh);
    add("bunches", Label::kBunch, organs.bunches, make_bunch_mesh);
  }

  void add_leaves(const VineRow& row, const Chunk& chunk, const std::string& chunk_name,
                  const std::string& shape_key) {
    const Pose X_WM = mapping::stretch_frame(row.curve, ground_, chunk.start_m, chunk.end_m);
    for (int level = 0; level < 3; ++level) {
      const std::string mesh_name = fmt::format("leaves/{}#lod{}", shape_key, level);
      const auto mesh = store_.get(mesh_name, [&] {
        return make_vine_foliage(shapes_.at(shape_key),
                                 vine_foliage_detail(planting_.leaf_cards_per_m, level),
                                 random(mesh_name));
      });
      MeshInstance leaves = plant_instance(fmt::format("canopy/{}#lod{}", chunk_name, level), mesh,
                                           SurfaceClass::kCanopy);
      leaves.X_WM = X_WM;
      leaves.material = leaf_material();
      leaves.collides = false;
      leaves.light = Light::kPasses;
      world_.meshes.push_back(std::move(leaves));
    }
  }

  void add_trunks(const VineRow& row, const Chunk& chunk, const std::string& chunk_name) {
    const auto first = row.vine_s_m.begin() + static_cast<std::ptrdiff_t>(chunk.first_vine);
    const std::vector<double> vines(first, first + static_cast<std::ptrdiff_t>(chunk.vine_count));
    for (int level = 0; level < 2; ++level) {
      const std::string name = fmt::format("trunk/{}#lod{}", chunk_name, level);
      MeshInstance trunks = plant_instance(
          name,
          store_.get(name,
                     [&] {
                       return make_trunks(row.curve, ground_, vines, row.vine_spacing_m,
                                          planting_.trellis, level, random("trunk/" + chunk_name));
                     }),
          SurfaceClass::kTrunk);
      trunks.collides = level == 0;
      if (level > 0) trunks.light = Light::kPasses;
      world_.meshes.push_back(std::move(trunks));
    }
  }

  void add_posts(const VineRow& row, const std::string& row_name) {
    const double start_m = row.post_s_m.front(), end_m = row.post_s_m.back();
    const std::vector<double> between(row.post_s_m.begin() + 1, row.post_s_m.end() - 1);
    const auto add = [&](const std::string& name, SurfaceClass surface, auto make) {
      world_.meshes.push_back(plant_instance(name, store_.get(name, make), surface));
    };
    const TrellisParams& trellis = planting_.trellis;
    add("end_post/" + row_name, SurfaceClass::kPost,
        [&] { return make_end_posts(row.curve, ground_, start_m, end_m, trellis); });
    if (!between.empty()) {
      add("post/" + row_name, SurfaceClass::kPost,
          [&] { return make_line_posts(row.curve, ground_, between, trellis); });
    }
    add("wire/" + row_name, SurfaceClass::kWire,
        [&] { return make_wires(row.curve, ground_, start_m, end_m, trellis); });
    if (!is_pergola(planting_)) return;
    const RoofParams roof{roof_height_m(planting_.space), planting_.space.width_m};
    add("roof_wire/" + row_name, SurfaceClass::kWire,
        [&] { return make_roof_wires(row.curve, ground_, start_m, end_m, trellis, roof); });
    add("roof_beam/" + row_name, SurfaceClass::kPost,
        [&] { return make_roof_beams(row.curve, ground_, row.post_s_m, roof); });
  }

  WorldModel& world_;
  const mapping::GroundHeight& ground_;
  const VinePlanting& planting_;
  MeshStore& store_;
  std::map<std::string, CanopyShape> shapes_;
  std::map<std::string, VineOrgans> organs_;
  double leaf_area_m2_ = 0.0;  ///< of the run
};

// Of a pergola, where the user gives no value; chosen.
constexpr double kArmBelowRoof_m = 0.1, kPergolaWidth_m = 2.0;

double roof_m(const VinePlanting& planting) {
  return roof_height_m({.top_m = planting.canopy.top_m});
}

std::string find_fault_in_pergola(const VinePlanting& planting) {
  const TrellisParams& trellis = planting.trellis;
  const double roof = roof_m(planting), top = planting.canopy.top_m;
  const auto height_of_roof = [&] {
    return fmt::format("the height of a pergola's roof, {:.6g} m below canopy_top_m = {:.6g} m",
                       top - roof, top);
  };
  if (trellis.arm_height_m && *trellis.arm_height_m > roof) {
    return fmt::format("arm_height_m = {:.6g} m, must be <= {:.6g} m, {}", *trellis.arm_height_m,
                       roof, height_of_roof());
  }
  if (roof <= kArmBelowRoof_m) {
    return fmt::format("canopy_top_m = {:.6g} m, must be > {:.6g} m for a pergola", top,
                       top - roof + kArmBelowRoof_m);
  }
  if (trellis.posts && trellis.post_height_m < roof) {
    return fmt::format("post_height_m = {:.6g} m, must be >= {:.6g} m, {}", trellis.post_height_m,
                       roof, height_of_roof());
  }
  return "";
}

}  // namespace

const ParameterTable<VinePlanting>& planting_table() {
  using P = VinePlanting;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("canopy_width_m", "m", &P::canopy_width_m, above(0.0, 10.0),
                  "mean width of the foliage across the row; default: 0.55 m, of a pergola 2 m")
          .include(&P::canopy, canopy_table())
          .include(&P::trellis, trellis_table())
          .number("leaf_cards_per_m", "1/m", &P::leaf_cards_per_m, between(10.0, 2000.0),
                  "leaves drawn per metre of row at close range")
          .integer("plant_variants", &P::variants, between(1, 100),
                   "different stretches of foliage that are reused")
          .integer("plant_seed", &P::seed, between(0, 9e15),
                   "seed of plants and ground, apart from the run's seed: the place stays the "
                   "same")
          .group(
              "vines", &P::growth, growth_table(),
              "vines that grow organ by organ with the season, within the canopy's width and top; "
              "absent: cards of leaves, in summer")
          .group("weeds", &P::weeds, weed_table(), kWeedsText)
          .rule([](const P& p) -> std::string {
            if (is_pergola(p)) return find_fault_in_pergola(p);
            if (!p.growth || p.trellis.arm_m() < p.canopy.top_m) return "";
            return fmt::format(
                "arm_height_m = {} m, must be < canopy_top_m = {} m for growing vines",
                p.trellis.arm_m(), p.canopy.top_m);
          });
  return table;
}

bool is_pergola(const VinePlanting& planting) {
  return planting.growth && planting.growth->pruning == Pruning::kPergola;
}

double canopy_width_m(const VinePlanting& planting) {
  return planting.canopy_width_m.value_or(is_pergola(planting) ? kPergolaWidth_m
                                                               : planting.canopy.width_m);
}

std::string find_fault_in_pitch(const VinePlanting& planting, double pitch_m,
                                const std::string& pitch) {
  const double width_m = canopy_width_m(planting);
  if (!is_pergola(planting) || width_m <= pitch_m) return "";
  return fmt::format("canopy_width_m = {:.6g} m, must be <= {} = {:.6g} m for a pergola", width_m,
                     pitch, pitch_m);
}

void check_pitch(const VinePlanting& planting, const RowMap& rows) {
  const auto narrowest = std::ranges::min_element(rows.alleys, {}, &Alley::width_m);
  if (narrowest == rows.alleys.end()) return;
  const std::string fault = find_fault_in_pitch(
      planting, narrowest->width_m, fmt::format("the width of alley {}", narrowest->id));
  if (!fault.empty()) throw ConfigError(fault);
}

VinePlanting settle_growth(VinePlanting planting) {
  planting.canopy.width_m = canopy_width_m(planting);
  if (!planting.growth) return planting;
  if (is_pergola(planting) && !planting.trellis.arm_height_m) {
    planting.trellis.arm_height_m = roof_m(planting) - kArmBelowRoof_m;
  }
  planting.space = {planting.trellis.arm_m(), planting.canopy.width_m, planting.canopy.top_m};
  // A stretch that is long enough for percentiles.
  constexpr double kLength_m = 12.0;
  constexpr int kVines = 12;
  const VineOrgans organs = grow_vines(*planting.growth, planting.space, kLength_m, kVines,
                                       planting.seed, "world.plants.extent");
  std::vector<double> sides, heights;
  for (const LeafOrgan& leaf : organs.leaves) {
    // Half a blade reaches beyond its junction.
    sides.push_back(std::abs(leaf.junction.y()) +
                    0.4 * leaf_length_m(LeafKind::kGrapevine, leaf.area_m2));
    heights.push_back(leaf.junction.z());
  }
  planting.has_leaves = heights.size() >= 20;
  CanopyParams& canopy = planting.canopy;
  if (!planting.has_leaves) {
    canopy.width_m = 0.1;
    canopy.base_m = planting.space.arm_height_m - 0.1;
    canopy.top_m = std::max(planting.trellis.post_height_m, planting.space.arm_height_m);
    return planting;
  }
  const auto percentile = [](std::vector<double>& values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  canopy.width_m = std::min(2.0 * percentile(sides, 0.9), planting.space.width_m);
  canopy.base_m = percentile(heights, 0.03) - 0.05;
  canopy.top_m = percentile(heights, 0.97) + 0.05;
  return planting;
}

double row_end_margin_m(const VinePlanting& planting) {
  const bool lean = planting.trellis.posts && planting.trellis.end_post_lean_rad > 0.0;
  return lean ? 0.5 * planting.canopy.width_m : 0.0;
}

std::vector<double> regular_vines(double length_m, double spacing_m, double missing_share,
                                  RandomStream random) {
  std::vector<double> vines;
  const int count = std::max(1, static_cast<int>(std::floor(length_m / spacing_m + 1e-9)));
  const double margin_m = 0.5 * (length_m - (count - 1) * spacing_m);
  for (int i = 0; i < count; ++i) {
    // One number per vine whether it is missing or not: a changed share keeps the others in place.
    const bool missing = random.uniform() < missing_share;
    if (!missing) vines.push_back(margin_m + i * spacing_m);
  }
  return vines;
}

void plant_vine_rows(WorldModel& world, const std::vector<VineRow>& rows,
                     const mapping::GroundHeight& ground, const VinePlanting& planting,
                     MeshStore& store) {
  std::vector<mapping::RowCurve> curves;
  for (const VineRow& row : rows) curves.push_back(row.curve);
  if (planting.weeds) check_weeds(curves, *planting.weeds);
  Planter planter(world, ground, planting, store);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    VineRow row = rows[i];
    // Arms and foliage of a single vine end with its row.
    row.vine_spacing_m = std::min(row.vine_spacing_m, row.curve.length_m());
    planter.plant(i, row);
  }
  if (planting.weeds) plant_weeds(world, curves, ground, *planting.weeds, planting.seed, store);
}

}  // namespace vinerow::worlds
