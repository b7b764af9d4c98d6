#pragma once
/// Generic functions on messages, derived from their field lists (field.h): digest, search for NaN,
/// layout, and views by name.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/api/field.h"
#include "engine/core/hash.h"
#include "engine/math/pose.h"

namespace vinerow {

template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Adds every field to a digest: numbers by their bytes; texts with their length; vectors of
/// numbers or texts with their count; other vectors by their elements alone.
struct HashField {
  Hasher& hasher;

  template <class T>
  void operator()(const FieldInfo&, const T& value) const {
    add(value);
  }

 private:
  template <Number T>
  void add(const T& value) const {
    hasher.add(value);
  }
  void add(const std::string& text) const { hasher.add(std::string_view(text)); }
  void add(const Eigen::Vector3d& v) const { hasher.add_bytes(v.data(), sizeof(double) * 3); }
  void add(const Eigen::Quaterniond& q) const {
    hasher.add_bytes(q.coeffs().data(), sizeof(double) * 4);
  }
  void add(const Pose& pose) const {
    add(pose.p);
    add(pose.q);
  }
  template <HasFields T>
  void add(const T& record) const {
    T::fields(record, *this);
  }
  template <class T, std::size_t kCount>
  void add(const std::array<T, kCount>& values) const {
    for (const T& value : values) add(value);
  }
  template <class T>
  void add(const std::vector<T>& values) const {
    static_assert(!std::is_same_v<T, bool>, "a vector of bool has no bytes to show");
    if constexpr (Number<T>) {
      hasher.add(static_cast<std::uint64_t>(values.size()));
      hasher.add_bytes(values.data(), values.size() * sizeof(T));
    } else {
      if constexpr (std::is_same_v<T, std::string>) {
        hasher.add(static_cast<std::uint64_t>(values.size()));
      }
      for (const T& value : values) add(value);
    }
  }
};

/// Finds NaN. Infinity is allowed.
struct NanField {
  bool& found;

  template <class T>
  void operator()(const FieldInfo&, const T& value) const {
    if (!found) found = is_nan(value);
  }

 private:
  template <Number T>
  static bool is_nan(const T& value) {
    if constexpr (std::is_floating_point_v<T>) return std::isnan(value);
    return false;
  }
  static bool is_nan(const std::string&) { return false; }
  static bool is_nan(const Eigen::Vector3d& v) { return v.array().isNaN().any(); }
  static bool is_nan(const Eigen::Quaterniond& q) { return q.coeffs().array().isNaN().any(); }
  static bool is_nan(const Pose& pose) { return is_nan(pose.p) || is_nan(pose.q); }
  template <HasFields T>
  static bool is_nan(const T& record) {
    bool found = false;
    T::fields(record, NanField{found});
    return found;
  }
  template <class T, std::size_t kCount>
  static bool is_nan(const std::array<T, kCount>& values) {
    return is_any_nan(values);
  }
  template <class T>
  static bool is_nan(const std::vector<T>& values) {
    return is_any_nan(values);
  }
  template <class Values>
  static bool is_any_nan(const Values& values) {
    for (const auto& value : values) {
      if (is_nan(value)) return true;
    }
    return false;
  }
};

template <HasFields T>
void hash_fields(const T& message, Hasher& hasher) {
  T::fields(message, HashField{hasher});
}

template <HasFields T>
bool has_nan_field(const T& message) {
  bool found = false;
  T::fields(message, NanField{found});
  return found;
}

/// Type of one value of a field.
enum class FieldKind : std::uint8_t {
  kBool,
  kInt8,
  kInt16,
  kInt32,
  kInt64,
  kUint8,
  kUint16,
  kUint32,
  kUint64,
  kFloat32,
  kFloat64,
  kText,        ///< std::string
  kVector3,     ///< Eigen::Vector3d
  kQuaternion,  ///< Eigen::Quaterniond
  kPose,        ///< Pose
  kRecord       ///< a struct that lists fields
};

enum class FieldShape : std::uint8_t { kSingle, kArray, kSequence };

class FieldVisitor;

/// View of a field: its type and the address of its values. Nothing is copied. Valid until the
/// message changes; for a signal, until its next write.
struct FieldView {
  FieldInfo info;
  FieldKind kind = FieldKind::kFloat64;
  FieldShape shape = FieldShape::kSingle;
  std::size_t count = 1;              ///< of values
  const void* data = nullptr;         ///< the first value; null if there are no values
  std::size_t stride = 0;             ///< bytes from one value to the next
  std::span<const EnumName> names{};  ///< of an enumeration, else empty
  std::string_view record{};          ///< kType of a kRecord
  /// Visits the fields of one value of a kRecord. Null stands for a default value, for visitors
  /// that need only names and types.
  void (*visit_record)(const void* value, FieldVisitor& visitor) = nullptr;

