#include "engine/playback/session_pictures.h"

#include <fmt/format.h>

#include <optional>

#include "engine/core/error.h"
#include "engine/playback/frame_composer.h"
#include "engine/playback/run_frames.h"
#include "engine/sim/simulation.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow::playback {
namespace {

template <class T>
void append(Trace<T>& trace, Time t, const T& value) {
  if (!trace.empty() && trace.times.back() >= t) return;
  trace.times.push_back(t);
  trace.values.push_back(value);
}

scenario::Scenario with_size(scenario::Scenario scenario, const PictureChoice& choice) {
  scenario.pictures.width = choice.width;
  scenario.pictures.height = choice.height;
  return scenario;
}

scenario::CameraConfig live_camera(const scenario::Scenario& scenario, const std::string& name) {
  const auto& own = scenario.pictures.cameras;
  scenario::CameraConfig camera =
      find_camera(scenario, name.empty() && !own.empty() ? own.front().name
                            : name.empty()               ? "chase"
                                                         : name);
  if (camera.kind == scenario::CameraKind::kShots) {
    throw ConfigError(fmt::format(
        "camera '{}' shows the pictures of a sensor: they are drawn from a log only", camera.name));
  }
  camera.show_sensor_rays |= name.empty();
  return camera;
}

}  // namespace

/// What changes with each run of the session.
struct SessionPictures::Run {
  Run(const Session& session, const Registry& registry, const PictureChoice& choice)
      : scenario(with_size(session.scenario(), choice)),
        camera(live_camera(scenario, choice.camera)),
        vehicles(vehicles_of_scenario(scenario, registry)) {
    for (const SignalInfo& signal : session.signals()) {
      const std::size_t slash = signal.name.find('/');
      if (signal.type != RangeSample::kType || signal.name.ends_with("_truth")) continue;
      ranges.push_back({signal.name.substr(0, slash), signal.name.substr(slash + 1),
                        static_cast<const Signal<RangeSample>*>(&session.any_signal(signal.name))});
    }
    // The composer takes the extent of the picture from the world and the first poses.
    note(session);
    composer.emplace(scenario, session.simulation().world(), vehicles, trace);
  }

  void note(const Session& session) {
    const Time now = session.now();
    for (const auto& runtime : session.simulation().vehicles()) {
      const Vehicle& vehicle = runtime->vehicle();
      VehicleTrace& own = trace.vehicles[runtime->name()];
      Odometry truth;
      vehicle.read_truth(truth);
      append(own.truth, now, truth);
      LinkPoses links;
      links.X_WL.resize(vehicle.links().size());
      vehicle.read_links(links.X_WL);
      append(own.links, now, links);
    }
    for (const Range& range : ranges) {
      const SignalReader<RangeSample> reader(range.signal);
      if (reader.sequence() == 0) continue;
      append(trace.vehicles[range.vehicle].ranges[range.sensor], reader.stamp(), reader.value());
    }
    trace.last = now;
  }

  struct Range {
    std::string vehicle, sensor;
    const Signal<RangeSample>* signal;
  };
  scenario::Scenario scenario;
  scenario::CameraConfig camera;
  std::vector<std::unique_ptr<Vehicle>> vehicles;
  std::vector<Range> ranges;
  LogTrace trace;
  std::optional<FrameComposer> composer;
};

SessionPictures::SessionPictures(std::shared_ptr<const Registry> registry, PictureChoice choice)
    : registry_(std::move(registry)), choice_(std::move(choice)) {}
SessionPictures::~SessionPictures() = default;
SessionPictures::SessionPictures(SessionPictures&&) noexcept = default;
SessionPictures& SessionPictures::operator=(SessionPictures&&) noexcept = default;

void SessionPictures::begin(const Session& session) {
  const std::shared_ptr<const WorldModel>& world = session.simulation().built_world().model;
  if (world != world_) {
    run_.reset();
    renderer_.reset();
    auto renderer = render::make_renderer(*world);
    if (!renderer) throw ConfigError("no picture: " + std::string(renderer.reason()));
    renderer_ = std::move(renderer).value();
    world_ = world;
  }
  run_ = std::make_unique<Run>(session, *registry_, choice_);
}

void SessionPictures::note(const Session& session) {
  run_->note(session);
}

render::Image SessionPictures::draw() const {
  return renderer_->draw(run_->composer->compose(run_->camera, run_->trace.last));
}

}  // namespace vinerow::playback
