#pragma once
/// Description of a vehicle for ROS 2 viewers, as robot_state_publisher publishes it.

#include <filesystem>
#include <string>

namespace vinerow {
class Vehicle;
}

namespace vinerow::live {

/// URDF with the root "base_link" and the vehicle's links, whose names are those of /tf without
/// "<vehicle>/": a viewer has a prefix for the names, as for the robots of robot_state_publisher.
/// Writes it to `<out>/robot_description/<vehicle>.urdf` too, and the meshes to
/// `<out>/robot_description/<vehicle>/<link>.dae`.
/// @param out  folder of the run's files; empty: nothing is written, and the links have no meshes
/// @throws ConfigError, WriteError if the files cannot be written
std::string describe_robot(const std::string& name, const Vehicle& vehicle,
                           const std::filesystem::path& out);

}  // namespace vinerow::live
