#pragma once
/// Field lists of messages. A message is a plain struct with
///
///   static constexpr const char* kType = "SoilSample";
///   template <class Self, class F>
///   static void fields(Self& self, F&& f) {
///     f({"moisture", "", "share of the pores that hold water"}, self.moisture);
///     f({"temperature", "K"}, self.temperature_K);
///   }
///
/// Everything generic derives from this list: the digest, the search for NaN, the bytes and
/// definition in logs, the log reader, and the views for viewers and scripts (message.h,
/// engine/record). A plug-in defines its own messages in the same way. The kType "acme/SoilSample"
/// puts the type into a ROS package `acme` in logs, a plain name into vinerow_msgs.
///
/// Fields may be: bool, integers, float, double, enumerations with enum_names(), std::string,
/// Eigen::Vector3d, Eigen::Quaterniond, Pose, structs with `kType` and `fields`, and std::array or
/// std::vector of these (except a vector of bool).

#include <concepts>
#include <cstdint>
#include <span>
#include <string_view>

namespace vinerow {

/// Metadata of a field.
struct FieldInfo {
  /// Name in logs, plots and scripts. Unique in the message, in the spelling of ROS 2: lower-case
  /// letters, digits, single underscores.
  std::string_view name;
  std::string_view unit = {};   ///< "m", "rad/s"; "" for dimensionless numbers and non-numbers
  std::string_view words = {};  ///< for people, if name and unit do not explain the field
  /// For a Pose in W that is fixed to the vehicle: logs contain the pose of the body and this pose
  /// relative to it.
  bool relative_to_body = false;
};

/// One value of an enumeration. `std::span<const EnumName> enum_names(E)` next to the enumeration
/// lists all of them; logs reject other values.
struct EnumName {
  std::int64_t value = 0;
  std::string_view name;  ///< upper case, as constants of ROS 2 messages: "TAKE_OFF"
};

template <class E>
constexpr EnumName enum_name(E value, std::string_view name) {
  return {static_cast<std::int64_t>(value), name};
}

/// Frame in the header of a logged message.
enum class MessageFrame : std::uint8_t {
  kBody,   ///< of the vehicle, "rover/base_link"
  kWorld,  ///< "map"
  kOwn     ///< of the signal itself, "rover/gps"
};

/// Placeholder visitor for the check that a field list exists.
struct AnyField {
  template <class T>
  void operator()(const FieldInfo&, T&) const {}
};

/// A type with a field list.
template <class T>
concept HasFields = requires(T& value) {
  { T::kType } -> std::convertible_to<std::string_view>;
  T::fields(value, AnyField{});
};

/// The message's `kFrame`, by default the vehicle's body.
template <class T>
constexpr MessageFrame frame_of() {
  if constexpr (requires { T::kFrame; }) {
    return T::kFrame;
  } else {
    return MessageFrame::kBody;
  }
}

}  // namespace vinerow
