#include "engine/ros2/type_description.h"

#include <fmt/format.h>

#include <array>
#include <charconv>

#include "engine/core/error.h"
#include "engine/ros2/names.h"

namespace vinerow::ros2 {
namespace {

// Constants of type_description_interfaces/msg/FieldType.
constexpr int kNestedType = 1, kUint8 = 3, kText = 17, kWideText = 18;
constexpr int kBoundedText = 21, kBoundedWideText = 22;
constexpr int kArray = 48, kBoundedSequence = 96, kSequence = 144;  // added to the element's type

struct NumberType {
  std::string_view name;
  int type_id;
};
// A .msg `char` is an unsigned byte in IDL, and only `byte` is an octet.
constexpr std::array kNumberTypes = {
    NumberType{"int8", 2},     NumberType{"uint8", kUint8}, NumberType{"char", kUint8},
    NumberType{"int16", 4},    NumberType{"uint16", 5},     NumberType{"int32", 6},
    NumberType{"uint32", 7},   NumberType{"int64", 8},      NumberType{"uint64", 9},
    NumberType{"float32", 10}, NumberType{"float64", 11},   NumberType{"bool", 15},
    NumberType{"byte", 16},
};

// Every service has an event message for introspection, which is part of the service's hash.
constexpr std::string_view kEventTypes =
    "===\nMSG: service_msgs/ServiceEventInfo\n"
    "uint8 event_type\nbuiltin_interfaces/Time stamp\nchar[16] client_gid\nint64 sequence_number\n"
    "===\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// "geometry_msgs/msg/Pose" for "geometry_msgs/Pose".
std::string full_message_name(std::string_view name) {
  const std::size_t slash = name.find('/');
  if (slash == std::string_view::npos || name.find('/', slash + 1) != std::string_view::npos) {
    return std::string(name);
  }
  return fmt::format("{}/msg/{}", name.substr(0, slash), name.substr(slash + 1));
}

class DescriptionParser {
 public:
  explicit DescriptionParser(std::string_view whole) : whole_(whole) { check_type_name(whole); }

  /// Adds the fields of `text` to `type`, up to the first nested definition, then those.
  void add_all(std::string type, std::string_view text) {
    types_.try_emplace(type);
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      const std::string_view line = without_blanks(text.substr(0, end));
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      if (line.starts_with("===")) continue;
      if (line.starts_with("MSG:")) {
        type = full_message_name(without_blanks(line.substr(4)));
        check_type_name(type);
        types_[type].clear();  // a definition may be repeated: the last one counts
      } else {
        add_field(type, without_blanks(line.substr(0, line.find('#'))));
      }
    }
  }

  void add_field(const std::string& owner, FieldDescription field) {
    types_[owner].push_back(std::move(field));
  }

