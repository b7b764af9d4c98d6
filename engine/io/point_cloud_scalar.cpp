#include "engine/io/point_cloud_scalar.h"

#include <charconv>
#include <limits>

namespace vinerow::io {

std::size_t size_of(Scalar type) {
  switch (type) {
    case Scalar::kI8:
    case Scalar::kU8:
      return 1;
    case Scalar::kI16:
    case Scalar::kU16:
      return 2;
    case Scalar::kI32:
    case Scalar::kU32:
    case Scalar::kF32:
      return 4;
    case Scalar::kI64:
    case Scalar::kU64:
    case Scalar::kF64:
      break;
  }
  return 8;
}

double load(Scalar type, const std::uint8_t* bytes, std::endian order) {
  switch (type) {
    case Scalar::kI8:
      return load<std::int8_t>(bytes, order);
    case Scalar::kU8:
      return load<std::uint8_t>(bytes, order);
    case Scalar::kI16:
      return load<std::int16_t>(bytes, order);
    case Scalar::kU16:
      return load<std::uint16_t>(bytes, order);
    case Scalar::kI32:
      return load<std::int32_t>(bytes, order);
    case Scalar::kU32:
      return load<std::uint32_t>(bytes, order);
    case Scalar::kI64:
      return static_cast<double>(load<std::int64_t>(bytes, order));
    case Scalar::kU64:
      return static_cast<double>(load<std::uint64_t>(bytes, order));
    case Scalar::kF32:
      return load<float>(bytes, order);
    case Scalar::kF64:
      break;
  }
  return load<double>(bytes, order);
}

std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    const std::size_t exponent = text.find_first_of("eE");
    const bool tiny =
        exponent == std::string_view::npos
            ? text.substr(0, text.find('.')).find_first_of("123456789") == std::string_view::npos
            : text.substr(exponent + 1).starts_with('-');
    return tiny ? 0.0 : std::numeric_limits<double>::infinity();
  }
  return value;
}

std::optional<std::uint64_t> parse_count(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || error != std::errc()) return std::nullopt;
  return value;
}

std::string_view next_word(std::string_view* line) {
  constexpr std::string_view kBlanks = " \t\r\v\f";
  line->remove_prefix(std::min(line->find_first_not_of(kBlanks), line->size()));
  const std::string_view word = line->substr(0, line->find_first_of(kBlanks));
  line->remove_prefix(word.size());
  return word;
}

}  // namespace vinerow::io
