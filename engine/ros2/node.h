#pragma once
/// A ROS 2 node without ROS: topics and services over Cyclone DDS, seen by `ros2 node list`,
/// `ros2 topic echo` and every rclcpp or rclpy node of the same domain.
///
/// Messages are whole CDR messages with their 4-byte encapsulation header. They are passed on as
/// they are: a subscriber may get either byte order and any damage.
///
/// Threads: Cyclone has threads of its own. publish() and wake() may be called from any thread;
/// take() of one object, reply() and wait() from one thread each.

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "engine/ros2/publisher.h"
#include "engine/ros2/qos.h"
#include "engine/ros2/service.h"
#include "engine/ros2/subscription.h"

namespace vinerow::ros2 {

class Participant;

struct NodeOptions {
  std::string name = "vinerow";
  std::string name_space = "/";
  int domain_id = 0;     ///< ROS_DOMAIN_ID, 0..232
  bool network = false;  ///< true: other hosts see the node; false: this host only
  /// ROS 2 Humble: peers of Humble read another form of the discovery message. Topics work either
  /// way, but peers of other releases then do not list the node.
  bool humble = false;
};

class Node {
 public:
  /// Joins the domain. If CYCLONEDDS_URI is set, it replaces the configuration, also `network`.
  /// @throws ConfigError for an invalid name or domain, or if the domain does not start (domain.h)
  explicit Node(const NodeOptions& options);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// The objects may outlive the node; the participant leaves the domain with the last of them.
  /// @param topic      "/rover/imu"; "imu" is relative to the namespace, "~/imu" to the node
  /// @param type       "sensor_msgs/msg/Imu"
  /// @param type_hash  message_type_hash(); empty: `ros2 topic info -v` shows no hash
  /// @throws ConfigError for an invalid name. Endpoints of other types do not match the topic's.
  std::unique_ptr<Publisher> create_publisher(const std::string& topic, const std::string& type,
                                              const Qos& qos, const std::string& type_hash);
  std::unique_ptr<Subscription> create_subscription(const std::string& topic,
                                                    const std::string& type, const Qos& qos,
                                                    const std::string& type_hash);

  /// Server of a service as rmw_cyclonedds_cpp does it (service.h: its clients must use that, too).
  /// @param service  "/rover/reset", relative as a topic  @param type  "std_srvs/srv/Trigger"
  std::unique_ptr<Service> create_service(const std::string& service, const std::string& type,
                                          const std::string& request_hash,
                                          const std::string& response_hash,
                                          const Qos& qos = kServicesQos);

  /// Waits until a subscription or service of this node has a message, wake() is called, or the
  /// time is over. @returns true if there is a message to take
  bool wait(std::chrono::nanoseconds timeout);
  /// Ends the current wait(), or the next one if there is none.
  void wake();

  const std::string& name() const;
  const std::string& name_space() const;
  Guid participant() const;

 private:
  std::shared_ptr<Participant> participant_;
};

}  // namespace vinerow::ros2