  /// @tparam T  the C++ type for `kind` (for an enumeration its integer type)
  template <class T>
  const T& value(std::size_t index = 0) const {
    return *static_cast<const T*>(at(index));
  }
  const void* at(std::size_t index) const {
    return static_cast<const std::byte*>(data) + index * stride;
  }
};

/// Visitor of the fields of a message, called once for each field.
class FieldVisitor {
 public:
  virtual ~FieldVisitor() = default;
  virtual void field(const FieldView& view) = 0;
};

/// FieldKind of a C++ type.
template <class T>
constexpr FieldKind field_kind() {
  if constexpr (std::is_enum_v<T>) {
    return field_kind<std::underlying_type_t<T>>();
  } else if constexpr (std::is_same_v<T, bool>) {
    return FieldKind::kBool;
  } else if constexpr (std::is_integral_v<T>) {
    constexpr FieldKind kSigned[] = {FieldKind::kInt8, FieldKind::kInt16, FieldKind::kInt32,
                                     FieldKind::kInt64};
    constexpr FieldKind kUnsigned[] = {FieldKind::kUint8, FieldKind::kUint16, FieldKind::kUint32,
                                       FieldKind::kUint64};
    constexpr int kSize = sizeof(T) == 1 ? 0 : sizeof(T) == 2 ? 1 : sizeof(T) == 4 ? 2 : 3;
    return std::is_signed_v<T> ? kSigned[kSize] : kUnsigned[kSize];
  } else if constexpr (std::is_same_v<T, float>) {
    return FieldKind::kFloat32;
  } else if constexpr (std::is_same_v<T, double>) {
    return FieldKind::kFloat64;
  } else if constexpr (std::is_same_v<T, std::string>) {
    return FieldKind::kText;
  } else if constexpr (std::is_same_v<T, Eigen::Vector3d>) {
    return FieldKind::kVector3;
  } else if constexpr (std::is_same_v<T, Eigen::Quaterniond>) {
    return FieldKind::kQuaternion;
  } else if constexpr (std::is_same_v<T, Pose>) {
    return FieldKind::kPose;
  } else {
    static_assert(HasFields<T>, "a message cannot have a field of this type: see field.h");
    return FieldKind::kRecord;
  }
}

/// Makes a FieldView of every field and passes it to a visitor.
struct ViewField {
  FieldVisitor& visitor;

  template <class T>
  void operator()(const FieldInfo& info, const T& value) const {
    show<T>(info, FieldShape::kSingle, &value, 1);
  }
  template <class T, std::size_t kCount>
  void operator()(const FieldInfo& info, const std::array<T, kCount>& values) const {
    show<T>(info, FieldShape::kArray, values.data(), kCount);
  }
  template <class T>
  void operator()(const FieldInfo& info, const std::vector<T>& values) const {
    show<T>(info, FieldShape::kSequence, values.empty() ? nullptr : values.data(), values.size());
  }

 private:
  template <class T>
  void show(const FieldInfo& info, FieldShape shape, const T* first, std::size_t count) const {
    FieldView view{.info = info,
                   .kind = field_kind<T>(),
                   .shape = shape,
                   .count = count,
                   .data = first,
                   .stride = sizeof(T)};
    if constexpr (std::is_enum_v<T>) view.names = enum_names(T{});
    if constexpr (field_kind<T>() == FieldKind::kRecord) {
      view.record = T::kType;
      view.visit_record = [](const void* value, FieldVisitor& inner) {
        static const T fresh{};
        T::fields(value ? *static_cast<const T*>(value) : fresh, ViewField{inner});
      };
    }
    visitor.field(view);
  }
};

/// Visits every field of a message. No heap.
template <HasFields T>
void visit_fields(const T& message, FieldVisitor& visitor) {
  T::fields(message, ViewField{visitor});
}

/// Writes the layout of a message as text: names, units, types and offsets of its fields.
struct LayoutField {
  std::string& text;
  const void* first_byte;  ///< of the message

  template <class T>
  void operator()(const FieldInfo& info, const T& value) const {
    const auto offset = reinterpret_cast<const std::byte*>(&value) -
                        static_cast<const std::byte*>(first_byte);
    text.append(info.name).append(" [").append(info.unit).append("] at ");
    text.append(std::to_string(offset)).append(": ");
    add_type(value);
    text += '\n';
  }

 private:
  template <class T>
  void add_type(const T& value) const {
    text.append(std::to_string(static_cast<int>(field_kind<T>()))).append("/");
    text.append(std::to_string(sizeof(T)));
    if constexpr (field_kind<T>() == FieldKind::kRecord) {
      text += "{\n";
      T::fields(value, LayoutField{text, &value});
      text += "}";
    }
  }
  template <class T, std::size_t kCount>
  void add_type(const std::array<T, kCount>&) const {
    text.append("array of ").append(std::to_string(kCount)).append(" ");
    add_type(T{});
  }
  template <class T>
  void add_type(const std::vector<T>&) const {
    text += "vector of ";
    add_type(T{});
  }
};

/// Run-time type of a message.
struct MessageType {
  const char* name = "";     ///< kType
  std::uint64_t layout = 0;  ///< hash of fields, offsets, size and alignment
  MessageFrame frame = MessageFrame::kBody;
};

template <HasFields T>
const MessageType& message_type() {
  static const MessageType type = [] {
    const T fresh{};
    std::string text(T::kType);
    text.append(" ").append(std::to_string(sizeof(T))).append(" aligned to ");
    text.append(std::to_string(alignof(T))).append("\n");
    T::fields(fresh, LayoutField{text, &fresh});
    return MessageType{T::kType, hash64(text), frame_of<T>()};
  }();
  return type;
}

}  // namespace vinerow
