#include "engine/live/transform_tree.h"

#include <string_view>

#include "engine/record/ros_fields.h"

namespace vinerow::live {
namespace {

constexpr std::string_view kTruthSuffix = "_truth";
/// A vehicle whose dead reckoning is silent for so long stands still or has lost it.
constexpr Duration kSilent{1'000'000'000};
/// Longest `delay_s` of a sensor: what was measured before was lost.
constexpr Duration kLongestDelay{10'000'000'000};

template <class T>
const Signal<T>* typed_signal(const SignalBus& bus, const std::string& name) {
  const SignalBase* signal = bus.find(name);
  if (!signal || !is_message<T>(*signal)) return nullptr;
  return static_cast<const Signal<T>*>(signal);
}

}  // namespace

template <class T>
bool TransformTree::Watched<T>::is_new() {
  if (!signal || signal->sequence() == seen) return false;
  seen = signal->sequence();
  return true;
}

TransformTree::TransformTree(const SignalBus& bus, Localisation localisation)
    : map_(record::FrameNames().world) {
  for (const auto& signal : bus.signals()) {
    if (!is_message<LinkPoses>(*signal)) continue;
    add_vehicle(bus, static_cast<const Signal<LinkPoses>&>(*signal), localisation);
  }
}

void TransformTree::add_vehicle(const SignalBus& bus, const Signal<LinkPoses>& links,
                                Localisation localisation) {
  Vehicle vehicle;
  vehicle.frames = record::FrameNames::of_signal(links.name());
  const std::string& prefix = vehicle.frames.prefix;
  vehicle.odom = prefix + std::string(record::kOdometryFrame);
  vehicle.links.signal = &links;
  vehicle.truth = typed_signal<Odometry>(bus, prefix + "truth");
  if (!vehicle.truth) return;
  const auto* estimate = typed_signal<Odometry>(bus, prefix + "estimate");
  switch (localisation) {
    case Localisation::kTruth:
      vehicle.localised = vehicle.truth;
      break;
    case Localisation::kEstimate:
      vehicle.localised = estimate ? estimate : vehicle.truth;
      break;
    case Localisation::kNone:
      vehicle.localised = nullptr;
  }
  for (const auto& signal : bus.signals()) {
    const std::string& name = signal->name();
    if (!name.starts_with(prefix) || name.ends_with(kTruthSuffix)) continue;
    vehicle.reckoning.signal = typed_signal<DeadReckoning>(bus, name);
    if (!vehicle.reckoning.signal) continue;
    vehicle.reckoning_truth.signal =
        typed_signal<DeadReckoning>(bus, name + std::string(kTruthSuffix));
    break;
  }
  vehicle.body.signal = vehicle.localised ? vehicle.localised : vehicle.truth;
  vehicles_.push_back(std::move(vehicle));
}

/// Without dead reckoning, at the rate of the links. An estimate that is slower than they is passed
/// on once: listeners warn of transforms that repeat a stamp.
void TransformTree::add_body(Vehicle& vehicle) {
  if (!vehicle.body.is_new()) return;
  const Signal<Odometry>& pose = *vehicle.body.signal;
  if (vehicle.localised) transforms_.push_back({pose.stamp(), &map_, vehicle.odom, Pose{}});
  transforms_.push_back({pose.stamp(), &vehicle.odom, vehicle.frames.body, pose.value().X_WB});
}

void TransformTree::add_reckoned(Vehicle& vehicle, Time now) {
  // A reading may arrive later than it was measured, and is compared with the pose of that time.
  if (vehicle.reckoning_truth.is_new() && vehicle.localised && vehicle.localised->sequence() > 0) {
    vehicle.measured.emplace_back(vehicle.reckoning_truth.signal->stamp(),
                                  vehicle.localised->value().X_WB);
    while (now - vehicle.measured.front().first > kLongestDelay) vehicle.measured.pop_front();
  }
  if (!vehicle.reckoning.is_new()) return;
  const Time stamp = vehicle.reckoning.signal->stamp();
  vehicle.heard = now;
  const Pose& X_OB = vehicle.reckoning.signal->value().X_OB;
  while (!vehicle.measured.empty() && vehicle.measured.front().first < stamp) {
    vehicle.measured.pop_front();
  }
  if (!vehicle.measured.empty() && vehicle.measured.front().first == stamp) {
    const Pose& X_WB = vehicle.measured.front().second;
    transforms_.push_back({stamp, &map_, vehicle.odom, X_WB * X_OB.inverse()});
  }
  transforms_.push_back({stamp, &vehicle.odom, vehicle.frames.body, X_OB});
}

/// At the rate of the links.
void TransformTree::add_held(const Vehicle& vehicle, Time now) {
  if (vehicle.heard && now - *vehicle.heard < kSilent) return;
  const Pose X_OB = vehicle.heard ? vehicle.reckoning.signal->value().X_OB : Pose{};
  if (vehicle.localised && vehicle.localised->sequence() > 0) {
    const Pose& X_WB = vehicle.localised->value().X_WB;
    transforms_.push_back({now, &map_, vehicle.odom, X_WB * X_OB.inverse()});
  }
  transforms_.push_back({now, &vehicle.odom, vehicle.frames.body, X_OB});
}

void TransformTree::add_links(const Vehicle& vehicle) {
  const Signal<LinkPoses>& links = *vehicle.links.signal;
  const LinkPoses& value = links.value();
  for (std::size_t i = 0; i < value.names.size(); ++i) {
    transforms_.push_back({links.stamp(), &vehicle.frames.body,
                           vehicle.frames.prefix + value.names[i],
                           record::pose_in_body(vehicle.truth->value().X_WB, value.X_WL[i])});
  }
}

bool TransformTree::update(Time now) {
  transforms_.clear();
  for (Vehicle& vehicle : vehicles_) {
    if (vehicle.reckoning.signal) add_reckoned(vehicle, now);
    if (!vehicle.links.is_new()) continue;
    if (vehicle.reckoning.signal) {
      add_held(vehicle, now);
    } else {
      add_body(vehicle);
    }
    add_links(vehicle);
  }
  return !transforms_.empty();
}

void TransformTree::write(record::CdrWriter& out) const {
  out.add_count(transforms_.size());
  for (const Transform& transform : transforms_) {
    record::write_header(out, transform.stamp, *transform.parent);
    out.add(std::string_view(transform.child));
    record::write_pose(out, transform.X_PC);
  }
}

}  // namespace vinerow::live