  TypeDescriptions finish() {
    for (auto& [name, fields] : types_) {
      // IDL has no empty struct: rosidl adds this member.
      if (fields.empty())
        fields.push_back({"structure_needs_at_least_one_member", kUint8, 0, 0, {}});
      for (const FieldDescription& field : fields) {
        if (!field.nested_type.empty() && !types_.contains(field.nested_type)) {
          fail(fmt::format("names the type '{}', which it does not hold", field.nested_type));
        }
      }
    }
    return std::move(types_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw ConfigError(fmt::format("the definition of {} {}", whole_, what));
  }

  void add_field(const std::string& owner, std::string_view line) {
    if (line.empty()) return;
    const std::size_t blank = line.find_first_of(" \t");
    if (blank == std::string_view::npos) {
      fail(fmt::format("has the line '{}', must be a type and a name", line));
    }
    const std::string_view rest = without_blanks(line.substr(blank));
    const std::size_t name_end = rest.find_first_of(" \t=");
    if (name_end != std::string_view::npos &&
        without_blanks(rest.substr(name_end)).starts_with('=')) {
      return;  // constants and default values are not part of the hash
    }
    FieldDescription field;
    field.name = std::string(rest.substr(0, name_end));
    read_type(owner, line.substr(0, blank), field);
    add_field(owner, std::move(field));
  }

  void read_type(const std::string& owner, std::string_view type, FieldDescription& field) const {
    int shape = 0;
    std::string_view element = type;
    if (type.ends_with(']')) {
      const std::size_t open = type.rfind('[');
      if (open == std::string_view::npos) fail(fmt::format("has the type '{}'", type));
      element = type.substr(0, open);
      const std::string_view inside = type.substr(open + 1, type.size() - open - 2);
      shape = inside.empty() ? kSequence : inside.starts_with("<=") ? kBoundedSequence : kArray;
      if (shape != kSequence) {
        field.capacity = read_number(type, shape == kArray ? inside : inside.substr(2));
      }
    }
    field.type_id = shape + read_element(owner, type, element, field);
  }

  int read_element(const std::string& owner, std::string_view type, std::string_view element,
                   FieldDescription& field) const {
    for (const NumberType& number : kNumberTypes) {
      if (number.name == element) return number.type_id;
    }
    if (element == "string") return kText;
    if (element == "wstring") return kWideText;
    if (const std::size_t limit = element.find("<="); limit != std::string_view::npos) {
      const std::string_view text = element.substr(0, limit);
      field.text_capacity = read_number(type, element.substr(limit + 2));
      if (text == "string") return kBoundedText;
      if (text == "wstring") return kBoundedWideText;
      fail(fmt::format("has the type '{}'", type));
    }
    field.nested_type = resolve(owner, element);
    return kNestedType;
  }

  /// A type without package is in its owner's package; a plain Header is in std_msgs.
  std::string resolve(const std::string& owner, std::string_view type) const {
    if (type.find('/') != std::string_view::npos) return full_message_name(type);
    if (type == "Header") return "std_msgs/msg/Header";
    return fmt::format("{}/msg/{}", owner.substr(0, owner.find('/')), type);
  }

  std::uint64_t read_number(std::string_view type, std::string_view digits) const {
    std::uint64_t number = 0;
    const char* const last = digits.data() + digits.size();
    const auto [end, error] = std::from_chars(digits.data(), last, number);
    if (error != std::errc() || end != last) fail(fmt::format("has the type '{}'", type));
    return number;
  }

  std::string whole_;
  TypeDescriptions types_;
};

/// Position of the line "---" in a .srv text, and of the line behind it.
std::pair<std::size_t, std::size_t> find_response(std::string_view name, std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (without_blanks(text.substr(at, end - at)) == "---") {
      return {at, std::min(end + 1, text.size())};
    }
    at = end + 1;
  }
  throw ConfigError(
      fmt::format("the definition of {} has no line '---' before its response", name));
}

}  // namespace

TypeDescriptions describe_message(std::string_view name, std::string_view text) {
  DescriptionParser parser(name);
  parser.add_all(std::string(name), text);
  return parser.finish();
}

TypeDescriptions describe_service(std::string_view name, std::string_view text) {
  const std::string service(name);
  const std::string request = service + "_Request", response = service + "_Response";
  const std::string event = service + "_Event";
  const auto [request_end, response_begin] = find_response(name, text);
  DescriptionParser parser(name);
  parser.add_all(request, text.substr(0, request_end));
  parser.add_all(response, text.substr(response_begin));
  parser.add_all(event, kEventTypes);
  parser.add_field(event, {"info", kNestedType, 0, 0, "service_msgs/msg/ServiceEventInfo"});
  parser.add_field(event, {"request", kBoundedSequence + kNestedType, 1, 0, request});
  parser.add_field(event, {"response", kBoundedSequence + kNestedType, 1, 0, response});
  parser.add_field(service, {"request_message", kNestedType, 0, 0, request});
  parser.add_field(service, {"response_message", kNestedType, 0, 0, response});
  parser.add_field(service, {"event_message", kNestedType, 0, 0, event});
  return parser.finish();
}

}  // namespace vinerow::ros2
