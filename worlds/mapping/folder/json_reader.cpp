#include "worlds/mapping/folder/json_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"

namespace vinerow::mapping {
namespace {

/// A value as a sentence shows it.
std::string shown(const nlohmann::json& value) {
  constexpr std::size_t kLong = 40;
  const std::string text = value.dump();
  return text.size() <= kLong ? text : fmt::format("{}...", text.substr(0, kLong));
}

}  // namespace

void JsonReader::fail(const std::string& sentence) const {
  throw ConfigError(place_.empty() ? fmt::format("{} {}", subject_, sentence)
                                   : fmt::format("{}: {} {}", subject_, place_, sentence));
}

JsonReader JsonReader::at(const std::string& key) const {
  if (!value_.is_object()) fail(fmt::format("is {}, must be a mapping", shown(value_)));
  const auto found = value_.find(key);
  if (found == value_.end()) fail(fmt::format("has no key '{}'", key));
  return {*found, subject_, place_.empty() ? key : place_ + "." + key};
}

bool JsonReader::has(const std::string& key) const {
  return value_.is_object() && value_.contains(key);
}

std::optional<JsonReader> JsonReader::optional_at(const std::string& key) const {
  const JsonReader found = at(key);
  if (found.value_.is_null()) return std::nullopt;
  return found;
}

std::vector<JsonReader> JsonReader::items() const {
  if (!value_.is_array()) fail(fmt::format("is {}, must be a list", shown(value_)));
  std::vector<JsonReader> all;
  for (std::size_t k = 0; k < value_.size(); ++k) {
    all.emplace_back(value_[k], subject_, fmt::format("{}[{}]", place_, k));
  }
  return all;
}

double JsonReader::number() const {
  if (!value_.is_number() || !std::isfinite(value_.get<double>())) {
    fail(fmt::format("is {}, must be a finite number", shown(value_)));
  }
  return value_.get<double>();
}

double JsonReader::number_above(double low) const {
  const double value = number();
  if (!(value > low)) fail(fmt::format("is {}, must be > {:g}", shown(value_), low));
  return value;
}

std::int64_t JsonReader::whole(std::int64_t low) const {
  if (!value_.is_number_integer() || value_.get<std::int64_t>() < low) {
    fail(fmt::format("is {}, must be a whole number >= {}", shown(value_), low));
  }
  return value_.get<std::int64_t>();
}

std::string JsonReader::text() const {
  if (!value_.is_string()) fail(fmt::format("is {}, must be a text", shown(value_)));
  return value_.get<std::string>();
}

std::vector<double> JsonReader::numbers_of(int size) const {
  const std::vector<JsonReader> all = items();
  if (static_cast<int>(all.size()) != size) {
    fail(fmt::format("has {} numbers, must have {}", all.size(), size));
  }
  std::vector<double> numbers;
  for (const JsonReader& item : all) numbers.push_back(item.number());
  return numbers;
}

}  // namespace vinerow::mapping
