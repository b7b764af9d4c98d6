#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "engine/io/geo/area_file.h"
#include "engine/io/meshes/mesh_scene_writer.h"
#include "engine/io/meshes/mesh_writer.h"
#include "engine/math/angles.h"
#include "engine/render/scene.h"
#include "engine/sim/simulation.h"
#include "tools/pictures/map_picture_files.h"
#include "tools/pictures/map_truth.h"
#include "tools/report/map_captions.h"
#include "tools/report/map_html.h"
#include "tools/vinerow/subcommands.h"
#include "tools/vinerow/table_flags.h"
#include "worlds/mapping/folder/map_folder.h"
#include "worlds/mapping/folder/map_gis.h"
#include "worlds/mapping/jobs/cloud_map_job_params.h"
#include "worlds/mapping/pipeline/make_cloud_map.h"
#include "worlds/mapping/reading/cloud_source.h"

namespace vinerow::tools {
namespace {

namespace fs = std::filesystem;

struct MapArguments {
  fs::path cloud, out, scenario, boundary, truth;
  std::vector<fs::path> plugins;
  std::string title;
  std::vector<double> origin;
  std::vector<std::string> exports;  ///< "obj", "glb", "ply"
  bool no_pictures = false;
  std::shared_ptr<const ParameterSet> method;  ///< rows of cloud_map_job_table()
};

/// Wall time and peak memory of each phase.
class Stopwatch {
 public:
  void end_phase(const std::string& name) {
    const auto now = std::chrono::steady_clock::now();
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    phases_.push_back({name, std::chrono::duration<double>(now - last_).count(),
                       static_cast<double>(usage.ru_maxrss) * 1024.0 * 1e-6});
    last_ = now;
  }
  const std::vector<mapping::MapPhase>& phases() const { return phases_; }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::vector<mapping::MapPhase> phases_;
};

std::optional<GeoOrigin> find_map_origin(const MapArguments& arguments) {
  if (!arguments.origin.empty() && !arguments.scenario.empty()) {
    throw ConfigError("map: give either --origin or --scenario, not both");
  }
  if (!arguments.scenario.empty()) {
    ScenarioArguments of_scenario;
    of_scenario.file = arguments.scenario;
    of_scenario.plugins = arguments.plugins;
    Registry registry;
    return build_world(load(of_scenario, registry), registry)->origin;
  }
  if (arguments.origin.empty()) return std::nullopt;
  const std::vector<double>& given = arguments.origin;
  if (given.size() < 2 || given.size() > 3) {
    throw ConfigError("--origin: must be latitude,longitude in degrees, or with an altitude in m");
  }
  if (!(std::abs(given[0]) <= 90.0) || !(std::abs(given[1]) <= 180.0)) {
    throw ConfigError(fmt::format(
        "--origin: {:g},{:g} must be latitude within +-90 and longitude within +-180 degrees",
        given[0], given[1]));
  }
  return GeoOrigin{rad_from_deg(given[0]), rad_from_deg(given[1]),
                   given.size() > 2 ? given[2] : 0.0};
}

std::vector<Eigen::Vector2d> read_boundary(const fs::path& file, const GeoOrigin& origin,
                                           bool has_origin) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw ConfigError(fmt::format("--boundary: '{}' does not exist", file.string()));
  }
  if (file.extension() != ".csv" && !has_origin) {
    throw ConfigError(fmt::format(
        "--boundary: '{}' is in degrees, but the cloud has no geographic position: give --crs "
        "(--origin is optional), or the boundary as CSV in metres",
        file.string()));
  }
  Polygon polygon = io::read_area(file.string(), origin);
  if (const auto fault = io::find_area_fault(polygon)) {
    throw ConfigError(fmt::format("--boundary: '{}': {}", file.string(), *fault));
  }
  if (signed_area_m2(polygon) < 0.0) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

/// Writes all row meshes into one file of each kind, for other programs.
void export_meshes(const std::vector<RowMesh>& meshes, const std::vector<std::string>& kinds,
                   const fs::path& folder) {
  std::vector<io::NamedMesh> named;
  std::map<int, int> hulls;
  for (const RowMesh& mesh : meshes) {
    named.push_back(
        {fmt::format("row_{:02}_hull_{:02}", mesh.row, hulls[mesh.row]++), &mesh.mesh_W});
  }
  for (const char* file : {"rows.obj", "rows.glb", "rows.ply"}) {
    std::error_code error;
    fs::remove(folder / file, error);
  }
  for (const std::string& kind : kinds) {
    const fs::path file = folder / ("rows." + kind);
    if (kind == "obj") io::write_obj(named, file);
    if (kind == "glb") io::write_glb(named, file, io::canopy_material());
    if (kind == "ply") io::write_ply(io::join_meshes(named), file);
  }
}

std::vector<ReportPicture> write_pictures(const mapping::CloudMap& map,
                                          const mapping::ParcelCloud& cloud,
                                          const mapping::OccupancyOptions& occupancy,
                                          const fs::path& folder, const std::string& title) {
  std::vector<ReportPicture> pictures;
  for (const fs::path& file :
       write_map_pictures(map, cloud, occupancy, title, folder / "pictures")) {
    pictures.push_back(
        {"pictures/" + file.filename().string(), map_picture_caption(file.stem().string())});
  }
  return pictures;
}

std::string timing_json(const std::vector<mapping::MapPhase>& phases) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  double total_s = 0.0, peak_MB = 0.0;
  for (const mapping::MapPhase& phase : phases) {
    list.push_back(
        {{"name", phase.name}, {"wall_s", phase.wall_s}, {"peak_memory_MB", phase.peak_memory_MB}});
    total_s += phase.wall_s;
    peak_MB = std::max(peak_MB, phase.peak_memory_MB);
  }
  nlohmann::ordered_json json;
  json["phases"] = list;
  json["total_s"] = total_s;
  json["peak_memory_MB"] = peak_MB;
  return json.dump(2) + "\n";
}

