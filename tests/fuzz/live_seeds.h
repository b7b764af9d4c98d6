#pragma once
/// Inputs to start fuzzing live runs from: what clients send, in the form of read_live_frames().

#include <string>
#include <vector>

namespace vinerow::fuzz {

struct LiveSeed {
  std::string name;
  std::string bytes;
  int refusals = 0;   ///< that its frames meet
  int responses = 0;  ///< of services
};

/// Each below 4 kB.
std::vector<LiveSeed> live_seeds();

}  // namespace vinerow::fuzz
