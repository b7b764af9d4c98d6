#include <fmt/format.h>

#include <initializer_list>
#include <system_error>

#include "controllers/planning/survey/survey.h"
#include "controllers/planning/survey/survey_mission.h"
#include "controllers/planning/survey/survey_plan.h"
#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "engine/io/files/whole_folder.h"
#include "engine/io/missions/qgc_plan.h"
#include "engine/io/missions/qgc_wpl.h"
#include "engine/math/angles.h"
#include "engine/physics/check_world.h"
#include "engine/playback/run_frames.h"
#include "tools/photos/survey_photos.h"
#include "tools/pictures/survey_picture.h"
#include "tools/terminal/interrupt.h"
#include "tools/terminal/progress_line.h"
#include "tools/vinerow/cloud_poses.h"
#include "tools/vinerow/subcommands.h"
#include "tools/vinerow/survey_task.h"

namespace vinerow::tools {
namespace {

void write_waypoints(const controllers::SurveyPlan& plan, const SurveyTask& task,
                     const std::filesystem::path& file) {
  const char* const kKinds[] = {"lane", "turn", "transit", "vertical", "return"};
  const LocalFrame frame(task.origin);
  std::string out;
  out += "waypoint,kind,lane,x_m,y_m,z_m,above_ground_m,latitude_deg,longitude_deg\n";
  int number = 0;
  for (const PathPoint& point : plan.path.points) {
    const Eigen::Vector3d& p = point.p_W;
    const Geodetic place = frame.to_geodetic(p);
    const auto ground_m = task.ground(p.head<2>());
    out += fmt::format("{},{},{},{:.3f},{:.3f},{:.3f},{},{:.9f},{:.9f}\n", number++,
                       kKinds[static_cast<int>(point.kind)],
                       point.alley >= 0 ? std::to_string(point.alley) : "", p.x(), p.y(), p.z(),
                       ground_m ? fmt::format("{:.3f}", p.z() - *ground_m) : "",
                       deg_from_rad(place.latitude_rad), deg_from_rad(place.longitude_rad));
  }
  write_whole_file(file, out);
}

void print_survey(const SurveyTask& task, const controllers::SurveyPlan& plan) {
  const auto n = [&](const char* name) { return plan.numbers.at(name); };
  const SurveyCamera& camera = task.request.camera;
  fmt::print(
      "area             {:.2f} ha, {:.2f} % covered, every point on at least {:.0f} pictures "
      "({:.1f} on average)\n",
      n("area_ha"), 100.0 * n("covered_share"), n("views_min"), n("views_mean"));
  fmt::print("camera           {} ({:g} mm, {} x {}), footprint {:.1f} x {:.1f} m\n", camera.name,
             camera.focal_length_mm, camera.columns, camera.rows, n("footprint_width_m"),
             n("footprint_length_m"));
  fmt::print("height           {:.1f} m above the ground ({:.1f} to {:.1f} m on lanes)\n",
             n("height_m"), n("height_above_ground_min_m"), n("height_above_ground_max_m"));
  fmt::print(
      "GSD              {:.1f} mm at {:.1f} m; {:.1f} to {:.1f} mm at the lowest and highest "
      "points of the lanes\n",
      n("gsd_mm"), n("height_m"), n("gsd_min_mm"), n("gsd_max_mm"));
  fmt::print(
      "overlap          {:.1f} % forward, {:.1f} % side ({:.1f} %, {:.1f} % where the flight is "
      "lowest)\n",
      100.0 * n("forward_overlap"), 100.0 * n("side_overlap"), 100.0 * n("forward_overlap_min"),
      100.0 * n("side_overlap_min"));
  fmt::print(
      "pictures         {:.0f}, one every {:.2f} m: every {:.2f} s at {:.1f} m/s over ground\n",
      n("shots"), n("photo_distance_m"), n("photo_interval_s"), n("ground_speed_max_mps"));
  fmt::print("lanes            {:.0f}, {:.1f} m apart, bearing {:.1f} deg\n", n("lanes"),
             n("lane_spacing_m"), n("lane_bearing_deg"));
  std::string order;
  for (const int lane : plan.order) {
    order += fmt::format("{}{}", order.empty() ? "" : ", ", lane);
  }
  fmt::print("order            lanes {} (numbers as in waypoints.csv)\n", order);
  if (plan.rotorcraft) {
    fmt::print("turns            on the spot; {:.1f} m beyond the last picture to slow down\n",
               n("run_out_m"));
  } else {
    fmt::print("turns            {:.1f} m radius; {:.0f} pass over lanes, {:.0f} swing wide\n",
               n("turn_radius_m"), n("skipping_turns"), n("wide_turns"));
  }
  fmt::print("waypoints        {:.0f}: lane corners {:.0f}, for the terrain {:.0f}\n",
             n("waypoints"), n("corners"), n("ramp_points"));
  fmt::print("ramps            at most {:.2f} m off the requested height, slope up to {:.1f} %\n",
             n("ramp_error_m"), 100.0 * n("slope_max"));
  if (plan.rotorcraft) {
    fmt::print("climb            straight up above the start\n");
  } else {
    fmt::print("climb            {:.0f} m of flight to the first height\n", n("climb_way_m"));
  }
  fmt::print("flight           {:.0f} m, {:.0f} s; lanes {:.0f} m, turns {:.0f} m\n", n("length_m"),
             n("flight_time_s"), n("lane_way_m"), n("turn_way_m"));
  if (n("steep_terrain_extra_m") > task.request.ramp_error_m) {
    fmt::print(
        "note: up to {:.1f} m higher than requested where the terrain is steeper than {:.0f} %; {} "
        "keeps the height\n",
        n("steep_terrain_extra_m"), 100.0 * task.request.max_slope,
        plan.rotorcraft ? "a slower flight, or a larger --max_slope," : "a larger --max_slope");
  }
  if (n("samples_beyond_terrain") > 0.0) {
    fmt::print("note: turns leave the terrain; they use its height at the edge\n");
  }
}

controllers::SurveyPlan plan_and_write(const SurveyTask& task, const std::filesystem::path& out) {
  const auto plan = controllers::plan_survey(task.request, task.start_W, task.ground);
  if (!plan) throw ConfigError("survey: " + plan.reason());
  io::make_folder(out);
  const double home_m = task.ground(task.start_W.p.head<2>()).value_or(task.start_W.p.z());
  const io::MissionFile mission =
      controllers::make_survey_mission(*plan, task.origin, home_m, task.request.returns);
  io::write_qgc_plan(mission, out / "survey.plan");
  io::write_qgc_wpl(mission, out / "survey.waypoints");
  write_waypoints(*plan, task, out / "waypoints.csv");
  render::write_png((out / "survey.png").string(),
                    draw_survey(task.request, *plan, task.ground, task.title));
  print_survey(task, *plan);
  fmt::print("missions         {}, {}\nwaypoints        {}\npicture          {}\n",
             (out / "survey.plan").string(), (out / "survey.waypoints").string(),
             (out / "waypoints.csv").string(), (out / "survey.png").string());
  return *plan;
}

SurveyPhotoOptions photo_options(const SurveyArguments& arguments,
                                 const scenario::Scenario& scenario) {
  return {arguments.picture_width, scenario.seed, arguments.bands};
}

/// @returns exit status
int take_pictures(const SurveyArguments& arguments, const PictureSet& pictures,
                  const scenario::Scenario& scenario, const Registry& registry,
                  const std::filesystem::path& out) {
  const SurveyPhotoOptions options = photo_options(arguments, scenario);
  const SurveyCamera camera = photo_camera(pictures.camera, options);
  const std::unique_ptr<WorldModel> world = build_world(scenario, registry);
  physics::check_world(*world);
  ProgressLine line(false);
  watch_for_interrupt();
  const auto count = static_cast<int>(pictures.X_WS.size());
  const bool is_complete = write_survey_photos(pictures, *world, options, out, [&](int done) {
    line.count("drawing pictures", done, count);
    return !is_interrupted();
  });
  line.end();
  if (!is_complete) {
    fmt::print(stderr, "vinerow: interrupted: no pictures are kept\n");
    return static_cast<int>(run::RunStatus::kBrokenOff);
  }
  fmt::print("pictures         {}: {} of {} x {} pixels{}, with Exif positions ({})\n",
             out.string(), count, camera.columns, camera.rows,
             options.bands.empty() ? "" : fmt::format(" in {} bands", options.bands.size()),
             pictures.estimated_W.empty() ? "true" : "as the vehicle estimated them");
  return 0;
}

/// Pictures of a survey that was flown. @returns exit status
int take_flown_pictures(const SurveyArguments& arguments) {
  const std::filesystem::path log = log_of(arguments.log);
  const Registry registry = registry_of_run(log, arguments.scenario.plugins);
  const scenario::Scenario scenario =
      playback::scenario_of_log(log, registry, arguments.scenario.overrides);
  const PictureSet pictures = pictures_of_log(log, registry, arguments.vehicle, arguments.sensor);
  const std::filesystem::path out =
      arguments.out.empty() ? std::filesystem::path("surveys") / scenario.name : arguments.out;
  return take_pictures(arguments, pictures, scenario, registry, out / "pictures");
}

std::filesystem::path out_of(const SurveyArguments& arguments, const SurveyTask& task) {
  return arguments.out.empty() ? std::filesystem::path("surveys") / task.title : arguments.out;
}

/// Refuses options that would change nothing.
void refuse_idle_options(const CLI::App& command, const SurveyArguments& arguments) {
  const auto refuse = [&](std::initializer_list<const char*> names, const char* needed) {
    for (const char* name : names) {
      if (command.count(name) == 0) continue;
      throw ConfigError(fmt::format("survey: {} has no effect without {}", name, needed));
    }
  };
  if (!arguments.pictures) refuse({"--picture-width", "--bands"}, "--pictures");
  if (arguments.log.empty()) refuse({"--sensor"}, "--log");
  if (arguments.polygon.empty()) {
    refuse({"--origin", "--dem", "--crs", "--start", "--heading"}, "--polygon");
  } else {
    refuse({"--set", "--seed", "--plugin", "--vehicle"}, "a scenario");
  }
  if (arguments.dem.empty()) refuse({"--crs"}, "--dem");
  if (arguments.log.empty()) return;
  for (const auto& [name, text] : arguments.values) {
    if (text.empty()) continue;
    throw ConfigError(
        fmt::format("survey: --{} has no effect with --log: nothing is planned", name));
  }
}

}  // namespace

void add_survey_command(CLI::App& app, int& exit_status) {
  auto arguments = std::make_shared<SurveyArguments>();
  CLI::App* command = app.add_subcommand(
      "survey",
      "plan an aerial survey of a scenario or a polygon; write missions, waypoints, a plan view, "
      "and the pictures that it takes");
  add_scenario_arguments(*command, arguments->scenario, "plane.planner.height_m=60");
  command->get_option("scenario")->required(false);
  command->add_option("--vehicle", arguments->vehicle,
                      "vehicle of the scenario (default: the first with the planner 'survey')");
  command->add_option("--polygon", arguments->polygon,
                      "area without a scenario: GeoJSON, or CSV with x,y in metres");
  command
      ->add_option("--origin", arguments->origin,
                   "latitude,longitude[,altitude] of x = y = 0 (default: the polygon's first "
                   "corner)")
      ->delimiter(',');
  command->add_option("--dem", arguments->dem, "elevation model (GeoTIFF) (default: flat ground)");
  command->add_option("--crs", arguments->crs,
                      "coordinate system of the elevation model, e.g. EPSG:32632");
  command
      ->add_option("--start", arguments->start,
                   "x,y of the start (default: the polygon's first corner)")
      ->delimiter(',');
  command->add_option("--heading", arguments->heading_deg,
                      "bearing at the start, degrees clockwise from north");
  command->add_option("--out", arguments->out,
                      "folder for survey.plan, survey.waypoints, waypoints.csv and survey.png "
                      "(default: surveys/<name>)");
  for (const ParameterSpec& spec : controllers::survey_spec().parameters) {
    if (spec.kind == ParameterKind::kNumberList || spec.kind == ParameterKind::kPath) continue;
    if (spec.name == "rotorcraft") {
      command->add_flag("--rotorcraft{true}", arguments->values[spec.name], spec.description)
          ->group("Survey");
      continue;
    }
    command->add_option("--" + spec.name, arguments->values[spec.name], spec.description)
        ->group("Survey");
  }
  const char* photographs = "Photographs";
  command
      ->add_flag("--pictures", arguments->pictures,
                 "also draw the pictures of the survey, with Exif positions, for photogrammetry")
      ->group(photographs);
  command
      ->add_option("--log", arguments->log,
                   "with --pictures: run with a flown survey (folder or log.mcap); nothing is "
                   "planned (default: pictures as planned)")
      ->group(photographs);
  command->add_option("--sensor", arguments->sensor, "its camera_trigger, if it has several")
      ->group(photographs);
  command
      ->add_option("--picture-width", arguments->picture_width,
                   "columns of the pictures (default: the camera's)")
      ->group(photographs);
  command
      ->add_option("--bands", arguments->bands,
                   "16-bit TIFF files of these bands instead of colours: blue,green,red,red_edge,"
                   "nir")
      ->delimiter(',')
      ->check(CLI::IsMember(photo_bands()))
      ->group(photographs);
  command->callback([arguments, command, &exit_status] {
    const bool has_scenario = !arguments->scenario.file.empty();
    if (!arguments->log.empty() &&
        (!arguments->pictures || has_scenario || !arguments->polygon.empty())) {
      throw ConfigError("survey: --log needs --pictures, and neither a scenario nor --polygon");
    }
    if (arguments->log.empty() && has_scenario == !arguments->polygon.empty()) {
      throw ConfigError("survey: give either a scenario or --polygon");
    }
    refuse_idle_options(*command, *arguments);
    if (!arguments->log.empty()) {
      exit_status = take_flown_pictures(*arguments);
      return;
    }
    if (arguments->pictures && !has_scenario) {
      throw ConfigError("survey: --pictures needs the world of a scenario, or --log");
    }
    if (has_scenario) {
      Registry registry;
      const scenario::Scenario scenario = load(arguments->scenario, registry);
      Simulation simulation(scenario, registry);
      const SurveyTask task = task_of_scenario(*arguments, scenario, simulation);
      const std::filesystem::path out = out_of(*arguments, task);
      if (arguments->pictures) {
        // Before anything is written.
        photo_camera(task.request.camera, photo_options(*arguments, scenario));
        io::check_new_folder(out / "pictures");
      }
      const controllers::SurveyPlan plan = plan_and_write(task, out);
      if (arguments->pictures) {
        const PictureSet pictures =
            pictures_of_plan(plan, task.request.camera, arguments->scenario.file);
        exit_status = take_pictures(*arguments, pictures, scenario, registry, out / "pictures");
        return;
      }
    } else {
      const SurveyTask task = task_of_polygon(*arguments);
      plan_and_write(task, out_of(*arguments, task));
    }
    exit_status = 0;
  });
}

}  // namespace vinerow::tools
