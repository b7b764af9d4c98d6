#pragma once
/// The DDS participant of a node, and what its publishers, subscriptions and services share.
/// Internal to this folder.

#include <dds/dds.h>

#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "engine/ros2/discovery_info.h"
#include "engine/ros2/domain.h"
#include "engine/ros2/node.h"

struct ddsi_sertype;

namespace vinerow::ros2 {

class Participant {
 public:
  explicit Participant(const NodeOptions& options);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  struct Writer {
    dds_entity_t entity;
    const ddsi_sertype* type;  ///< held by the writer
  };
  /// @param topic  DDS name, "rt/rover/imu"  @param type  "sensor_msgs/msg/Imu"
  Writer create_writer(const std::string& topic, const std::string& type, const Qos& qos,
                       const std::string& user_data);
  /// The reader ends wait() if it has data.
  dds_entity_t create_reader(const std::string& topic, const std::string& type, const Qos& qos,
                             const std::string& user_data);

  /// Announces an endpoint as part of the node, or deletes it.
  void announce_writer(dds_entity_t writer);
  void announce_reader(dds_entity_t reader);
  void remove_writer(dds_entity_t writer);
  void remove_reader(dds_entity_t reader);

  /// "serviceid=...;": ROS 2 pairs request reader and reply writer of a service by it.
  std::string next_service_id();

  bool wait(std::chrono::nanoseconds timeout);
  void wake();

  const DiscoveryInfo& info() const { return info_; }

 private:
  std::pair<dds_entity_t, const ddsi_sertype*> create_topic(const std::string& topic,
                                                            const std::string& type);
  void publish_info();

  Domain domain_;
  bool humble_;
  dds_entity_t participant_ = 0, waitset_ = 0, wake_ = 0;
  Writer info_writer_{};
  std::mutex mutex_;  ///< guards info_ and last_service_
  DiscoveryInfo info_;
  std::uint32_t last_service_ = 0;
};

Guid guid_of(dds_entity_t entity);

}  // namespace vinerow::ros2
