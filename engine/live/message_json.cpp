#include "engine/live/message_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/record/cdr.h"

namespace vinerow::live {
namespace {

using nlohmann::json;

// Copying, printing and encoding a value recur into it: without a limit, 100 kB of "[" would
// overflow the stack of the server's thread.
constexpr int kDeepestNesting = 64;
using record::CdrReader;
using record::CdrWriter;
using record::RosField;
using record::RosKind;
using record::RosMessageType;
using record::RosSchema;

/// Calls f with a value of the C++ type of a number.
template <class F>
void with_number_type(RosKind kind, const F& f) {
  switch (kind) {
    case RosKind::kInt8:
      return f(std::int8_t{});
    case RosKind::kUint8:
      return f(std::uint8_t{});
    case RosKind::kInt16:
      return f(std::int16_t{});
    case RosKind::kUint16:
      return f(std::uint16_t{});
    case RosKind::kInt32:
      return f(std::int32_t{});
    case RosKind::kUint32:
      return f(std::uint32_t{});
    case RosKind::kInt64:
      return f(std::int64_t{});
    case RosKind::kUint64:
      return f(std::uint64_t{});
    case RosKind::kFloat32:
      return f(float{});
    default:
      return f(double{});
  }
}

class JsonToCdr {
 public:
  JsonToCdr(const RosSchema& schema, CdrWriter& out) : schema_(schema), out_(out) {}

  /// @param value  null: all fields are zero
  void write(const json& value, std::size_t message, const std::string& path) {
    const RosMessageType& type = schema_.messages[message];
    if (!value.is_object() && !value.is_null()) fail(path, value, "an object");
    for (const auto& [key, unused] : value.items()) check_key(type, key, path);
    // IDL has no empty struct; ROS 2 gives it one byte.
    if (type.fields.empty()) out_.add(std::uint8_t{0});
    for (const RosField& field : type.fields) {
      const std::string place = path.empty() ? field.name : path + "." + field.name;
      const auto found = value.is_object() ? value.find(field.name) : value.end();
      const bool is_given = value.is_object() && found != value.end();
      write_field(is_given ? *found : alias(value, field.name), field, place);
    }
  }

 private:
  [[noreturn]] static void fail(const std::string& path, const json& value, const char* wanted) {
    std::string shown = value.dump(-1, ' ', false, json::error_handler_t::replace);
    constexpr std::size_t kLongest = 60;
    if (shown.size() > kLongest) shown = shown.substr(0, kLongest) + "...";
    throw ConfigError(
        fmt::format("{} = {}, must be {}", path.empty() ? "the message" : path, shown, wanted));
  }

  static void check_key(const RosMessageType& type, const std::string& key,
                        const std::string& path) {
    std::vector<std::string> known;
    for (const RosField& field : type.fields) known.push_back(field.name);
    if (std::ranges::find(known, key) != known.end() || key == "secs" || key == "nsecs" ||
        key == "nsec") {
      return;
    }
    throw ConfigError(fmt::format("{} has no field '{}'{} (fields: {})", type.name,
                                  path.empty() ? key : path + "." + key, did_you_mean(key, known),
                                  join(known)));
  }

  /// Other spellings of the fields of a time.
  static json alias(const json& value, const std::string& name) {
    if (!value.is_object()) return nullptr;
    for (const auto& [own, other] :
         {std::pair("sec", "secs"), std::pair("nanosec", "nsecs"), std::pair("nanosec", "nsec")}) {
      if (name == own && value.contains(other)) return value[other];
    }
    return nullptr;
  }

  void write_field(const json& value, const RosField& field, const std::string& path) {
    if (field.shape == RosField::Shape::kOne) return write_one(value, field, path);
    if (!value.is_array() && !value.is_null()) fail(path, value, "a list");
    const bool is_fixed = field.shape == RosField::Shape::kArray;
    if (is_fixed && value.is_array() && value.size() != field.length) {
      fail(path, value, fmt::format("a list of {} values", field.length).c_str());
    }
    const std::size_t count = is_fixed ? field.length : value.size();
    if (!is_fixed) out_.add_count(count);
    for (std::size_t i = 0; i < count; ++i) {
      write_one(value.is_array() ? value[i] : json(), field, fmt::format("{}[{}]", path, i));
    }
  }

