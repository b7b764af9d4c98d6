#pragma once
/// A command for a run, and the peer that sent it.

#include <functional>
#include <string>

#include "engine/api/outside.h"

namespace vinerow::live {

/// Called once with "", or with the reason why a request was not met, from any thread.
using Answer = std::function<void(const std::string& reason)>;

struct PeerCommand {
  OutsideCommand command;  ///< its stamp counts only in lock-step
  std::string peer;        ///< "client 3", "ROS 2 node /teleop"
  /// Called if the run refuses the command later on, from the run's thread. May be empty.
  Answer refused = {};
};

}  // namespace vinerow::live
