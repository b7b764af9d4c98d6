#include "engine/live/ros2_topics.h"

#include <string_view>
#include <utility>

#include "engine/live/robot_description.h"
#include "engine/record/ros_definitions.h"
#include "engine/record/ros_fields.h"
#include "engine/ros2/type_hash.h"
#include "engine/run/run_channels.h"
#include "engine/sim/simulation.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow::live {
namespace {

constexpr std::string_view kRange = "sensor_msgs/msg/Range";
constexpr std::string_view kTransforms = "tf2_msgs/msg/TFMessage";

/// Topic of a channel of the log.
std::string topic_of_channel(const record::ChannelSpec& spec) {
  // Nav2 and RViz look for the map there.
  if (spec.topic == "/run/map") return "/map";
  return spec.topic;
}

/// As other drivers and simulators publish it.
ros2::Qos qos_of(const std::string& topic, std::string_view type) {
  if (topic == "/tf_static" || type == "nav_msgs/msg/Path" ||
      type == "nav_msgs/msg/OccupancyGrid" || type == "visualization_msgs/msg/Marker" ||
      topic == "/run/scene") {
    return ros2::kLatchedQos;
  }
  return type.starts_with("sensor_msgs/") ? ros2::kSensorDataQos : ros2::kDefaultQos;
}

/// Definition of Range since Iron, which ends with a variance; 0: not known.
std::string with_variance(std::string definition) {
  constexpr std::string_view kLast = "float32 range\n";
  return definition.insert(definition.find(kLast) + kLast.size(), "float32 variance\n");
}

}  // namespace

Ros2Topics::Ros2Topics(ros2::Node& node, bool is_humble, Localisation localisation,
                       std::filesystem::path out)
    : node_(node), is_humble_(is_humble), localisation_(localisation), out_(std::move(out)) {
  const std::string clock = "rosgraph_msgs/msg/Clock", transforms(kTransforms);
  clock_ = topic_of("/clock", clock, ros2::kClockQos, record::full_ros_definition(clock));
  transforms_ =
      topic_of("/tf", transforms, ros2::kTransformsQos, record::full_ros_definition(transforms));
}

Ros2Topics::Topic* Ros2Topics::topic_of(const std::string& name, const std::string& type,
                                        const ros2::Qos& qos, const std::string& definition) {
  std::unique_ptr<Topic>& topic = topics_[name];
  if (!topic) {
    topic = std::make_unique<Topic>();
    topic->publisher =
        node_.create_publisher(name, type, qos, ros2::message_type_hash(type, definition));
    topic->is_latched = qos.transient_local;
  }
  return topic.get();
}

void Ros2Topics::begin(const Simulation& simulation) {
  channels_.clear();
  // Not make_unique: the base is private.
  signals_.reset(new record::SignalChannels(*this, true));
  run::add_run_channels(simulation, *signals_);
  tree_ = std::make_unique<TransformTree>(simulation.bus(), localisation_);
  publish_descriptions(simulation);
}

void Ros2Topics::publish_descriptions(const Simulation& simulation) {
  for (const auto& vehicle : simulation.vehicles()) {
    Topic* topic = topic_of("/" + vehicle->name() + "/robot_description", "std_msgs/msg/String",
                            ros2::kLatchedQos, "string data\n");
    const std::string text = describe_robot(vehicle->name(), vehicle->vehicle(), out_);
    buffer_.clear();
    record::CdrWriter out(buffer_);
    out.add(std::string_view(text));
    topic->publisher->publish(buffer_.view());
  }
}

std::uint16_t Ros2Topics::add_channel(const record::ChannelSpec& spec) {
  ChannelTopic channel;
  // Exact values are for logs; commands would come back as those of another peer. Links are in
  // /tf.
  const bool is_command = spec.metadata.contains("writer");
  const bool is_links = spec.type == kTransforms && spec.topic != "/tf_static";
  if (!spec.topic.ends_with("/exact") && !is_command && !is_links) {
    const std::string name = topic_of_channel(spec);
    channel.has_variance = spec.type == kRange && !is_humble_;
    channel.topic =
        topic_of(name, spec.type, qos_of(name, spec.type),
                 channel.has_variance ? with_variance(spec.definition) : spec.definition);
  }
  channels_.push_back(channel);
  return static_cast<std::uint16_t>(channels_.size());
}

bool Ros2Topics::wants(std::uint16_t id) const {
  const Topic* topic = channels_[id - 1].topic;
  if (!topic) return false;
  return topic->is_latched || topic->subscribers.load(std::memory_order_relaxed) > 0;
}

record::ByteBuffer& Ros2Topics::start_message(std::uint16_t id, std::uint64_t, std::uint64_t) {
  open_channel_ = id;
  buffer_.clear();
  return buffer_;
}

void Ros2Topics::end_message() {
  const ChannelTopic& channel = channels_[open_channel_ - 1u];
  if (!channel.topic) return;
  // The last field before it is a float32, so it is aligned.
  if (channel.has_variance) buffer_.add(0.0f);
  channel.topic->publisher->publish(buffer_.view());
}

void Ros2Topics::on_instant(Time now) {
  publish_clock(now);
  publish_transforms(now);
  signals_->write_new(now);
}

void Ros2Topics::on_event(Time now, const Event&) {
  signals_->write_new(now);
}

void Ros2Topics::publish_clock(Time now) {
  if (clock_->subscribers.load(std::memory_order_relaxed) == 0) return;
  buffer_.clear();
  record::CdrWriter out(buffer_);
  record::write_time(out, now);
  clock_->publisher->publish(buffer_.view());
}

void Ros2Topics::publish_transforms(Time now) {
  const bool is_new = tree_->update(now);
  if (!is_new || transforms_->subscribers.load(std::memory_order_relaxed) == 0) return;
  buffer_.clear();
  record::CdrWriter out(buffer_);
  tree_->write(out);
  transforms_->publisher->publish(buffer_.view());
}

void Ros2Topics::count_subscribers() {
  int readers = 0;
  for (auto& [name, topic] : topics_) {
    const int count = topic->publisher->subscriber_count();
    topic->subscribers = count;
    readers += count;
  }
  readers_ = readers;
}

}  // namespace vinerow::live
