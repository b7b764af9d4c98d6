#include "engine/run/run_channels.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "engine/api/messages/camera.h"
#include "engine/api/messages/event.h"
#include "engine/api/messages/flight.h"
#include "engine/api/messages/motion.h"
#include "engine/api/messages/sensors.h"
#include "engine/playback/log_scene.h"
#include "engine/sim/simulation.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow::run {
namespace {

/// True for the error-free readings of a laser scanner. They are the largest messages, and checks
/// need them with full precision.
bool is_true_scan(const SignalBase& signal) {
  return std::string_view(signal.type()) == LaserScan::kType && signal.name().ends_with("_truth");
}

/// True for the pictures of a camera without noise: as large as those with noise.
bool is_true_picture(const SignalBase& signal) {
  return std::string_view(signal.type()) == Picture::kType && signal.name().ends_with("_truth");
}

Duration shortest_period(const SignalBase& signal, const scenario::RecordConfig& config) {
  const std::string& name = signal.name();
  // A run can be repeated only from all of its commands.
  if (signal.writer() == kOutside) return {};
  const bool is_observed = std::string_view(signal.type()) == Odometry::kType &&
                           signal.writer().find(".observers.") != std::string::npos;
  const bool is_truth = name.ends_with("/truth") || name.ends_with("/estimate");
  if (is_truth || is_observed) return period_of_rate(config.truth_rate_Hz);
  // A large message; half the rate is enough to see changes of slip.
  if (name.ends_with("/wheels")) return period_of_rate(config.truth_rate_Hz) * 2;
  // A large message whose values change slowly.
  if (name.ends_with("/battery")) return period_of_rate(std::min(1.0, config.truth_rate_Hz));
  // Consecutive references overlap in their previews.
  if (std::string_view(signal.type()) == ReferenceTrajectory::kType) {
    return period_of_rate(config.truth_rate_Hz) * 4;
  }
  const bool is_event = std::string_view(signal.type()) == Event::kType;
  if (is_event || name.ends_with("/plan") || name.ends_with("/contacts")) return {};
  return period_of_rate(config.sensor_rate_limit_Hz);
}

}  // namespace

void add_run_channels(const Simulation& simulation, record::SignalChannels& channels) {
  const scenario::RecordConfig& config = simulation.scenario().record;
  const std::map<std::string, std::string> frames = playback::frames_of_readings(simulation);
  for (const auto& signal : simulation.bus().signals()) {
    if (signal->writer().empty() || is_true_picture(*signal)) continue;
    const auto frame = frames.find(signal->name());
    channels.add_signal(*signal, shortest_period(*signal, config),
                        frame != frames.end() ? frame->second : "", is_true_scan(*signal));
  }
  channels.add_static_transforms(playback::sensor_transforms(simulation));
  std::vector<record::SceneEntity> scene = playback::world_scene(simulation.world());
  for (const auto& vehicle : simulation.vehicles()) {
    for (auto& link : playback::vehicle_scene(vehicle->name(), vehicle->vehicle().links())) {
      scene.push_back(std::move(link));
    }
  }
  channels.add_scene(scene);
}

}  // namespace vinerow::run
