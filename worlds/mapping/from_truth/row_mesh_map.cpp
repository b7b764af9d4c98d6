#include "worlds/mapping/from_truth/row_mesh_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "engine/api/file_shelf.h"
#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/core/log.h"
#include "worlds/mapping/folder/map_files.h"
#include "worlds/mapping/from_truth/chain_errors.h"
#include "worlds/mapping/model/map_placement.h"

namespace vinerow::mapping {
namespace {

RowCurve curve_of(const PlantRow& row) {
  std::vector<Eigen::Vector2d> points = seen_from_above(row.line_W);
  if (points.size() < 2) {
    throw ConfigError(fmt::format("map row_mesh: row {} has no length", row.id));
  }
  return RowCurve(std::move(points));
}

/// Height of the ground below the rows, from the terrain or by rays.
GroundHeight ground_in(const WorldModel& world, const SceneQuery& scene) {
  if (world.terrain) {
    return [&world](double x, double y) { return world.terrain->height_m(x, y); };
  }
  return [&scene](double x, double y) { return scene.ground_height_m(x, y, 1e4).value_or(0.0); };
}

/// Lines that follow the ground: a survey walks along the row.
void lift_rows(const GroundHeight& ground, double step_m, std::vector<PlantRow>& rows) {
  for (PlantRow& row : rows) {
    const RowCurve curve = curve_of(row);
    std::vector<double> stations_m{0.0, curve.length_m()};
    for (double s_m = step_m; s_m < curve.length_m(); s_m += step_m) stations_m.push_back(s_m);
    // Corners of the given line stay.
    for (const Eigen::Vector3d& corner_W : row.line_W) {
      stations_m.push_back(curve.nearest_s_m(corner_W.head<2>()));
    }
    std::sort(stations_m.begin(), stations_m.end());
    row.line_W.clear();
    double last_m = -1.0;
    for (const double s_m : stations_m) {
      if (s_m - last_m < 1e-3) continue;
      const Eigen::Vector2d p_W = curve.point_W(s_m);
      row.line_W.emplace_back(p_W.x(), p_W.y(), ground(p_W.x(), p_W.y()));
      last_m = s_m;
    }
  }
}

/// Half way to the next row, but not farther than leaves reach.
double side_reach_m(const std::vector<PlantRow>& rows, std::size_t index) {
  const PlantRow& row = rows[index];
  double reach_m = std::max(1.0, 1.5 * row.canopy_width_m);
  const RowCurve own = curve_of(row);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (k == index) continue;
    const RowCurve other = curve_of(rows[k]);
    for (const double share : {0.1, 0.5, 0.9}) {
      double apart_m = 0.0;
      other.nearest_s_m(own.point_W(share * own.length_m()), &apart_m);
      reach_m = std::min(reach_m, 0.5 * apart_m);
    }
  }
  return reach_m;
}

/// What the row itself says, where no canopy was found.
SectionChain chain_of_row(const PlantRow& row, const RowCurve& curve,
                          const CanopySurveyOptions& options, RandomStream& random) {
  SectionChain chain;
  const std::vector<double> half_m(static_cast<std::size_t>(options.levels),
                                   0.5 * row.canopy_width_m);
  for (const double s_m : draw_stations(0.0, curve.length_m(), options, 2, random)) {
    chain.push_back({s_m, row.canopy_base_m, row.canopy_top_m, half_m, half_m});
  }
  keep_open(chain);
  return chain;
}

std::int64_t count_true_triangles(const WorldModel& world) {
  std::int64_t count = 0;
  for (const MeshInstance& instance : world.meshes) {
    if (instance.collides && instance.surface == SurfaceClass::kCanopy) {
      count += static_cast<std::int64_t>(instance.mesh->triangles.size());
    }
  }
  return count;
}

class Surveyor {
 public:
  Surveyor(const RowMeshParams& params, const MapContext& context)
      : params_(params), context_(context), rows_(context.world->rows->rows) {}

