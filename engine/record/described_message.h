#pragma once
/// Encoding, ROS 2 definition and decoding of messages from their field lists, for the vinerow_msgs
/// types and for messages of plug-ins.
///
/// A message starts with a std_msgs/Header, followed by the fields in order. A Pose with
/// `relative_to_body` is stored as two: "body", and its pose relative to the body.

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

/// Visitable fields of one message.
class MessageFields {
 public:
  virtual ~MessageFields() = default;
  virtual void visit(FieldVisitor& visitor) const = 0;
};

/// Fields of a message of type T. The message must outlive this object.
template <class T>
class FieldsOf final : public MessageFields {
 public:
  explicit FieldsOf(const T& message) : message_(message) {}
  void visit(FieldVisitor& visitor) const override { visit_fields(message_, visitor); }

 private:
  const T& message_;
};

/// Order of a message's fields in logs; empty: the listed order.
using LogOrder = std::span<const std::string_view>;

/// Appends header and fields. Allocates only in the buffer.
/// @pre at most 32 fields if `order` is not empty
void write_described(CdrWriter& out, const WriteContext& to, MessageFrame frame, LogOrder order,
                     const MessageFields& message);

/// "vinerow_msgs/msg/SoilSample" for "SoilSample", "acme/msg/SoilSample" for "acme/SoilSample".
std::string ros_type_of(std::string_view message_type);

/// The .msg text with all nested messages, as MCAP stores it (encoding "ros2msg").
/// @param ros_type  "vinerow_msgs/msg/SoilSample": nested messages have the same package
std::string described_definition(std::string_view ros_type, LogOrder order,
                                 const MessageFields& message);

/// Reads a sensor's pose from the body's pose and the relative pose.
void read_pose_in_body(CdrReader& in, Pose& X_WS);

/// Minimum size of one value in a message, in bytes. It bounds the count of a damaged sequence.
template <class T>
std::size_t min_size() {
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
    // A lower bound: padding is not included.
    std::size_t size = 0;
    const T fresh{};
    T::fields(fresh, [&]<class Field>(const FieldInfo&, const Field&) {
      if constexpr (Number<Field> || std::is_same_v<Field, Eigen::Vector3d>) {
        size += min_size<Field>();
      }
    });
    return size > 0 ? size : 1;
  }
}

/// Visitor that reads fields in visiting order.
struct ReadField {
  CdrReader& in;
  bool& good;  ///< set to false for a value that is not in its enumeration

  template <class T>
  void operator()(const FieldInfo& info, T& value) const {
    if constexpr (std::is_same_v<T, Pose>) {
      if (info.relative_to_body) return read_pose_in_body(in, value);
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
    values.resize(in.read_count(min_size<T>()));
    if constexpr (std::is_same_v<T, double>) {
      in.read_doubles(values.data(), values.size());
    } else if constexpr (std::is_same_v<T, std::uint8_t>) {
      in.read_octets(values.data(), values.size());
    } else {
      for (T& value : values) read(value);
    }
  }
};

/// Reads a message of write_described(). @returns false if the bytes do not hold such a message
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
