#pragma once
/// Random changes of inputs, for tests without a fuzzer.

#include <string>
#include <vector>

#include "engine/core/random.h"

namespace vinerow::fuzz {

inline std::size_t below(RandomStream& random, std::size_t count) {
  return static_cast<std::size_t>(random.next_u64() % count);
}

/// One to six changes: bytes set, removed, repeated, or taken from another input.
/// @param inputs  not empty, and none of them empty
inline std::string changed(std::string bytes, const std::vector<std::string>& inputs,
                           RandomStream& random) {
  const std::size_t changes = 1 + below(random, 6);
  for (std::size_t k = 0; k < changes && !bytes.empty(); ++k) {
    const std::size_t at = below(random, bytes.size());
    const std::size_t length = 1 + below(random, 16);
    const std::string& other = inputs[below(random, inputs.size())];
    switch (below(random, 5)) {
      case 0:
        bytes[at] = static_cast<char>(below(random, 256));
        break;
      case 1:
        bytes.erase(at, length);
        break;
      case 2:
        bytes.insert(at, bytes.substr(below(random, bytes.size()), length));
        break;
      case 3:
        bytes.insert(at, other.substr(below(random, other.size()), length));
        break;
      default:
        bytes.replace(at, length, std::string(length, '9'));
    }
  }
  return bytes;
}

}  // namespace vinerow::fuzz
