#pragma once
/// Services of a live run, as other simulators offer them to ROS 2: the package
/// simulation_interfaces (https://github.com/ros-simulation/simulation_interfaces, version 1.1 and
/// later; the definitions used here are the same in 2.1).

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "engine/live/run_control.h"

namespace vinerow::live {

class Entities;

/// A service and the definitions of its two messages in the encoding "ros2msg".
struct ServiceType {
  std::string name;  ///< "get_entities"
  std::string type;  ///< "simulation_interfaces/srv/GetEntities"
  std::string request;
  std::string response;
};

/// In a fixed order.
const std::vector<ServiceType>& service_types();

/// Receives the response once, from any thread.
using Respond = std::function<void(const nlohmann::json& response)>;

class Services {
 public:
  /// Both outlive this object.
  Services(RunControl& control, const Entities& entities);

  /// @param index  in service_types(). @param request  of the service's type
  void call(std::size_t index, const nlohmann::json& request, const Respond& respond);
  /// The same with CDR messages. @throws ConfigError if the bytes hold no such request
  void call_cdr(std::size_t index, std::span<const std::uint8_t> request,
                const std::function<void(const std::vector<std::uint8_t>& response)>& respond);

 private:
  RunControl& control_;
  const Entities& entities_;
};

}  // namespace vinerow::live
