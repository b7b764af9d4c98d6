#pragma once
/// Messages of one run on ROS 2 topics.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/live/transform_tree.h"
#include "engine/record/message_sink.h"
#include "engine/record/signal_channels.h"
#include "engine/ros2/node.h"
#include "engine/sim/run_observer.h"

namespace vinerow {
class Simulation;
}

namespace vinerow::live {

/// Publishes what the log of the run would contain, but no commands; and /clock, /tf (instead of
/// the log's links of each vehicle) and the descriptions of the vehicles. Publishers stay over
/// restarts.
class Ros2Topics final : public RunObserver, private record::MessageSink {
 public:
  /// @param node  outlives this object
  /// @param out  as describe_robot()
  Ros2Topics(ros2::Node& node, bool is_humble, Localisation localisation,
             std::filesystem::path out);

  /// Another run begins. From the run's thread, like the functions of the observer.
  /// @throws as describe_robot()
  void begin(const Simulation& simulation);
  void on_instant(Time now) override;
  void on_event(Time now, const Event& event) override;

  /// Counts the subscriptions of each topic, because asking at each message would take longer than
  /// most messages. Call about 100 times a second from another thread.
  void count_subscribers();
  /// Whether anybody reads a topic of a vehicle.
  bool has_subscribers() const { return readers_ > 0; }

 private:
  struct Topic {
    std::unique_ptr<ros2::Publisher> publisher;
    std::atomic<int> subscribers = 0;
    bool is_latched = false;
  };
  struct ChannelTopic {
    Topic* topic = nullptr;     ///< null: not published
    bool has_variance = false;  ///< sensor_msgs/Range in its form since Iron
  };

  Topic* topic_of(const std::string& name, const std::string& type, const ros2::Qos& qos,
                  const std::string& definition);
  std::uint16_t add_channel(const record::ChannelSpec& spec) override;
  bool wants(std::uint16_t channel) const override;
  record::ByteBuffer& start_message(std::uint16_t channel, std::uint64_t log_time,
                                    std::uint64_t publish_time) override;
  void end_message() override;
  void publish_clock(Time now);
  void publish_transforms(Time now);
  void publish_descriptions(const Simulation& simulation);

  ros2::Node& node_;
  const bool is_humble_;
  const Localisation localisation_;
  const std::filesystem::path out_;
  std::vector<ChannelTopic> channels_;  ///< by channel id - 1
  std::map<std::string, std::unique_ptr<Topic>> topics_;
  std::unique_ptr<record::SignalChannels> signals_;
  record::ByteBuffer buffer_;
  std::uint16_t open_channel_ = 0;
  Topic* clock_ = nullptr;
  Topic* transforms_ = nullptr;
  std::unique_ptr<TransformTree> tree_;  ///< of this run
  std::atomic<int> readers_ = 0;
};

}  // namespace vinerow::live
