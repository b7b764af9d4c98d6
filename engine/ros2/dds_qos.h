#pragma once
/// Qos as Cyclone DDS takes it. Internal to this folder.

#include <dds/dds.h>

#include <memory>
#include <string>

#include "engine/ros2/qos.h"

namespace vinerow::ros2 {

struct DeleteQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using DdsQos = std::unique_ptr<dds_qos_t, DeleteQos>;

/// QoS of a reader or writer, as rmw_cyclonedds_cpp sets it.
/// @param user_data  "typehash=RIHS01_...;", may be empty
DdsQos make_dds_qos(const Qos& qos, const std::string& user_data);

/// QoS of a participant: the security enclave, without which ROS 2 ignores the participant's nodes.
DdsQos make_participant_qos();

/// "typehash=RIHS01_...;", empty for an empty hash.
std::string type_hash_entry(const std::string& type_hash);

/// Value of "key=value;" in the user data, empty if the key is missing.
std::string user_data_value(const dds_qos_t* qos, const std::string& key);

}  // namespace vinerow::ros2
