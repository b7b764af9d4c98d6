#include "engine/playback/run_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/core/whole_file.h"
#include "engine/playback/frame_composer.h"
#include "engine/playback/frame_words.h"
#include "engine/playback/log_trace.h"
#include "engine/playback/phase_moments.h"
#include "engine/render/scene.h"
#include "engine/sim/run_shelf.h"
#include "engine/sim/simulation.h"

namespace vinerow::playback {
namespace {

std::vector<scenario::CameraConfig> chosen_cameras(const scenario::Scenario& scenario,
                                                   const std::vector<std::string>& wanted) {
  if (wanted.empty()) return scenario.pictures.cameras;
  std::vector<scenario::CameraConfig> chosen;
  for (const std::string& name : wanted) chosen.push_back(find_camera(scenario, name));
  return chosen;
}

/// Optional contents of the log that the cameras show.
TraceWishes wishes_of(const std::vector<scenario::CameraConfig>& cameras) {
  TraceWishes wishes;
  for (const scenario::CameraConfig& camera : cameras) {
    wishes.scans |= camera.show_sensor_rays;
    wishes.estimates |= camera.show_estimate;
    wishes.map_edges |= camera.show_map;
  }
  return wishes;
}

/// Period of frames below which they count as a film.
constexpr double kFilmPeriod_s = 2.0;

bool has_chase(const std::vector<scenario::CameraConfig>& cameras) {
  return std::any_of(cameras.begin(), cameras.end(), [](const scenario::CameraConfig& camera) {
    return camera.kind == scenario::CameraKind::kChase;
  });
}

/// True if an instant is in the requested span.
bool is_wanted(Time t, const PictureOptions& options) {
  return t >= Time{duration_from_s(options.from_s.value_or(0.0)).ns} &&
         (!options.to_s || t <= Time{duration_from_s(*options.to_s).ns});
}

/// @throws ConfigError if the requested span and the log do not overlap
void check_span(const PictureOptions& options, const LogTrace& trace) {
  const double from_s = options.from_s.value_or(trace.first.s());
  const double to_s = options.to_s.value_or(trace.last.s());
  if (from_s > to_s || from_s > trace.last.s() || to_s < trace.first.s()) {
    throw ConfigError(fmt::format(
        "there is no frame from {:g} s{}: the log covers {:g} s to {:g} s", from_s,
        options.to_s ? fmt::format(" to {:g} s", to_s) : " on", trace.first.s(), trace.last.s()));
  }
}

/// Instants of the frames of all cameras, in order, each once; without instants after the log's
/// end.
std::set<Time> frame_times(const scenario::PicturesConfig& pictures, const PictureOptions& options,
                           const LogTrace& trace) {
  std::set<Time> times;
  const auto add = [&](double t_s) {
    const Time t{duration_from_s(t_s).ns};
    if (t >= trace.first && t <= trace.last && is_wanted(t, options)) times.insert(t);
  };
  const bool own_schedule = options.times_s || options.every_s;
  for (const double t_s : options.times_s.value_or(std::vector<double>{})) {
    if (t_s >= trace.first.s() && t_s <= trace.last.s()) continue;
    throw ConfigError(
        fmt::format("there is no frame at {:.9g} s: the log covers {:.9g} s to {:.9g} s", t_s,
                    trace.first.s(), trace.last.s()));
  }
  for (const double t_s :
       own_schedule ? options.times_s.value_or(std::vector<double>{}) : pictures.times_s)
    add(t_s);
  const double every_s = own_schedule ? options.every_s.value_or(0.0) : pictures.every_s;
  if (every_s > 0.0) {
    const double first_s = options.from_s.value_or(0.0);
    const double span_s = std::min(trace.last.s(), options.to_s.value_or(trace.last.s())) - first_s;
    if (span_s / every_s > scenario::kMaxPictureInstants) {
      throw ConfigError(
          fmt::format("a frame every {:.9g} s is {:.0f} instants of {:.9g} s, must be at most "
                      "{:.0f}",
                      every_s, span_s / every_s, span_s, scenario::kMaxPictureInstants));
    }
    const auto count = static_cast<std::int64_t>(std::floor(span_s / every_s + 1e-9));
    for (std::int64_t k = 0; k <= count; ++k) add(first_s + static_cast<double>(k) * every_s);
  }
  if (!own_schedule) {
    for (const double share : pictures.shares) {
      const Time t =
          trace.first +
          Duration{std::llround(share * static_cast<double>((trace.last - trace.first).ns))};
      if (is_wanted(t, options)) times.insert(t);
    }
  }
  return times;
}

/// Instants of one camera's frames. For a camera of kind shots these are the times of its pictures
/// or, if the caller gave a schedule, the scheduled instants from the first picture on.
std::set<Time> times_of(const scenario::CameraConfig& camera, const std::set<Time>& schedule,
                        bool own_schedule, const LogTrace& trace) {
  if (camera.kind != scenario::CameraKind::kShots) return schedule;
  const auto& shots = trace.vehicles.at(camera.vehicle).shots;
  const auto found = shots.find(camera.sensor);
  if (found == shots.end() || !view_of(found->second)) return {};
  std::set<Time> times;
  if (own_schedule) {
    times = {schedule.lower_bound(found->second.times.front()), schedule.end()};
    return times;
  }
  for (std::size_t i = 0; i < found->second.values.size(); ++i) {
    if (found->second.values[i].index % camera.every == 0) times.insert(found->second.times[i]);
  }
  return times;
}

/// Whether two frames of a camera fall into one millisecond.
bool is_finer_than_a_millisecond(const std::set<Time>& times) {
  return std::adjacent_find(times.begin(), times.end(), [](Time a, Time b) {
           return a.ns / 1'000'000 == b.ns / 1'000'000;
         }) != times.end();
}

/// "chase_000004000": camera and time in ms; "chase_000004000.250000" with ns, if a camera's frames
/// are closer than a millisecond.
std::string frame_name(const std::string& camera, Time t, bool is_fine) {
  const std::int64_t ms = t.ns / 1'000'000;
  if (!is_fine) return fmt::format("{}_{:09d}", camera, ms);
  return fmt::format("{}_{:09d}.{:06d}", camera, ms, t.ns % 1'000'000);
}

scenario::Scenario scenario_in(const record::LogReader& reader, const std::filesystem::path& log,
                               const Registry& registry,
                               const scenario::Overrides& overrides = {}) {
  const auto found = reader.info().attachments.find("scenario.resolved.yaml");
  if (found == reader.info().attachments.end()) {
    throw ConfigError(fmt::format(
        "{}: contains no scenario.resolved.yaml, so its world is not known", log.string()));
  }
  return scenario::parse_scenario(found->second, log.parent_path(), registry, overrides,
                                  fmt::format("{}: {}", log.string(), found->first));
}

}  // namespace

scenario::CameraConfig find_camera(const scenario::Scenario& scenario, const std::string& name) {
  std::vector<std::string> known;
  for (const scenario::CameraConfig& camera : scenario.pictures.cameras) {
    if (camera.name == name) return camera;
    known.push_back(camera.name);
  }
  if (name == "chase" && !scenario.vehicles.empty()) {
    scenario::CameraConfig chase;
    chase.name = name;
    chase.vehicle = scenario.vehicles.front().name;
    return chase;
  }
  throw ConfigError(fmt::format("no camera '{}' in scenario '{}'{} (known: {})", name,
                                scenario.name, did_you_mean(name, known),
                                known.empty() ? "none" : join(known)));
}

scenario::Scenario scenario_of_log(const std::filesystem::path& log, const Registry& registry,
                                   const scenario::Overrides& overrides) {
  return scenario_in(record::LogReader(log), log, registry, overrides);
}

std::vector<std::unique_ptr<Vehicle>> vehicles_of_scenario(const scenario::Scenario& scenario,
                                                           const Registry& registry) {
  std::vector<std::unique_ptr<Vehicle>> vehicles;
  for (const scenario::VehicleConfig& config : scenario.vehicles) {
    VehicleContext context;
    context.vehicle = context.part = config.name;
    context.seed = scenario.seed;
    context.physics_step = scenario.physics_step;
    context.gravity_mps2 = scenario.gravity_mps2;
    vehicles.push_back(
        registry.make_vehicle(config.vehicle.type, config.vehicle.parameters, context));
  }
  return vehicles;
}

PictureReport render_log(const std::filesystem::path& log, const std::filesystem::path& out,
                         const Registry& registry, const PictureOptions& options) {
  const record::LogReader reader(log);
  scenario::Scenario scenario = scenario_in(reader, log, registry, options.overrides);
  scenario.pictures.width = options.width.value_or(scenario.pictures.width);
  scenario.pictures.height = options.height.value_or(scenario.pictures.height);
  const std::vector<scenario::CameraConfig> cameras = chosen_cameras(scenario, options.cameras);

  const std::shared_ptr<const WorldModel> world = world_of(scenario, registry, options.shelf.get());
  PictureReport report;
  auto renderer = render::make_renderer(*world);
  if (!renderer) {
    report.note = renderer.reason();
    return report;
  }
  const std::vector<std::unique_ptr<Vehicle>> vehicles = vehicles_of_scenario(scenario, registry);
  std::vector<std::string> names;
  for (const scenario::VehicleConfig& vehicle : scenario.vehicles) names.push_back(vehicle.name);
  const LogTrace trace = read_trace(reader, names, wishes_of(cameras));
  check_span(options, trace);
  const bool own_schedule = options.times_s || options.every_s;
  const std::set<Time> schedule = frame_times(scenario.pictures, options, trace);
  const std::map<std::string, PhaseSpan> spans = read_phase_spans(reader);
  const double every_s = own_schedule ? options.every_s.value_or(0.0) : scenario.pictures.every_s;
  const FrameComposer composer(
      scenario, *world, vehicles, trace,
      {spans, has_chase(cameras) && !(every_s > 0.0 && every_s < kFilmPeriod_s)});
  std::vector<std::set<Time>> times_by_camera;
  std::set<Time> times;
  int total = 0;
  for (const scenario::CameraConfig& camera : cameras) {
    std::set<Time>& own =
        times_by_camera.emplace_back(times_of(camera, schedule, own_schedule, trace));
    if (!own_schedule && camera.kind != scenario::CameraKind::kShots) {
      for (const Time t : moment_times(scenario, camera, spans)) {
        if (t <= trace.last) own.insert(t);
      }
    }
    std::erase_if(own, [&](Time t) { return !is_wanted(t, options); });
    times.insert(own.begin(), own.end());
    total += static_cast<int>(own.size());
  }
  if (total == 0 && !cameras.empty()) report.note = "no frame is due within the run";

  const auto start = std::chrono::steady_clock::now();
  if (options.progress) options.progress(0, total);
  int finished_frames = 0;
  const auto draw = [&](const scenario::CameraConfig& camera, Time t, bool is_fine) {
    const render::Frame frame = composer.compose(camera, t);
    const render::Image image = (*renderer)->draw(frame);
    if (options.take_frame) {
      options.take_frame(image);
      if (options.progress) options.progress(++finished_frames, total);
      return;
    }
    const std::vector<double> shares = (*renderer)->statistics().vehicle_shares;
    std::map<std::string, double> seen;
    for (std::size_t i = 0; i < std::min(shares.size(), frame.vehicles.size()); ++i) {
      seen[frame.vehicles[i].name] = shares[i];
    }
    const auto file = out / (frame_name(camera.name, t, is_fine) + ".png");
    std::map<std::string, std::string> words;
    if (!seen.empty()) words[kSeenKey] = seen_text(seen);
    render::write_png(file.string(), image, words);
    report.files.push_back(file);
    report.digests.push_back(render::image_digest(image));
    if (options.progress) options.progress(static_cast<int>(report.files.size()), total);
  };
  try {
    std::error_code failed;
    if (!options.take_frame) std::filesystem::create_directories(out, failed);
    if (failed) throw_cannot_write(fmt::format("folder '{}'", out.string()), failed.value());
    for (const Time t : times) {
      for (std::size_t c = 0; c < cameras.size() && report.note.empty(); ++c) {
        if (!times_by_camera[c].contains(t)) continue;
        if (options.interrupted && options.interrupted()) {
          report.note = fmt::format("interrupted after {} of {}", report.files.size(), total);
        } else {
          draw(cameras[c], t, is_finer_than_a_millisecond(times_by_camera[c]));
        }
      }
    }
  } catch (const WriteError& error) {
    report.write_failure = error.what();
    report.note = fmt::format("{} of {}: {}", report.files.size(), total, error.what());
  }
  report.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace vinerow::playback
