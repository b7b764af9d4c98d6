#pragma once
/// Reader of JSON from any source. Errors are one sentence with the file and the place.

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace vinerow::mapping {

/// Value with its place in the file. Refers to the parsed file, which must outlive it.
class JsonReader {
 public:
  /// @param subject  start of every error sentence, like "map file 'x.json'"
  JsonReader(const nlohmann::json& value, std::string subject, std::string place = "")
      : value_(value), subject_(std::move(subject)), place_(std::move(place)) {}

  /// Value under a key of a mapping. @throws ConfigError if it is missing
  JsonReader at(const std::string& key) const;
  bool has(const std::string& key) const;
  /// Empty if the value is null.
  std::optional<JsonReader> optional_at(const std::string& key) const;
  /// Entries of a list.
  std::vector<JsonReader> items() const;

  double number() const;  ///< finite
  double number_above(double low) const;
  std::int64_t whole(std::int64_t low) const;
  std::string text() const;
  /// A list of `size` finite numbers.
  template <int size>
  Eigen::Matrix<double, size, 1> vector() const {
    const std::vector<double> numbers = numbers_of(size);
    return Eigen::Map<const Eigen::Matrix<double, size, 1>>(numbers.data());
  }

  /// Throws the ConfigError "map file 'x.json': rows[3].line_m sentence".
  [[noreturn]] void fail(const std::string& sentence) const;

 private:
  std::vector<double> numbers_of(int size) const;

  const nlohmann::json& value_;
  std::string subject_, place_;
};

}  // namespace vinerow::mapping
