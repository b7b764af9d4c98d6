#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <system_error>

#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/physics/check_world.h"
#include "engine/physics/world_scene.h"
#include "engine/sim/pictures.h"
#include "engine/sim/simulation.h"
#include "tools/vinerow/cloud_poses.h"
#include "tools/vinerow/commands.h"
#include "worlds/mapping/cloud/sampling/write_cloud.h"

namespace vinerow::tools {
namespace {

struct CloudArguments {
  ScenarioArguments scenario;
  std::filesystem::path out, log;
  std::string vehicle, sensor;
  worlds::CloudFileOptions file;
  std::vector<double> area;
  double margin_m = 0.0;
  std::optional<double> density_per_m2, uniform_per_m2;
  std::optional<double> noise_m, weeds_m, outliers;
  double match_px = 0.5, max_incidence_deg = 80.0, min_baseline_deg = 3.0;
  int min_views = 3, max_views = 6;
};

void check_cloud_arguments(const CloudArguments& arguments) {
  const bool uniform = arguments.uniform_per_m2.has_value();
  if (arguments.scenario.file.empty() && arguments.log.empty()) {
    throw ConfigError("cloud: give a scenario, or a flown survey by --log");
  }
  if (uniform && (!arguments.log.empty() || arguments.density_per_m2)) {
    throw ConfigError("cloud: --uniform takes no pictures: leave out --log and --density");
  }
  if (!uniform && (arguments.noise_m || arguments.weeds_m || arguments.outliers)) {
    throw ConfigError(
        "cloud: --noise, --weeds and --outliers belong to --uniform; pictures have --match-noise");
  }
  const std::string extension = arguments.out.extension().string();
  if (extension != ".las" && extension != ".ply" && extension != ".xyz" && extension != ".txt") {
    throw ConfigError(
        fmt::format("--out: '{}' must end in .las, .ply, .xyz or .txt", arguments.out.string()));
  }
}

void make_folder_of(const std::filesystem::path& file) {
  if (file.parent_path().empty()) return;
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  if (error) {
    throw ConfigError(fmt::format("--out: folder '{}' cannot be made: {}",
                                  file.parent_path().string(), error.message()));
  }
}

worlds::PhotogrammetryOptions photogrammetry_of(const CloudArguments& arguments,
                                                std::uint64_t seed) {
  worlds::PhotogrammetryOptions options;
  options.density_per_m2 = arguments.density_per_m2;
  options.match_px = arguments.match_px;
  options.min_views = arguments.min_views;
  options.max_views = arguments.max_views;
  options.max_incidence_rad = rad_from_deg(arguments.max_incidence_deg);
  options.min_baseline_rad = rad_from_deg(arguments.min_baseline_deg);
  options.seed = seed;
  return options;
}

worlds::UniformCloudOptions uniform_of(const CloudArguments& arguments, std::uint64_t seed) {
  worlds::UniformCloudOptions options;
  options.density_per_m2 = *arguments.uniform_per_m2;
  options.noise_m = arguments.noise_m.value_or(0.0);
  options.weeds.height_m = arguments.weeds_m.value_or(0.0);
  options.outliers = arguments.outliers.value_or(0.0);
  options.seed = seed;
  return options;
}

void print_cloud(const worlds::WrittenCloud& written, double wall_s, const std::string& source) {
  const worlds::CloudTruth& truth = written.truth;
  const worlds::CloudTally& tally = written.tally;
  const worlds::CloudSampling& s = truth.sampling;
  const auto share = [&](std::int64_t part) {
    return 100.0 * static_cast<double>(part) /
           static_cast<double>(std::max<std::int64_t>(s.points, 1));
  };
  fmt::print("points         {} ({:.1f} % ground, {:.1f} % canopy) on {:.3f} ha\n", s.points,
             share(s.ground_points), share(s.canopy_points), 1e-4 * s.area_m2);
  fmt::print("density        {:.0f} per m2, {:.0f} wanted\n", s.density_per_m2,
             s.wanted_density_per_m2);
  if (s.pictures > 0) {
    fmt::print("pictures       {}, GSD {:.1f} mm ({})\n", s.pictures, 1e3 * s.gsd_m, source);
    fmt::print(
        "views          {:.2f} of a point in the mean; {} of {} pixels left out: {} seen too "
        "seldom, {} from too close together\n",
        s.views_mean, tally.unseen + tally.thin, tally.aims, tally.unseen, tally.thin);
  }
  fmt::print("noise          {:.1f} mm horizontally, {:.1f} mm in height (rms)\n",
             1e3 * s.horizontal_noise_rms_m, 1e3 * s.height_noise_rms_m);
  fmt::print("truth          {} rows, bearing {:.3f} deg, spacing {:.3f} m, canopy {:.2f} m3\n",
             truth.rows.size(), truth.bearing_deg, truth.spacing_m, truth.volume_m3);
  fmt::print("time           {:.1f} s\n", wall_s);
  fmt::print("file           {} ({:.1f} MB)\n", s.file, 1e-6 * static_cast<double>(written.bytes));
  fmt::print("truth file     {}\n", worlds::truth_file_of(s.file).string());
}

void make_cloud(const CloudArguments& arguments) {
  check_cloud_arguments(arguments);
  const auto start = std::chrono::steady_clock::now();
  const std::filesystem::path log = arguments.log.empty() ? "" : log_of(arguments.log);
  Registry registry;
  io::Scenario scenario;
  if (arguments.scenario.file.empty()) {
    registry = make_registry(arguments.scenario.plugins);
    scenario = scenario_of_log(log, registry);
    scenario.seed = arguments.scenario.overrides.seed.value_or(scenario.seed);
  } else {
    scenario = load(arguments.scenario, registry);
  }
  const bool uniform = arguments.uniform_per_m2.has_value();
  PictureSet pictures;
  if (!uniform) {
    pictures = log.empty() ? pictures_of_plan(scenario, arguments.scenario.file, registry,
                                              arguments.vehicle)
                           : pictures_of_log(log, registry, arguments.vehicle, arguments.sensor);
  }
  const std::unique_ptr<WorldModel> world = build_world(scenario, registry);
  physics::check_world(*world);
  const physics::WorldScene scene(*world);
  const worlds::SurveyArea area =
      worlds::make_survey_area(arguments.area, arguments.margin_m, *world, "--area");
  make_folder_of(arguments.out);
  const worlds::CloudTarget target = {arguments.out, arguments.file, arguments.out.string(),
                                      scenario.name};
  const Result<worlds::WrittenCloud> written =
      uniform ? worlds::write_uniform_cloud(scene, *world, area,
                                            uniform_of(arguments, scenario.seed), target)
              : worlds::write_photogrammetry(scene, *world, pictures, area,
                                             photogrammetry_of(arguments, scenario.seed), target);
  if (!written) throw ConfigError("cloud: " + written.reason());
  const double wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  print_cloud(*written, wall_s, pictures.source);
}

}  // namespace

void add_cloud_command(CLI::App& app, int& exit_status) {
  auto arguments = std::make_shared<CloudArguments>();
  CLI::App* command = app.add_subcommand(
      "cloud",
      "sample a scenario's world as a point cloud, as photogrammetry of a survey sees it, with the "
      "truth beside it");
  add_scenario_arguments(*command, arguments->scenario);
  command->get_option("scenario")
      ->required(false)
      ->description("scenario file (YAML); default: that of the log");
  command->add_option("--out", arguments->out, "cloud to write: .las, .ply, .xyz or .txt")
      ->required();
  command->add_option("--log", arguments->log,
                      "run with a flown survey (folder or log.mcap): its pictures are used; "
                      "default: those that the scenario's survey plans");
  command->add_option("--vehicle", arguments->vehicle, "that surveys, where several do");
  command->add_option("--sensor", arguments->sensor, "camera_trigger, where it has several");
  command->add_option("--area", arguments->area,
                      "instead of the world's parcel: x y of each corner in m, east and north of "
                      "the origin");
  command->add_option("--margin", arguments->margin_m, "around the area, m (default: 0)");
  command->add_option("--crs", arguments->file.crs,
                      "coordinates of the file, like EPSG:32632; default: m east, north, up of "
                      "the world's origin");
  command->add_flag("--truth-classes", arguments->file.truth_classes,
                    "give points their true classes, which no survey knows");
  const char* pictures = "Pictures";
  command
      ->add_option("--density", arguments->density_per_m2,
                   "points per m2 of ground (default: one per pixel)")
      ->group(pictures);
  command
      ->add_option("--match-noise", arguments->match_px,
                   "1 sigma of a match in each picture, pixels (default: 0.5)")
      ->group(pictures);
  command->add_option("--min-views", arguments->min_views, "that a point needs (default: 3)")
      ->group(pictures);
  command->add_option("--max-views", arguments->max_views, "that fix a point (default: 6)")
      ->group(pictures);
  command
      ->add_option("--max-incidence", arguments->max_incidence_deg,
                   "of a view off the surface's normal, degrees (default: 80)")
      ->group(pictures);
  command
      ->add_option("--min-baseline", arguments->min_baseline_deg,
                   "widest angle between a point's rays at least, degrees (default: 3)")
      ->group(pictures);
  const char* even = "Without pictures";
  command
      ->add_option("--uniform", arguments->uniform_per_m2,
                   "instead of pictures: points per m2 of all surfaces, hidden ones too")
      ->group(even);
  command->add_option("--noise", arguments->noise_m, "1 sigma of each coordinate, m (default: 0)")
      ->group(even);
  command
      ->add_option("--weeds", arguments->weeds_m,
                   "height of the tallest weeds between rows, m (default: 0)")
      ->group(even);
  command
      ->add_option("--outliers", arguments->outliers,
                   "share of points far from their surface (default: 0)")
      ->group(even);
  command->callback([arguments, &exit_status] {
    make_cloud(*arguments);
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
