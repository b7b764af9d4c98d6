#pragma once
/// How a message names its fields. A message is a plain struct with
///
///   static constexpr const char* kType = "SoilSample";
///   template <class Self, class F>
///   static void fields(Self& self, F&& f) {
///     f({"moisture", "", "share of the pores that hold water"}, self.moisture);
///     f({"temperature", "K"}, self.temperature_K);
///   }
///
/// and from that list come its digest, the search for NaN, its bytes and definition in logs, their
/// reader, and the views that viewers and scripts take (message.h, engine/record). A plug-in brings
/// messages of its own the same way; "acme/SoilSample" as kType puts the type into a ROS package
/// `acme` in logs, a plain name into vinerow_msgs.
///
/// Fields may be: bool, integers, float, double, enumerations with enum_names(), std::string,
/// Eigen::Vector3d, Eigen::Quaterniond, Pose, structs with `kType` and `fields`, and std::array or
/// std::vector of these (no vector of bool).

#include <concepts>
#include <cstdint>
#include <span>
#include <string_view>

namespace vinerow {

/// What is said of a field beside its value.
struct FieldInfo {
  /// Unique in the message, in the spelling of ROS 2 (lower-case letters, digits, single
  /// underscores): what logs, plots and scripts call it.
  std::string_view name;
  std::string_view unit = {};   ///< "m", "rad/s"; "" for numbers without one and what is no number
  std::string_view words = {};  ///< for people, where name and unit do not say it all
  /// Of a Pose in W that moves with the vehicle: logs hold the body's pose and this one in the body.
  bool beside_body = false;
};

/// One value of an enumeration. `std::span<const EnumName> enum_names(E)` beside the enumeration
/// lists them all; logs refuse others.
struct EnumName {
  std::int64_t value = 0;
  std::string_view name;  ///< upper case, as constants of ROS 2 messages: "TAKE_OFF"
};

template <class E>
constexpr EnumName enum_name(E value, std::string_view name) {
  return {static_cast<std::int64_t>(value), name};
}

/// Frame that the header of a message names in logs.
enum class MessageFrame : std::uint8_t {
  kBody,   ///< the vehicle's, "rover/base_link"
  kWorld,  ///< "map"
  kOwn     ///< of the signal: "rover/gps"
};

/// Stands for any visitor of fields where only the list's existence is asked for.
struct AnyField {
  template <class T>
  void operator()(const FieldInfo&, T&) const {}
};

/// Something that lists fields.
template <class T>
concept HasFields = requires(T& value) {
  { T::kType } -> std::convertible_to<std::string_view>;
  T::fields(value, AnyField{});
};

/// The frame that a message names as `kFrame`, else the vehicle's body.
template <class T>
constexpr MessageFrame frame_of() {
  if constexpr (requires { T::kFrame; }) {
    return T::kFrame;
  } else {
    return MessageFrame::kBody;
  }
}

}  // namespace vinerow
