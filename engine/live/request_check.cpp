#include "engine/live/request_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "engine/live/foxglove_client.h"

namespace vinerow::live {
namespace {

std::string decode(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned value = 0;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(text.data() + i + 1, text.data() + i + 3, value, 16).ptr ==
            text.data() + i + 3) {
      result += static_cast<char>(value);
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Splits at a character and calls f with every part, trimmed.
template <class F>
void for_each_part(std::string_view text, char separator, const F& f) {
  while (!text.empty()) {
    const std::size_t end = text.find(separator);
    f(trimmed(text.substr(0, end)));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
}

}  // namespace

Target split_target(std::string_view target) {
  const std::size_t query = target.find('?');
  Target result{decode(target.substr(0, query)), ""};
  if (query == std::string_view::npos) return result;
  constexpr std::string_view kKey = "token=";
  for_each_part(target.substr(query + 1), '&', [&](std::string_view part) {
    if (!part.starts_with(kKey)) return;
    // Browsers write a space in a query as "+".
    std::string value(part.substr(kKey.size()));
    std::replace(value.begin(), value.end(), '+', ' ');
    result.token = decode(value);
  });
  return result;
}

std::string percent_encoded(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') ||
                          std::string_view("-._~").find(c) != std::string_view::npos;
    result += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return result;
}

bool is_same_secret(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference |= static_cast<unsigned char>(a[i]) ^
                  static_cast<unsigned char>(b.empty() ? 0 : b[i % b.size()]);
  }
  return difference == 0;
}

bool is_trusted_origin(std::string_view origin) {
  if (origin.empty() || origin == "file://") return true;
  for (const std::string_view page : {"https://app.foxglove.dev", "https://studio.foxglove.dev"}) {
    if (origin == page) return true;
  }
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (!origin.starts_with(scheme)) continue;
    const std::string_view host = origin.substr(scheme.size());
    for (const std::string_view own : {"localhost", "127.0.0.1", "[::1]"}) {
      if (host == own || host.starts_with(std::string(own) + ":")) return true;
    }
  }
  return false;
}

std::string choose_protocol(std::string_view offered) {
  std::string chosen;
  for (const std::string_view own : kFoxgloveProtocols) {
    for_each_part(offered, ',', [&](std::string_view part) {
      if (chosen.empty() && part == own) chosen = part;
    });
  }
  return chosen;
}

}  // namespace vinerow::live
