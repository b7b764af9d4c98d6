#pragma once
/// Layout of MAVLink messages. A message is a struct that lists its fields in the order of its XML
/// definition; bytes, length and check byte follow from that list.
///
/// On the wire, fields are sorted by the size of their elements, largest first; fields of one size
/// keep their order. Extension fields follow unsorted. All numbers are little-endian.
/// Source: MAVLink's guide, "Serialization".

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "engine/mavlink/crc.h"

namespace vinerow::mavlink {

static_assert(std::endian::native == std::endian::little);

/// A field as the definition names it.
struct Field {
  const char* name;
  bool extension = false;
};

/// Longest payload of a frame, bytes.
inline constexpr std::size_t kMaxPayload = 255;

namespace detail {

template <class T>
struct Elements {
  using Type = T;
  static constexpr std::size_t kCount = 1;
  static constexpr bool kIsArray = false;
};
template <class T, std::size_t N>
struct Elements<std::array<T, N>> {
  using Type = T;
  static constexpr std::size_t kCount = N;
  static constexpr bool kIsArray = true;
};

template <class T>
constexpr const char* type_name() {
  if constexpr (std::same_as<T, char>) return "char";
  if constexpr (std::same_as<T, std::int8_t>) return "int8_t";
  if constexpr (std::same_as<T, std::uint8_t>) return "uint8_t";
  if constexpr (std::same_as<T, std::int16_t>) return "int16_t";
  if constexpr (std::same_as<T, std::uint16_t>) return "uint16_t";
  if constexpr (std::same_as<T, std::int32_t>) return "int32_t";
  if constexpr (std::same_as<T, std::uint32_t>) return "uint32_t";
  if constexpr (std::same_as<T, std::int64_t>) return "int64_t";
  if constexpr (std::same_as<T, std::uint64_t>) return "uint64_t";
  if constexpr (std::same_as<T, float>) return "float";
  if constexpr (std::same_as<T, double>) return "double";
}

}  // namespace detail

/// Calls visit(Field, value) for each field in the order of the wire.
template <class Self, class Visit>
constexpr void for_each_on_wire(Self& message, Visit&& visit) {
  for (const std::size_t size : {8, 4, 2, 1}) {
    message.fields(message, [&]<class T>(Field field, T& value) {
      using Element = typename detail::Elements<std::remove_const_t<T>>::Type;
      if (!field.extension && sizeof(Element) == size) visit(field, value);
    });
  }
  message.fields(message, [&]<class T>(Field field, T& value) {
    if (field.extension) visit(field, value);
  });
}

/// Longest payload of a message, with its extensions, bytes.
template <class M>
constexpr std::size_t payload_size() {
  M message{};
  std::size_t size = 0;
  for_each_on_wire(message, [&]<class T>(Field, T&) { size += sizeof(T); });
  return size;
}

/// Check byte of a message's layout (CRC_EXTRA), which ends the CRC of its frames: a peer with
/// another definition refuses them.
template <class M>
constexpr std::uint8_t crc_extra() {
  M message{};
  Crc16 crc;
  crc.add(std::string_view(M::kName));
  crc.add(' ');
  for_each_on_wire(message, [&]<class T>(Field field, T&) {
    if (field.extension) return;
    using Elements = detail::Elements<T>;
    crc.add(std::string_view(detail::type_name<typename Elements::Type>()));
    crc.add(' ');
    crc.add(std::string_view(field.name));
    crc.add(' ');
    if (Elements::kIsArray) crc.add(static_cast<std::uint8_t>(Elements::kCount));
  });
  return static_cast<std::uint8_t>((crc.value() & 0xFF) ^ (crc.value() >> 8));
}

/// @param payload  at least payload_size<M>() bytes
/// @returns bytes that have to be sent: without zeros at the end, but at least one
template <class M>
std::size_t write_payload(const M& message, std::span<std::uint8_t> payload) {
  std::size_t at = 0;
  for_each_on_wire(message, [&]<class T>(Field, T& value) {
    std::memcpy(payload.data() + at, &value, sizeof(T));
    at += sizeof(T);
  });
  while (at > 1 && payload[at - 1] == 0) --at;
  return at;
}

/// Bytes that are missing are zeros; bytes beyond the message are of a newer definition and
/// ignored.
template <class M>
void read_payload(std::span<const std::uint8_t> payload, M& message) {
  std::size_t at = 0;
  for_each_on_wire(message, [&]<class T>(Field, T& value) {
    std::array<std::uint8_t, sizeof(T)> bytes{};
    for (std::size_t i = 0; i < sizeof(T) && at + i < payload.size(); ++i) {
      bytes[i] = payload[at + i];
    }
    std::memcpy(&value, bytes.data(), sizeof(T));
    at += sizeof(T);
  });
}

/// Text of a field of characters, which ends at the first zero.
template <std::size_t N>
std::string_view text_of(const std::array<char, N>& field) {
  const std::string_view all(field.data(), N);
  return all.substr(0, all.find('\0'));
}

/// Fills a field of characters. @returns what did not fit
template <std::size_t N>
std::string_view set_text(std::array<char, N>& field, std::string_view text) {
  field.fill('\0');
  const std::string_view taken = text.substr(0, N);
  taken.copy(field.data(), N);
  return text.substr(taken.size());
}

}  // namespace vinerow::mavlink
