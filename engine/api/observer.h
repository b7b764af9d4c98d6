#pragma once
/// Observers: estimators that run beside the one a vehicle acts on, on the same sensors, so that
/// several are compared on one run, or one is judged in open loop while the vehicle goes by truth.

#include <map>
#include <string>

namespace vinerow {

/// What the signals of an estimator are called where it runs as the observer `name`: "estimate" is
/// `name` itself, the others have its name before them, `name`_ellipsoid and so on.
inline std::map<std::string, std::string> observer_signals(const std::string& name) {
  return {{"estimate", name},
          {"ellipsoid", name + "_ellipsoid"},
          {"estimator_state", name + "_state"},
          {"estimator_event", name + "_event"}};
}

}  // namespace vinerow
