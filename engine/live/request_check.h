#pragma once
/// Checks of HTTP requests that do not need the network: token, origin, path.

#include <string>
#include <string_view>

namespace vinerow::live {

struct Target {
  std::string path;   ///< "/live.js", decoded
  std::string token;  ///< value of ?token=, decoded
};

/// Splits the target of a request. Malformed percent signs stay as they are.
Target split_target(std::string_view target);

/// All but letters, digits, '-', '.', '_' and '~' as %XX.
std::string percent_encoded(std::string_view text);

/// Compares in a time that does not depend on the place of the first difference.
bool is_same_secret(std::string_view a, std::string_view b);

/// Whether a web page may connect without a token: programs (no origin), pages of this machine, and
/// Foxglove's. Otherwise any page that the user visits could command the run.
bool is_trusted_origin(std::string_view origin);

/// The first of our protocols in a list "a, b"; "" if there is none.
std::string choose_protocol(std::string_view offered);

}  // namespace vinerow::live
