#pragma once
/// The registered controllers, guidances, planners and estimators, by name and with some
/// parameters.

#include <string>
#include <utility>
#include <vector>

#include "engine/api/registry.h"

namespace vinerow::test {

using Values = std::vector<std::pair<std::string, ParameterSet::Value>>;

/// A part by name with some of its parameters.
struct PartChoice {
  std::string type;
  Values values;
};

const Registry& parts();
/// Names of the registered parts whose specs list this signal among those they read. Controllers of
/// ground vehicles read a "plan", those of flying ones a "reference".
std::vector<std::string> parts_that_read(PartKind kind, const std::string& signal);
/// The same of a signal that they write: controllers of rotorcraft a "wrench", those of vehicles on
/// wings their "deviation" from steady flight.
std::vector<std::string> parts_that_write(PartKind kind, const std::string& signal);

ParameterSet make_parameters(const PartSpec& spec, const Values& values);
ParameterSet make_parameters(PartKind kind, const PartChoice& choice);

}  // namespace vinerow::test
