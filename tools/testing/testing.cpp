#include "vinerow/testing.h"

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/scenario/scenario.h"
#include "engine/sim/simulation.h"

namespace vinerow::testing {

TestRun TestRun::from_file(const std::filesystem::path& file,
                           const std::vector<std::string>& sets) {
  return TestRun(open_session(file, {sets, std::nullopt}));
}

TestRun TestRun::from_yaml(const std::string& yaml, const std::filesystem::path& folder) {
  return TestRun(open_session_text(yaml, folder));
}

TestRun& TestRun::run_for_s(double duration_s) {
  if (!session_.over()) session_.advance_for(duration_from_s(duration_s));
  return *this;
}

TestRun& TestRun::run_to_end() {
  if (!session_.over()) session_.advance(Time{} + duration_from_s(session_.scenario().duration_s));
  return *this;
}

double TestRun::time_s() const {
  return session_.now().s();
}
bool TestRun::finished() const {
  return session_.finished();
}
const Odometry& TestRun::truth(const std::string& vehicle) const {
  return session_.simulation().truth(vehicle);
}
std::string TestRun::digest() const {
  return session_.digest();
}

std::map<std::string, double> TestRun::metrics(const std::string& vehicle) const {
  static_cast<void>(truth(vehicle));  // throws for an unknown vehicle, with the known names
  return session_.metrics().at(vehicle);
}

double TestRun::metric(const std::string& vehicle, const std::string& name) const {
  const auto all = metrics(vehicle);
  const auto found = all.find(name);
  if (found != all.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [key, value] : all) known.push_back(key);
  throw ConfigError(fmt::format("vehicle '{}' has no metric '{}'{} (known: {})", vehicle, name,
                                did_you_mean(name, known), join(known)));
}

const SignalBase& TestRun::written_signal(const std::string& name, const MessageType& type) const {
  const SignalBase& signal = session_.any_signal(name);
  if (std::string_view(signal.type()) != type.name ||
      signal.message_type().layout != type.layout) {
    throw ConfigError(fmt::format("signal '{}' is {}, not {}", name, signal.type(), type.name));
  }
  if (signal.sequence() == 0)
    throw ConfigError(fmt::format("signal '{}' has not been written yet", name));
  return signal;
}

}  // namespace vinerow::testing
