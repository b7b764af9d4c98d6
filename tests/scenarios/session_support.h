#pragma once
/// What tests of sessions compare: all that a run has computed.

#include <map>
#include <string>
#include <vector>

#include "engine/core/hash.h"
#include "engine/sim/simulation.h"
#include "tests/scenarios/command.h"
#include "vinerow/session.h"

namespace vinerow::test {

/// Everything that can be read of a session, as text that shows where two differ: digest, metrics
/// to the bit, and of every signal the number of writes, the stamp and the last value.
inline std::vector<std::string> all_of(Session& session) {
  std::vector<std::string> all = {"digest " + session.digest(),
                                  "now " + std::to_string(session.now().ns)};
  for (const auto& [owner, metrics] : session.metrics()) {
    for (const auto& [name, value] : metrics) {
      Hasher hasher;
      hasher.add(value);
      all.push_back(owner + "." + name + " " + std::to_string(value) + " " + hasher.hex());
    }
  }
  for (const auto& signal : session.simulation().bus().signals()) {
    Hasher hasher;
    signal->hash_into(hasher);
    all.push_back(signal->name() + " " + std::to_string(signal->sequence()) + " " + hasher.hex());
  }
  return all;
}

/// A flat block of two rows with a rover in its alley that no part drives.
inline const char* kFreeRover = R"(
vinerow: 1
name: free_rover
duration_s: 3
world: {type: vineyard, row_count: 2, row_length_m: 20, relief_m: 0, waves_m: 0, leaf_cards_per_m: 10, plant_variants: 1}
vehicles:
  rover:
    type: diff_drive_rover
    spawn: {alley: 0}
    sensors: {gps: {type: gps, rate_Hz: 10, error: gaussian, accuracy_m: 0.1}}
)";

}  // namespace vinerow::test
