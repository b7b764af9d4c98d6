#pragma once
/// Messages by the fields that they list: their bytes in a log, their ROS 2 definition, and reading
/// them back. Serves our vinerow_msgs types and what plug-ins bring.
///
/// A message begins with a std_msgs/Header; then come the fields in order. A Pose that is
/// `beside_body` is two: "body", and its own in the body.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/api/message.h"
#include "engine/record/cdr.h"
#include "engine/record/ros_fields.h"
#include "engine/record/write_context.h"

namespace vinerow::record {

/// Shows the fields of one message to a visitor.
class MessageFields {
 public:
  virtual ~MessageFields() = default;
  virtual void visit(FieldVisitor& visitor) const = 0;
};

/// @tparam T  a message, which must live as long as this
template <class T>
class FieldsOf final : public MessageFields {
 public:
  explicit FieldsOf(const T& message) : message_(message) {}
  void visit(FieldVisitor& visitor) const override { visit_fields(message_, visitor); }

 private:
  const T& message_;
};

/// Order of a message's fields in logs; empty: as they are listed.
using LogOrder = std::span<const std::string_view>;

/// Appends header and fields. No heap but the buffer's.
/// @pre at most 32 fields where there is an order
void write_described(CdrWriter& out, const WriteContext& to, MessageFrame frame, LogOrder order,
                     const MessageFields& message);

/// "vinerow_msgs/msg/SoilSample" of "SoilSample", "acme/msg/SoilSample" of "acme/SoilSample".
std::string ros_type_of(std::string_view message_type);

/// The .msg text with every message inside it, as MCAP stores it (encoding "ros2msg").
/// @param ros_type  "vinerow_msgs/msg/SoilSample": its package is that of messages inside too
std::string described_definition(std::string_view ros_type, LogOrder order,
                                 const MessageFields& message);

/// A sensor's pose from the body's and its own in the body.
void read_pose_beside_body(CdrReader& in, Pose& X_WS);

/// Least bytes of one value in a message: bounds the count that a damaged sequence claims.
template <class T>
std::size_t least_size() {
  if constexpr (Number<T>) {
    return sizeof(T);
  } else if constexpr (std::is_same_v<T, Eigen::Vector3d>) {
    return 3 * sizeof(double);
  } else if constexpr (std::is_same_v<T, Eigen::Quaterniond>) {
    return 4 * sizeof(double);
  } else if constexpr (std::is_same_v<T, Pose>) {
    return 7 * sizeof(double);
  } else if constexpr (std::is_same_v<T, std::string>) {
    return sizeof(std::uint32_t);
  } else {
    // Paddings come on top of it.
    std::size_t size = 0;
    const T fresh{};
    T::fields(fresh, [&]<class Field>(const FieldInfo&, const Field&) {
      if constexpr (Number<Field> || std::is_same_v<Field, Eigen::Vector3d>) {
        size += least_size<Field>();
      }
    });
    return size > 0 ? size : 1;
  }
}

/// Reads fields in the order in which they are shown.
struct ReadField {
  CdrReader& in;
  bool& good;  ///< false: a value that its enumeration does not have

  template <class T>
  void operator()(const FieldInfo& info, T& value) const {
    if constexpr (std::is_same_v<T, Pose>) {
      if (info.beside_body) return read_pose_beside_body(in, value);
    }
    read(value);
  }

 private:
  template <Number T>
  void read(T& value) const {
    if constexpr (std::is_same_v<T, bool>) {
      value = in.read_bool();
    } else if constexpr (std::is_enum_v<T>) {
      const auto number = in.read<std::underlying_type_t<T>>();
      bool known = false;
      for (const EnumName& name : enum_names(T{})) {
        known = known || name.value == static_cast<std::int64_t>(number);
      }
      if (!known) {
        good = false;
        return;
      }
      value = static_cast<T>(number);
    } else {
      value = in.read<T>();
    }
  }
  void read(std::string& text) const { in.read(text); }
  void read(Eigen::Vector3d& v) const { in.read(v); }
  void read(Eigen::Quaterniond& q) const { in.read_doubles(q.coeffs().data(), 4); }
  void read(Pose& pose) const { read_pose(in, pose); }
  template <HasFields T>
  void read(T& record) const {
    T::fields(record, *this);
  }
  template <class T, std::size_t kCount>
  void read(std::array<T, kCount>& values) const {
    for (T& value : values) read(value);
  }
  template <class T>
  void read(std::vector<T>& values) const {
    values.resize(in.read_count(least_size<T>()));
    if constexpr (std::is_same_v<T, double>) {
      in.read_doubles(values.data(), values.size());
    } else if constexpr (std::is_same_v<T, std::uint8_t>) {
      in.read_octets(values.data(), values.size());
    } else {
      for (T& value : values) read(value);
    }
  }
};

/// Reads what write_described() wrote. @returns false if the bytes do not hold such a message
template <HasFields T>
bool read_described(CdrReader& in, LogOrder order, T& value) {
  skip_header(in);
  bool good = true;
  const ReadField read{in, good};
  if (order.empty()) {
    T::fields(value, read);
  } else {
    for (const std::string_view name : order) {
      T::fields(value, [&]<class Field>(const FieldInfo& info, Field& field) {
        if (info.name == name) read(info, field);
      });
    }
  }
  if constexpr (requires { value.valid(); }) good = good && value.valid();
  return good && in.ok();
}

}  // namespace vinerow::record