  void write_one(const json& value, const RosField& field, const std::string& path) {
    switch (field.kind) {
      case RosKind::kMessage:
        return write(value, field.message, path);
      case RosKind::kText:
        if (!value.is_string() && !value.is_null()) fail(path, value, "a text");
        return out_.add(std::string_view(value.is_string() ? value.get<std::string>() : ""));
      case RosKind::kBool:
        if (!value.is_boolean() && !value.is_null()) fail(path, value, "true or false");
        return out_.add(value.is_boolean() && value.get<bool>());
      default:
        return with_number_type(field.kind,
                                [&]<class T>(T) { out_.add(number_of<T>(value, path)); });
    }
  }

  template <class T>
  static T number_of(const json& value, const std::string& path) {
    if (value.is_null()) return T{};
    if (!value.is_number()) fail(path, value, "a number");
    if constexpr (std::is_floating_point_v<T>) {
      const double number = value.get<double>();
      // In single precision, a larger number would become infinite.
      if (std::isfinite(number) &&
          std::abs(number) > static_cast<double>(std::numeric_limits<T>::max())) {
        fail(path, value, "in the range of its type");
      }
      return static_cast<T>(number);
    } else {
      bool fits = false;
      if (value.is_number_unsigned()) {
        fits = std::in_range<T>(value.get<std::uint64_t>());
      } else if (value.is_number_integer()) {
        fits = std::in_range<T>(value.get<std::int64_t>());
      } else {
        // 2^64 and 2^63 are exact in double, so the comparison is safe.
        const double number = value.get<double>();
        fits = number == std::floor(number) &&
               number >= static_cast<double>(std::numeric_limits<T>::lowest()) &&
               number < std::ldexp(1.0, std::numeric_limits<T>::digits);
      }
      if (!fits) fail(path, value, "a whole number in the range of its type");
      return value.get<T>();
    }
  }

  const RosSchema& schema_;
  CdrWriter& out_;
};

class CdrToJson {
 public:
  CdrToJson(const RosSchema& schema, CdrReader& in) : schema_(schema), in_(in) {}

  json read(std::size_t message) {
    json value = json::object();
    if (schema_.messages[message].fields.empty()) in_.read<std::uint8_t>();
    for (const RosField& field : schema_.messages[message].fields) {
      value[field.name] = read_field(field);
    }
    return value;
  }

 private:
  json read_field(const RosField& field) {
    if (field.shape == RosField::Shape::kOne) return read_one(field);
    const std::size_t count =
        field.shape == RosField::Shape::kArray ? field.length : in_.read_count(1);
    json list = json::array();
    for (std::size_t i = 0; i < count && in_.ok(); ++i) list.push_back(read_one(field));
    return list;
  }

  json read_one(const RosField& field) {
    if (field.kind == RosKind::kMessage) return read(field.message);
    if (field.kind == RosKind::kText) return std::string(in_.read_text());
    if (field.kind == RosKind::kBool) return in_.read_bool();
    json value;
    with_number_type(field.kind, [&]<class T>(T) {
      const T number = in_.read<T>();
      if constexpr (std::is_floating_point_v<T>) {
        if (!std::isfinite(number)) return;
      }
      value = number;
    });
    return value;
  }

  const RosSchema& schema_;
  CdrReader& in_;
};

}  // namespace

json parse_json(std::string_view text) {
  using Event = json::parse_event_t;
  const auto check_depth = [](int depth, Event event, json&) {
    const bool opens = event == Event::object_start || event == Event::array_start;
    if (opens && depth >= kDeepestNesting) {
      throw ConfigError(
          fmt::format("the JSON text is nested deeper than {} levels", kDeepestNesting));
    }
    return true;
  };
  return json::parse(text, check_depth, false);
}

std::vector<std::uint8_t> cdr_from_json(const json& value, const RosSchema& schema) {
  record::ByteBuffer buffer;
  CdrWriter out(buffer);
  JsonToCdr(schema, out).write(value, 0, "");
  const auto bytes = buffer.view();
  return {bytes.begin(), bytes.end()};
}

json json_from_cdr(std::span<const std::uint8_t> message, const RosSchema& schema) {
  CdrReader in(message);
  json value = CdrToJson(schema, in).read(0);
  if (!in.ok()) throw ConfigError(fmt::format("the bytes hold no {}", schema.messages[0].name));
  return value;
}

}  // namespace vinerow::live
