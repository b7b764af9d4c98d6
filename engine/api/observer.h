#pragma once
/// Observers: estimators that run next to the vehicle's own, on the same sensors, and control
/// nothing. They compare several estimators in one run, or judge one in open loop while the vehicle
/// uses the truth.

#include <map>
#include <string>

namespace vinerow {

/// Signal names of an estimator that runs as the observer `name`: "estimate" becomes `name`, the
/// others get the name as prefix, `name`_ellipsoid and so on.
inline std::map<std::string, std::string> observer_signals(const std::string& name) {
  return {{"estimate", name},
          {"ellipsoid", name + "_ellipsoid"},
          {"estimator_state", name + "_state"},
          {"estimator_event", name + "_event"}};
}

}  // namespace vinerow
