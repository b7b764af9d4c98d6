#include "tests/controllers/support/parts.h"

#include <algorithm>

#include "controllers/register_controllers.h"

namespace vinerow::test {
namespace {

std::vector<std::string> parts_with(PartKind kind, std::vector<std::string> PartSpec::*signals,
                                    const std::string& signal) {
  std::vector<std::string> found;
  for (const std::string& name : parts().names(kind)) {
    const std::vector<std::string>& all = parts().spec(kind, name).*signals;
    if (std::find(all.begin(), all.end(), signal) != all.end()) found.push_back(name);
  }
  return found;
}

}  // namespace

const Registry& parts() {
  static const Registry registry = [] {
    Registry r;
    controllers::register_controllers(r);
    return r;
  }();
  return registry;
}

std::vector<std::string> parts_that_read(PartKind kind, const std::string& signal) {
  return parts_with(kind, &PartSpec::reads, signal);
}

std::vector<std::string> parts_that_write(PartKind kind, const std::string& signal) {
  return parts_with(kind, &PartSpec::writes, signal);
}

ParameterSet make_parameters(const PartSpec& spec, const Values& values) {
  ParameterSet parameters(spec.parameters, spec.name);
  for (const auto& [name, value] : values) parameters.set(name, value);
  parameters.require_complete();
  return parameters;
}

ParameterSet make_parameters(PartKind kind, const PartChoice& choice) {
  return make_parameters(parts().spec(kind, choice.type), choice.values);
}

}  // namespace vinerow::test
