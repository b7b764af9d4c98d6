#include "engine/record/ros_schema.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <utility>

#include "engine/core/error.h"

namespace vinerow::record {
namespace {

struct KindName {
  std::string_view name;
  RosKind kind;
};
// byte and char are old names of uint8.
constexpr std::array kKindNames = {
    KindName{"bool", RosKind::kBool},       KindName{"int8", RosKind::kInt8},
    KindName{"uint8", RosKind::kUint8},     KindName{"byte", RosKind::kUint8},
    KindName{"char", RosKind::kUint8},      KindName{"int16", RosKind::kInt16},
    KindName{"uint16", RosKind::kUint16},   KindName{"int32", RosKind::kInt32},
    KindName{"uint32", RosKind::kUint32},   KindName{"int64", RosKind::kInt64},
    KindName{"uint64", RosKind::kUint64},   KindName{"float32", RosKind::kFloat32},
    KindName{"float64", RosKind::kFloat64}, KindName{"string", RosKind::kText},
};

std::optional<RosKind> kind_of(std::string_view name) {
  for (const KindName& known : kKindNames) {
    if (known.name == name) return known.kind;
  }
  return std::nullopt;
}

/// "geometry_msgs/Pose" for "geometry_msgs/msg/Pose".
std::string short_name(std::string_view name) {
  const std::size_t middle = name.find("/msg/");
  if (middle == std::string_view::npos) return std::string(name);
  return fmt::format("{}{}", name.substr(0, middle), name.substr(middle + 4));
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/// Removes and returns the first line.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

class SchemaParser {
 public:
  SchemaParser(std::string_view name, std::string_view text) : whole_(short_name(name)) {
    std::string current = whole_;
    while (!text.empty()) {
      const std::string_view line = trimmed(take_line(text));
      if (line.starts_with("===")) continue;
      if (line.starts_with("MSG:")) {
        current = short_name(trimmed(line.substr(4)));
        texts_[current];
      } else {
        texts_[current].push_back(line.substr(0, line.find('#')));
      }
    }
  }

  RosSchema parse() {
    add(whole_);
    return std::move(schema_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw ConfigError(fmt::format("the definition of {} {}", whole_, what));
  }

  std::size_t add(const std::string& type) {
    const auto before = places_.find(type);
    if (before != places_.end()) {
      if (!before->second.done) fail(fmt::format("has the type '{}', which holds itself", type));
      return before->second.index;
    }
    // Chosen: bounds the recursion here and in the decoder.
    constexpr int kMaxLevels = 64;
    if (levels_ == kMaxLevels) fail(fmt::format("is deeper than {} messages", kMaxLevels));
    ++levels_;
    const std::size_t index = schema_.messages.size();
    places_[type] = {index, false};
    schema_.messages.push_back({type, {}});
    std::vector<RosField> fields;
    for (const std::string_view line : texts_[type]) add_field(trimmed(line), type, fields);
    schema_.messages[index].fields = std::move(fields);
    places_[type].done = true;
    --levels_;
    return index;
  }

  void add_field(std::string_view line, const std::string& owner, std::vector<RosField>& fields) {
    if (line.empty()) return;
    const std::size_t blank = line.find_first_of(" \t");
    if (blank == std::string_view::npos) {
      fail(fmt::format("has the line '{}', must be a type and a name", line));
    }
    std::string_view type = line.substr(0, blank);
    std::string_view rest = trimmed(line.substr(blank));
    const std::size_t name_end = rest.find_first_of(" \t=");
    RosField field;
    field.name = std::string(rest.substr(0, name_end));
    if (name_end != std::string_view::npos && trimmed(rest.substr(name_end)).starts_with('=')) {
      return;  // a constant
    }
    if (type.ends_with(']')) read_shape(type, field);
    type = type.substr(0, type.find("<="));  // bounded text
    if (const std::optional<RosKind> kind = kind_of(type)) {
      field.kind = *kind;
    } else {
      field.kind = RosKind::kMessage;
      field.message = add(resolve(std::string(type), owner));
    }
    fields.push_back(std::move(field));
  }

  /// Removes "[]", "[36]" or "[<=5]" from a type's end and sets the shape.
  void read_shape(std::string_view& type, RosField& field) const {
    const std::size_t open = type.rfind('[');
    if (open == std::string_view::npos) fail(fmt::format("has the type '{}'", type));
    const std::string_view inside = type.substr(open + 1, type.size() - open - 2);
    if (inside.empty() || inside.starts_with("<=")) {
      field.shape = RosField::Shape::kSequence;
    } else {
      field.shape = RosField::Shape::kArray;
      const auto [end, error] =
          std::from_chars(inside.data(), inside.data() + inside.size(), field.length);
      if (error != std::errc() || end != inside.data() + inside.size()) {
        fail(fmt::format("has the type '{}'", type));
      }
    }
    type = type.substr(0, open);
  }

  /// A type without package is in its owner's package; a plain Header is in std_msgs.
  std::string resolve(const std::string& type, const std::string& owner) const {
    std::string name = short_name(type);
    if (name.find('/') == std::string::npos) {
      name = name == "Header" ? "std_msgs/Header"
                              : fmt::format("{}/{}", owner.substr(0, owner.find('/')), name);
    }
    if (!texts_.contains(name)) {
      fail(fmt::format("names the type '{}', which it does not hold", type));
    }
    return name;
  }

  struct Place {
    std::size_t index = 0;
    bool done = false;
  };

  std::string whole_;
  std::map<std::string, std::vector<std::string_view>> texts_;  ///< lines of each type
  std::map<std::string, Place> places_;
  int levels_ = 0;
  RosSchema schema_;
};

}  // namespace

std::size_t size_of(RosKind kind) {
  switch (kind) {
    case RosKind::kBool:
    case RosKind::kInt8:
    case RosKind::kUint8:
      return 1;
    case RosKind::kInt16:
    case RosKind::kUint16:
      return 2;
    case RosKind::kInt32:
    case RosKind::kUint32:
    case RosKind::kFloat32:
      return 4;
    case RosKind::kInt64:
    case RosKind::kUint64:
    case RosKind::kFloat64:
      return 8;
    case RosKind::kText:
    case RosKind::kMessage:
      break;
  }
  return 0;
}

RosSchema RosSchema::parse(std::string_view name, std::string_view text) {
  return SchemaParser(name, text).parse();
}

}  // namespace vinerow::record
