#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <system_error>

#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/io/files/output_folder.h"
#include "engine/physics/check_world.h"
#include "engine/physics/world_scene.h"
#include "engine/playback/run_frames.h"
#include "engine/sim/simulation.h"
#include "tools/vinerow/cloud_poses.h"
#include "tools/vinerow/subcommands.h"
#include "tools/vinerow/table_flags.h"
#include "worlds/mapping/jobs/photogrammetry_job_params.h"
#include "worlds/mapping/photogrammetry/write_cloud.h"

namespace vinerow::tools {
namespace {

struct CloudArguments {
  ScenarioArguments scenario;
  std::filesystem::path out, log;
  std::string vehicle, sensor;
  std::shared_ptr<const ParameterSet> method;  ///< rows of photogrammetry_job_table()
  std::optional<double> uniform_per_m2, noise_m, weeds_m, outliers;
};

void check_cloud_arguments(const CloudArguments& arguments,
                           const mapping::PhotogrammetryJobParams& params) {
  const bool uniform = arguments.uniform_per_m2.has_value();
  if (arguments.scenario.file.empty() && arguments.log.empty()) {
    throw ConfigError("cloud: give a scenario, or a flown survey with --log");
  }
  if (uniform && (!arguments.log.empty() || params.options.density_per_m2 ||
                  !params.options.missing_rows.empty())) {
    throw ConfigError(
        "cloud: --uniform uses no pictures, so --log, --density and --missing-rows are not "
        "allowed");
  }
  if (!uniform && (arguments.noise_m || arguments.weeds_m || arguments.outliers)) {
    throw ConfigError(
        "cloud: --noise, --weeds and --outliers need --uniform; for pictures use --match-noise");
  }
  const std::string extension = arguments.out.extension().string();
  if (extension != ".las" && extension != ".ply" && extension != ".xyz" && extension != ".txt") {
    throw ConfigError(
        fmt::format("--out: '{}' must end in .las, .ply, .xyz or .txt", arguments.out.string()));
  }
}

mapping::UniformCloudOptions uniform_of(const CloudArguments& arguments, std::uint64_t seed) {
  mapping::UniformCloudOptions options;
  options.density_per_m2 = *arguments.uniform_per_m2;
  options.noise_m = arguments.noise_m.value_or(0.0);
  options.weeds.height_m = arguments.weeds_m.value_or(0.0);
  options.outliers = arguments.outliers.value_or(0.0);
  options.seed = seed;
  return options;
}

void print_cloud(const mapping::WrittenCloud& written, double wall_s, const std::string& source) {
  const mapping::CloudTruth& truth = written.truth;
  const mapping::CloudTally& tally = written.tally;
  const mapping::CloudSampling& s = truth.sampling;
  const auto share = [&](std::int64_t part) {
    return 100.0 * static_cast<double>(part) /
           static_cast<double>(std::max<std::int64_t>(s.points, 1));
  };
  fmt::print("points         {} ({:.1f} % ground, {:.1f} % canopy) on {:.3f} ha\n", s.points,
             share(s.ground_points), share(s.canopy_points), 1e-4 * s.area_m2);
  fmt::print("density        {:.0f} per m2, {:.0f} requested\n", s.density_per_m2,
             s.wanted_density_per_m2);
  if (s.pictures > 0) {
    fmt::print("pictures       {}, GSD {:.1f} mm ({})\n", s.pictures, 1e3 * s.gsd_m, source);
    fmt::print(
        "views          {:.2f} per point on average; {} of {} pixels rejected: {} with too few "
        "views, {} with too short a baseline\n",
        s.views_mean, tally.unseen + tally.thin, tally.aims, tally.unseen, tally.thin);
  }
  fmt::print("noise          {:.1f} mm horizontally, {:.1f} mm in height (rms)\n",
             1e3 * s.horizontal_noise_rms_m, 1e3 * s.height_noise_rms_m);
  if (s.georeference != "none") {
    fmt::print(
        "georeference   {}: shifted by {:.1f} mm east, {:.1f} mm north, {:.1f} mm up in the "
        "middle, "
        "turned by {:.4f} deg, tilted by {:.4f} deg\n",
        s.georeference, 1e3 * s.georeference_east_m, 1e3 * s.georeference_north_m,
        1e3 * s.georeference_up_m, s.georeference_turn_deg, s.georeference_tilt_deg);
  }
  fmt::print("truth          {} rows, bearing {:.3f} deg, spacing {:.3f} m, canopy {:.2f} m3\n",
             truth.rows.size(), truth.bearing_deg, truth.spacing_m, truth.volume_m3);
  fmt::print("time           {:.1f} s\n", wall_s);
  fmt::print("file           {} ({:.1f} MB)\n", s.file, 1e-6 * static_cast<double>(written.bytes));
  fmt::print("truth file     {}\n", mapping::truth_file_of(s.file).string());
}

void make_cloud(const CloudArguments& arguments) {
  mapping::PhotogrammetryJobParams params =
      mapping::photogrammetry_job_table().read(*arguments.method, "cloud");
  mapping::check_options(params.options);
  check_cloud_arguments(arguments, params);
  const auto start = std::chrono::steady_clock::now();
  const std::filesystem::path log = arguments.log.empty() ? "" : log_of(arguments.log);
  Registry registry;
  scenario::Scenario scenario;
  if (arguments.scenario.file.empty()) {
    registry = registry_of_run(log, arguments.scenario.plugins);
    scenario = playback::scenario_of_log(log, registry, arguments.scenario.overrides);
  } else {
    scenario = load(arguments.scenario, registry);
  }
  params.options.seed = scenario.seed;
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
  const mapping::SurveyArea area =
      mapping::make_survey_area(params.area_m, params.margin_m, *world, "--area");
  io::make_folder_of(arguments.out);
  const mapping::CloudTarget target = {arguments.out, params.file, arguments.out.string(),
                                       scenario.name};
  const Result<mapping::WrittenCloud> written =
      uniform
          ? mapping::write_uniform_cloud(scene, *world, area, uniform_of(arguments, scenario.seed),
                                         target)
          : mapping::write_photogrammetry(scene, *world, pictures, area, params.options, target);
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
      "sample a scenario's world as the point cloud that photogrammetry of a survey yields; also "
      "write the truth");
  add_scenario_arguments(*command, arguments->scenario, "world.canopy_top_m=1.7");
  command->get_option("scenario")
      ->required(false)
      ->description("scenario file (YAML); default: the log's scenario");
  command->add_option("--out", arguments->out, "point cloud to write: .las, .ply, .xyz or .txt")
      ->required();
  command->add_option("--log", arguments->log,
                      "run with a flown survey (folder or log.mcap) whose pictures are used "
                      "(default: the pictures planned by the scenario's survey)");
  command->add_option("--vehicle", arguments->vehicle, "surveying vehicle, if there are several");
  command->add_option("--sensor", arguments->sensor, "camera_trigger, if the vehicle has several");
  arguments->method = add_table_flags(*command, mapping::photogrammetry_job_table().specs(),
                                      {.without = {},
                                       .names = {},
                                       .group = "Pictures",
                                       .general = {"area_m", "margin_m", "crs", "truth_classes"}});
  const char* even = "Without pictures";
  command
      ->add_option("--uniform", arguments->uniform_per_m2,
                   "instead of pictures: points per m2 of all surfaces, including hidden ones")
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