  std::vector<RowMesh> survey(RowMeshReport& report) {
    std::vector<std::vector<SectionChain>> chains;
    const GroundHeight ground = ground_in(*context_.world, *context_.scene);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const RowCurve curve = curve_of(rows_[k]);
      RandomStream random = stream(fmt::format("sections.row_{:02}", k));
      const RowSurroundings around{side_reach_m(rows_, k), 1.5 * rows_[k].canopy_top_m + 1.0};
      auto found = survey_canopy(*context_.scene, curve, ground, around, params_.sections, random);
      if (found.empty()) {
        report.unseen_rows.push_back(rows_[k].id);
        found.push_back(chain_of_row(rows_[k], curve, params_.sections, random));
      }
      if (params_.fill_gaps) fill_gaps(found, params_.sections, random);
      chains.push_back(std::move(found));
    }
    remove_missing(chains, report);
    std::vector<RowMesh> meshes;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      RandomStream random = stream(fmt::format("surface.row_{:02}", k));
      const RowCurve curve = curve_of(rows_[k]);
      for (SectionChain& chain : chains[k]) {
        add_surface_noise(chain, params_.surface_noise_std_m, params_.surface_noise_length_m,
                          random);
        meshes.push_back({rows_[k].id, make_chain_hull(chain, curve, ground)});
      }
    }
    return meshes;
  }

  /// Fresh numbers of this map, or of the survey that it shares with others.
  RandomStream stream(const std::string& component) const {
    if (params_.survey.empty()) return context_.random(component);
    return RandomStream(context_.seed, "", fmt::format("map.{}.{}", params_.survey, component));
  }

 private:
  void remove_missing(std::vector<std::vector<SectionChain>>& chains, RowMeshReport& report) {
    for (const MissingStretch& missing : params_.missing) {
      if (std::none_of(rows_.begin(), rows_.end(),
                       [&](const PlantRow& row) { return row.id == missing.row; })) {
        throw ConfigError(fmt::format("missing: there is no row {}, the last one is {}",
                                      missing.row, rows_.back().id));
      }
      report.missing.push_back(missing);
    }
    if (params_.random_missing) draw_missing(chains, report);
    for (const MissingStretch& missing : report.missing) {
      for (std::size_t k = 0; k < rows_.size(); ++k) {
        if (rows_[k].id == missing.row) remove_stretch(chains[k], missing.from_m, missing.to_m);
      }
    }
  }

  void draw_missing(const std::vector<std::vector<SectionChain>>& chains, RowMeshReport& report) {
    const double length_m = params_.random_missing->length_m;
    // Evenly over all places where a gap fits into canopy.
    struct FreeSpace {
      int row;
      double from_m, free_m;
    };
    std::vector<FreeSpace> free_spaces;
    double all_m = 0.0;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      for (const SectionChain& chain : chains[k]) {
        const double free_m = chain.back().s_m - chain.front().s_m - length_m;
        if (free_m <= 0.0) continue;
        free_spaces.push_back({rows_[k].id, chain.front().s_m, free_m});
        all_m += free_m;
      }
    }
    RandomStream random = stream("missing");
    for (int n = 0; n < params_.random_missing->count; ++n) {
      if (free_spaces.empty()) {
        throw ConfigError(fmt::format(
            "random_missing: length_m = {} m, no row has canopy of that length", length_m));
      }
      double at_m = random.uniform(0.0, all_m);
      std::size_t k = 0;
      while (k + 1 < free_spaces.size() && at_m > free_spaces[k].free_m)
        at_m -= free_spaces[k++].free_m;
      report.missing.push_back({free_spaces[k].row, free_spaces[k].from_m + at_m,
                                free_spaces[k].from_m + at_m + length_m});
    }
  }

  const RowMeshParams& params_;
  const MapContext& context_;
  const std::vector<PlantRow>& rows_;
};

}  // namespace

std::unique_ptr<RowMap> make_row_mesh_map(const ParameterSet& parameters, const MapContext& context,
                                          RowMeshReport* report) {
  VINEROW_DEMAND(context.world != nullptr && context.scene != nullptr);
  if (context.world->rows->rows.empty()) {
    throw ConfigError(
        fmt::format("map row_mesh: world '{}' has no plant rows to survey", context.world->name));
  }
  const RowMeshParams params = row_mesh_table().read(parameters, "");
  RowMeshReport own;
  RowMeshReport& made = report != nullptr ? *report : own;
  made = {};
  auto map = std::make_unique<RowMap>(context.world->rows);
  lift_rows(ground_in(*context.world, *context.scene), params.sections.spacing_high_m, map->rows);
  Surveyor surveyor(params, context);
  if (!params.folder.empty()) {
    check_folder_parameters(params);
    map->meshes = *keep<std::vector<RowMesh>>(context.shelf, file_mark(params.folder),
                                              [&] { return load_meshes(params.folder.string()); });
  } else {
    map->meshes = surveyor.survey(made);
  }
  if (!made.unseen_rows.empty()) {
    log_note(fmt::format(
        "map of {}: no canopy on row{} {}, whose mesh has the row's own width and height",
        context.vehicle, made.unseen_rows.size() == 1 ? "" : "s",
        fmt::join(made.unseen_rows, ", ")));
  }
  made.accuracy = measure_accuracy(*context.scene, context.world->rows->rows, map->meshes);
  made.true_triangles = count_true_triangles(*context.world);
  for (const RowMesh& mesh : map->meshes) {
    made.triangles += static_cast<std::int64_t>(mesh.mesh_W.triangles.size());
  }

  const double stated_m = params.stated_surface_std_m;
  const double stated_length_m = params.stated_correlation_length_m;
  MapAccuracy& accuracy = map->accuracy;
  if (stated_m > 0.0 || made.accuracy.points > 0) {
    accuracy.surface_std_m = stated_m > 0.0 ? stated_m : made.accuracy.rms_m;
  }
  if (stated_length_m > 0.0 || made.accuracy.points > 0) {
    accuracy.correlation_length_m =
        stated_length_m > 0.0 ? stated_length_m : made.accuracy.correlation_length_m;
  }
  accuracy.offset_std_m = params.offset_std_m;

  MapPlacement placement;
  placement.middle_W = middle_of(context.world->rows->rows);
  RandomStream random = surveyor.stream("offset");
  const double z = random.normal(), y = random.normal(), x = random.normal();
  placement.shift_m =
      params.offset_m + accuracy.offset_std_m.cwiseProduct(Eigen::Vector3d(x, y, z));
  placement.turn_rad = params.rotation_rad;
  placement.scale = params.scale;
  made.shift_m = placement.shift_m;
  if (placement.moves()) {
    place_meshes(placement, map->meshes);
    if (params.move_rows) place_rows(placement, *map);
  }
  if (!params.save_to.empty()) save_meshes(map->meshes, params.save_to);
  return map;
}

void register_row_mesh_map(Registry& registry) {
  PartSpec spec;
  spec.name = "row_mesh";
  spec.description =
      "the true rows with meshes of few triangles fitted to their canopy, after papers A, section "
      "3.2, and C, section 2.2, and with configurable errors";
  row_mesh_table().add_to(spec);
  registry.add_map(std::move(spec), [](const ParameterSet& parameters, const MapContext& context) {
    return make_row_mesh_map(parameters, context);
  });
}

}  // namespace vinerow::mapping
