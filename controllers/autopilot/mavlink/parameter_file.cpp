#include "controllers/autopilot/mavlink/parameter_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>

#include "controllers/autopilot/link/plain_text.h"
#include "engine/core/error.h"
#include "engine/core/files.h"

namespace vinerow::controllers {
namespace {

constexpr std::size_t kMaxName = 16;

/// Words between blanks and commas, up to a comment.
std::vector<std::string> words_of(std::string line) {
  line.resize(std::min(line.size(), line.find('#')));
  std::vector<std::string> words;
  std::string word;
  for (const char c : line + " ") {
    if (c != ' ' && c != '\t' && c != ',' && c != '\r') {
      word += c;
    } else if (!word.empty()) {
      words.push_back(std::exchange(word, {}));
    }
  }
  return words;
}

bool read_number(const std::string& word, double& value) {
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  return error == std::errc() && stop == end && std::isfinite(value);
}

}  // namespace

void set_parameter(std::vector<FirmwareParameter>& parameters, const FirmwareParameter& wanted) {
  const auto found =
      std::find_if(parameters.begin(), parameters.end(),
                   [&](const FirmwareParameter& known) { return known.name == wanted.name; });
  if (found == parameters.end()) {
    parameters.push_back(wanted);
  } else {
    found->value = wanted.value;
  }
}

std::vector<FirmwareParameter> parse_parameters(const std::string& text,
                                                const std::filesystem::path& file) {
  std::vector<FirmwareParameter> parameters;
  std::istringstream in(text);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::vector<std::string> words = words_of(line);
    if (words.empty()) continue;
    // Five words: QGroundControl, with the numbers of vehicle and component first.
    const std::size_t at = words.size() == 5 ? 2 : 0;
    FirmwareParameter parameter;
    if ((words.size() != 2 && words.size() != 5) || words[at].size() > kMaxName ||
        !read_number(words[at + 1], parameter.value)) {
      throw ConfigError(
          fmt::format("{}:{}: \"{}\" must be a name of at most {} characters and a number",
                      file.string(), number, plain_text(line.substr(0, 60)), kMaxName));
    }
    parameter.name = words[at];
    set_parameter(parameters, parameter);
  }
  return parameters;
}

std::vector<FirmwareParameter> read_parameter_file(const std::filesystem::path& file) {
  const std::optional<std::string> text = read_bytes(file);
  if (!text) {
    throw ConfigError(fmt::format("{}: the file of parameters cannot be read", file.string()));
  }
  return parse_parameters(*text, file);
}

std::string parameter_text(const std::vector<FirmwareParameter>& parameters) {
  std::string text;
  for (const auto& [name, value] : parameters) text += fmt::format("{} {}\n", name, value);
  return text;
}

}  // namespace vinerow::controllers