void print_phases(const std::vector<mapping::MapPhase>& phases) {
  double total_s = 0.0;
  std::string line;
  for (const mapping::MapPhase& phase : phases) {
    total_s += phase.wall_s;
    line += fmt::format("{}{} {:.2f}", line.empty() ? "" : ", ", phase.name, phase.wall_s);
  }
  fmt::print("time           {:.2f} s: {}\n", total_s, line);
  fmt::print("memory         {:.0f} MB peak\n",
             phases.empty() ? 0.0 : phases.back().peak_memory_MB);
}

void make_map(const MapArguments& arguments) {
  Stopwatch watch;
  // Report faults of the options before the long computation.
  const mapping::CloudMapJobParams params =
      mapping::cloud_map_job_table().read(*arguments.method, "map");
  mapping::CloudMapOptions options = params.options;
  mapping::check_options(options);
  std::optional<mapping::CloudTruth> truth;
  if (!arguments.truth.empty()) truth = mapping::read_cloud_truth(arguments.truth);
  mapping::CloudReadOptions read_options = params.reading;
  read_options.origin = find_map_origin(arguments);
  const io::ResultFolder folder(arguments.out);
  if (!arguments.scenario.empty()) watch.end_phase("scenario");

  mapping::CloudReadReport read;
  mapping::ParcelCloud cloud = mapping::read_parcel_cloud(arguments.cloud, read_options, read);
  if (!read.crs_warning.empty()) fmt::print(stderr, "vinerow: warning: {}\n", read.crs_warning);
  watch.end_phase("read");
  if (!arguments.boundary.empty()) {
    options.boundary_W = read_boundary(arguments.boundary, read.origin, read.has_origin);
  }
  mapping::CloudMap map = mapping::make_cloud_map(
      cloud, options, [&](const std::string& phase) { watch.end_phase(phase); });
  mapping::add_source(read, map);
  mapping::save_map(map, arguments.out);
  mapping::save_gis(map, cloud, arguments.out);
  export_meshes(map.map.meshes, arguments.exports, arguments.out);
  watch.end_phase("files");

  const std::string title =
      arguments.title.empty() ? arguments.cloud.stem().string() : arguments.title;
  std::vector<ReportPicture> pictures;
  if (!arguments.no_pictures) {
    pictures = write_pictures(map, cloud, options.occupancy, arguments.out, title);
    watch.end_phase("pictures");
  }
  write_whole_file(arguments.out / "report.html", map_report_html(map, pictures, title));
  write_whole_file(arguments.out / "timing.json", timing_json(watch.phases()));
  fmt::print("{}", map_report_text(map));
  if (truth)
    fmt::print("{}", comparison_text(mapping::compare_with_truth(map, *truth), map, *truth));
  print_phases(watch.phases());
  fmt::print("map            {}\nreport         {}\n", (arguments.out / "map.json").string(),
             (arguments.out / "report.html").string());
}

}  // namespace

void add_map_command(CLI::App& app, int& exit_status) {
  auto arguments = std::make_shared<MapArguments>();
  MapArguments& a = *arguments;
  CLI::App* command = app.add_subcommand(
      "map", "turn a point cloud of a vineyard into a low-complexity map: rows, meshes, grid");
  command->add_option("cloud", a.cloud, "point cloud: LAS, PLY, PCD, XYZ or CSV")->required();
  command->add_option("--out", a.out, "folder for the map (default: maps/<name of the cloud>)");
  command->add_option("--title", a.title, "title of the report (default: the name of the cloud)");
  command
      ->add_option("--origin", a.origin,
                   "latitude,longitude[,altitude] of the map's origin x = y = z = 0 (default: the "
                   "middle of the cloud)")
      ->delimiter(',');
  command->add_option("--scenario", a.scenario, "use the origin of this scenario's world");
  command->add_option("--plugin", a.plugins, "load a plug-in for the scenario")
      ->allow_extra_args(false);
  command->add_option("--boundary", a.boundary,
                      "boundary of the parcel: GeoJSON, or CSV with x,y in metres in the map");
  command->add_option("--truth", a.truth,
                      "compare with the truth that `vinerow cloud` wrote (.truth.json)");
  command
      ->add_option("--export", a.exports,
                   "also write all row meshes into one file: rows.obj, rows.glb, rows.ply")
      ->delimiter(',')
      ->check(CLI::IsMember({"obj", "glb", "ply"}));
  // The boundary comes from a file here, and there is no world whose rows could be counted.
  a.method = add_table_flags(*command, mapping::cloud_map_job_table().specs(),
                             {.without = {"boundary", "numbering"},
                              .names = {{"row_spacing_m", "--spacing"},
                                        {"min_row_length_m", "--row-length"},
                                        {"occupancy_cell_m", "--cell"}},
                              .group = "Method",
                              .general = {"crs", "thin"}});
  command->add_flag("--no-pictures", a.no_pictures, "draw no pictures");
  command->callback([arguments, &exit_status] {
    if (arguments->out.empty()) arguments->out = fs::path("maps") / arguments->cloud.stem();
    make_map(*arguments);
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
