#include "controllers/autopilot/link/datagram_record.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"

namespace vinerow::controllers {
namespace {

// Layout of a pcap file: header of 24 bytes, then for each packet seconds, fraction, length in the
// file, length on the wire (u32 each, here little-endian) and the bytes.
constexpr std::uint32_t kNanoseconds = 0xA1B23C4D, kMicroseconds = 0xA1B2C3D4;
constexpr std::uint32_t kRawIp = 101, kEthernet = 1;  // link types
constexpr std::size_t kIpHeader = 20, kUdpHeader = 8, kEthernetHeader = 14;
constexpr std::uint32_t kMaxPacket = 65535;
constexpr std::uint8_t kUdp = 17;

class Bytes {
 public:
  Bytes& u16_le(std::uint32_t value) { return add(value, 2, false); }
  Bytes& u32_le(std::uint32_t value) { return add(value, 4, false); }
  Bytes& u8(std::uint32_t value) { return add(value, 1, true); }
  Bytes& u16_be(std::uint32_t value) { return add(value, 2, true); }
  Bytes& u32_be(std::uint32_t value) { return add(value, 4, true); }
  std::span<std::uint8_t> all() { return std::span(bytes_).first(size_); }

 private:
  Bytes& add(std::uint32_t value, int count, bool big_endian) {
    for (int i = 0; i < count; ++i) {
      const int shift = 8 * (big_endian ? count - 1 - i : i);
      bytes_[size_++] = static_cast<std::uint8_t>(value >> shift);
    }
    return *this;
  }
  std::array<std::uint8_t, 64> bytes_{};
  std::size_t size_ = 0;
};

std::uint32_t le(std::span<const std::uint8_t> bytes, std::size_t at, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i) value |= static_cast<std::uint32_t>(bytes[at + i]) << (8 * i);
  return value;
}
std::uint32_t be(std::span<const std::uint8_t> bytes, std::size_t at, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8 | bytes[at + i];
  return value;
}

/// Checksum of an IPv4 header (RFC 1071): complement of the sum of its words in ones' complement.
std::uint16_t ip_checksum(std::span<const std::uint8_t> header) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i + 1 < header.size(); i += 2) sum += be(header, i, 2);
  while (sum >> 16 != 0) sum = (sum & 0xFFFF) + (sum >> 16);
  return static_cast<std::uint16_t>(~sum);
}

}  // namespace

DatagramRecorder::DatagramRecorder(const std::filesystem::path& file)
    : path_(file.string()), file_(std::fopen(path_.c_str(), "wb")) {
  if (!file_) throw WriteError(fmt::format("{}: {}", path_, words_of_write_failure(errno)));
  Bytes header;
  header.u32_le(kNanoseconds).u16_le(2).u16_le(4).u32_le(0).u32_le(0);
  write(header.u32_le(kMaxPacket).u32_le(kRawIp).all());
}

void DatagramRecorder::write(std::span<const std::uint8_t> bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) {
    throw WriteError(fmt::format("{}: {}", path_, words_of_write_failure(errno)));
  }
}

void DatagramRecorder::add(Time time, mavlink::UdpAddress from, mavlink::UdpAddress to,
                           std::span<const std::uint8_t> bytes) {
  const auto udp_size = static_cast<std::uint32_t>(kUdpHeader + bytes.size());
  const auto size = static_cast<std::uint32_t>(kIpHeader + udp_size);
  Bytes packet;
  packet.u32_le(static_cast<std::uint32_t>(time.ns / 1'000'000'000))
      .u32_le(static_cast<std::uint32_t>(time.ns % 1'000'000'000))
      .u32_le(size)
      .u32_le(size);
  write(packet.all());

  Bytes ip;  // version 4, five words, no fragments, 64 hops
  ip.u8(0x45).u8(0).u16_be(size).u16_be(0).u16_be(0x4000).u8(64).u8(kUdp).u16_be(0);
  ip.u32_be(from.host).u32_be(to.host);
  const std::uint16_t checksum = ip_checksum(ip.all());
  ip.all()[10] = static_cast<std::uint8_t>(checksum >> 8);
  ip.all()[11] = static_cast<std::uint8_t>(checksum & 0xFF);
  // A UDP checksum of 0 means that there is none.
  write(ip.u16_be(from.port).u16_be(to.port).u16_be(udp_size).u16_be(0).all());
  write(bytes);
}

DatagramReader::DatagramReader(const std::filesystem::path& file, std::string who)
    : path_(file.string()), who_(std::move(who)), file_(std::fopen(path_.c_str(), "rb")) {
  if (!file_) refuse(std::strerror(errno));
  std::array<std::uint8_t, 24> header{};
  if (!read(header)) refuse("is too short for a pcap file");
  const std::uint32_t magic = le(header, 0, 4);
  if (magic != kNanoseconds && magic != kMicroseconds) {
    refuse("is no pcap file of little-endian form; pcapng files are not read");
  }
  has_nanoseconds_ = magic == kNanoseconds;
  const std::uint32_t link = le(header, 20, 4) & 0xFFFF;
  if (link != kRawIp && link != kEthernet) {
    refuse(fmt::format("has the link type {}; only raw IP (101) and Ethernet (1) are read", link));
  }
  link_header_ = link == kEthernet ? kEthernetHeader : 0;
}

void DatagramReader::refuse(const std::string& fault) const {
  throw ConfigError(fmt::format("{}: {}: {}", who_, path_, fault));
}

bool DatagramReader::read(std::span<std::uint8_t> bytes) {
  return std::fread(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size();
}

std::optional<RecordedDatagram> DatagramReader::next() {
  for (std::array<std::uint8_t, 16> header{}; read(header);) {
    const std::uint32_t size = le(header, 8, 4);
    if (size > 4 * kMaxPacket) refuse(fmt::format("is damaged: it has a packet of {} bytes", size));
    std::vector<std::uint8_t> packet(size);
    if (!read(packet)) return std::nullopt;
    const std::size_t ip = link_header_;
    if (packet.size() < ip + kIpHeader || packet[ip] >> 4 != 4 || packet[ip + 9] != kUdp) continue;
    const std::size_t udp = ip + 4 * static_cast<std::size_t>(packet[ip] & 0xF);
    if (packet.size() < udp + kUdpHeader) continue;
    const std::size_t length = be(packet, udp + 4, 2);
    if (length < kUdpHeader || packet.size() < udp + length) continue;
    RecordedDatagram datagram;
    const std::int64_t fraction_ns =
        static_cast<std::int64_t>(le(header, 4, 4)) * (has_nanoseconds_ ? 1 : 1000);
    datagram.time.ns = static_cast<std::int64_t>(le(header, 0, 4)) * 1'000'000'000 + fraction_ns;
    datagram.from = {be(packet, ip + 12, 4), static_cast<std::uint16_t>(be(packet, udp, 2))};
    datagram.to = {be(packet, ip + 16, 4), static_cast<std::uint16_t>(be(packet, udp + 2, 2))};
    const auto begin = packet.begin() + static_cast<std::ptrdiff_t>(udp + kUdpHeader);
    datagram.bytes.assign(begin, begin + static_cast<std::ptrdiff_t>(length - kUdpHeader));
    return datagram;
  }
  return std::nullopt;
}

}  // namespace vinerow::controllers
