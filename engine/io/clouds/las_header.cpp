#include "engine/io/clouds/las_header.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "engine/io/clouds/las_crs.h"
#include "engine/io/clouds/point_cloud_scalar.h"

namespace vinerow::io {
namespace {

constexpr std::array<std::size_t, 11> kPointBytes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

/// Text of fixed length up to its first NUL.
std::string text_of(const std::uint8_t* bytes, std::size_t count) {
  std::string text(reinterpret_cast<const char*>(bytes), count);
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

[[noreturn]] void fail_compressed(const BlockFile& file) {
  file.fail(
      "is compressed (LAZ), which is not supported; Debian 12 has no program for it, Python's "
      "laspy "
      "has: "
      "pip install 'laspy[lazrs]', then python3 -c \"import laspy; "
      "laspy.read('in.laz').write('out.las')\"");
}

/// Minimum header size of LAS 1.2, 1.3, 1.4.
std::size_t header_bytes(int minor) {
  return minor == 2 ? 227 : minor == 3 ? 235 : 375;
}

struct Records {
  std::uint32_t count = 0;
  std::uint64_t at = 0;
  std::uint64_t end = 0;
  bool extended = false;
};

/// Reads the (extended) variable length records.
void read_records(BlockFile& file, const Records& records, LasCrs& crs) {
  const std::size_t head_bytes = records.extended ? 60 : 54;
  std::uint64_t at = records.at;
  for (std::uint32_t k = 0; k < records.count; ++k) {
    file.seek(at);
    const std::uint64_t left = records.end - at;
    const std::uint8_t* head = left < head_bytes ? nullptr : file.take(head_bytes);
    std::uint64_t bytes = 0;
    if (head != nullptr) {
      bytes = records.extended ? load<std::uint64_t>(head + 20) : load<std::uint16_t>(head + 20);
    }
    if (head == nullptr || bytes > left - head_bytes) {
      file.fail(fmt::format(
          "counts {} {} in its header, but holds {}", records.count,
          records.extended ? "extended variable length records" : "variable length records", k));
    }
    const std::string user = text_of(head + 2, 16);
    const int id = load<std::uint16_t>(head + 18);
    if (user == "laszip encoded") fail_compressed(file);
    if (user == "LASF_Projection") crs.read(file, id, bytes);
    at += head_bytes + bytes;
  }
}

void read_las_count(const BlockFile& file, const std::uint8_t* head, LasHeader& header) {
  const std::uint32_t legacy = load<std::uint32_t>(head + 107);
  header.point_count = legacy;
  if (header.minor < 4) return;
  header.point_count = load<std::uint64_t>(head + 247);
  if (legacy != 0 && header.point_count == 0) header.point_count = legacy;
  if (legacy != 0 && legacy != header.point_count) {
    file.fail(fmt::format("has a broken header: it counts {} points in 32 bits, {} in 64", legacy,
                          header.point_count));
  }
}

void read_grid(const BlockFile& file, const std::uint8_t* head, LasHeader& header) {
  Eigen::Vector3d lower, upper;
  for (int k = 0; k < 3; ++k) {
    header.scale[k] = load<double>(head + 131 + 8 * k);
    header.offset[k] = load<double>(head + 155 + 8 * k);
    upper[k] = load<double>(head + 179 + 16 * k);
    lower[k] = load<double>(head + 187 + 16 * k);
    if (!std::isfinite(header.scale[k]) || header.scale[k] == 0.0 ||
        !std::isfinite(header.offset[k])) {
      file.fail(
          fmt::format("has a broken header: scale {} and offset {} along {}, must be finite "
                      "and the scale not 0",
                      header.scale[k], header.offset[k], "xyz"[k]));
    }
  }
  if (lower.allFinite() && upper.allFinite() && (lower.array() <= upper.array()).all()) {
    header.bounds = Eigen::AlignedBox3d(lower, upper);
  }
}

/// Checks that the file has exactly the counted points.
void check_count(const BlockFile& file, const LasHeader& header) {
  const std::uint64_t held =
      (header.points_end - std::min(header.points_end, header.points_at)) / header.record_bytes;
  if (held < header.point_count) {
    file.fail(fmt::format("is cut off: its header counts {} points, it holds {}",
                          header.point_count, held));
  }
  if (held > header.point_count) {
    file.fail(fmt::format("has more data than its header counts: {} points, it holds {}",
                          header.point_count, held));
  }
  // A surplus byte in the middle would shift all later points.
  const std::uint64_t rest = header.points_end - header.points_at - held * header.record_bytes;
  if (header.points_end == file.size() && rest > 0) {
    file.fail(fmt::format("is damaged: {} points are followed by {} bytes, less than one point",
                          header.point_count, rest));
  }
}

}  // namespace

std::size_t las_point_bytes(int format) {
  return kPointBytes[static_cast<std::size_t>(format)];
}

std::optional<std::size_t> las_colour_at(int format) {
  if (format == 2) return 20;
  if (format == 3 || format == 5) return 28;
  if (format == 7 || format == 8 || format == 10) return 30;
  return std::nullopt;
}

LasHeader read_las_header(BlockFile& file) {
  LasHeader header;
  const std::string begin = file.peek(header_bytes(4));
  const auto* head = reinterpret_cast<const std::uint8_t*>(begin.data());
  const auto demand = [&](std::size_t bytes) {
    if (begin.size() < bytes) {
      file.fail(
          fmt::format("is cut off: its header is {} bytes, it holds {}", bytes, begin.size()));
    }
  };
  demand(header_bytes(2));
  const int major = head[24];
  header.minor = head[25];
  if (major != 1 || header.minor < 2 || header.minor > 4) {
    file.fail(fmt::format("is LAS {}.{}, must be 1.2, 1.3 or 1.4", major, header.minor));
  }
  demand(header_bytes(header.minor));
  const std::size_t own_bytes = load<std::uint16_t>(head + 94);
  header.points_at = load<std::uint32_t>(head + 96);
  if (own_bytes < header_bytes(header.minor)) {
    file.fail(fmt::format("has a broken header: {} bytes long, LAS 1.{} has at least {}", own_bytes,
                          header.minor, header_bytes(header.minor)));
  }
  if (header.points_at < own_bytes) {
    file.fail(
        fmt::format("has a broken header: its points begin at byte {}, inside its header of "
                    "{} bytes",
                    header.points_at, own_bytes));
  }
  // LASzip marks compressed points by the highest bits of the format.
  if (head[104] & 0xc0) fail_compressed(file);
  header.point_format = head[104];
  const int max_format = header.minor == 2 ? 3 : header.minor == 3 ? 5 : 10;
  if (header.point_format > max_format) {
    file.fail(fmt::format("has points of format {}, LAS 1.{} has 0 to {}", header.point_format,
                          header.minor, max_format));
  }
  header.record_bytes = load<std::uint16_t>(head + 105);
  if (header.record_bytes < las_point_bytes(header.point_format)) {
    file.fail(fmt::format("has points of {} bytes, format {} has at least {}", header.record_bytes,
                          header.point_format, las_point_bytes(header.point_format)));
  }
  read_las_count(file, head, header);
  read_grid(file, head, header);

  LasCrs crs;
  if (header.points_at > file.size()) {
    file.fail(fmt::format("is cut off: its points begin at byte {}, it holds {} bytes",
                          header.points_at, file.size()));
  }
  read_records(file, {load<std::uint32_t>(head + 100), own_bytes, header.points_at, false}, crs);

  // The points are followed by waveforms inside the file, then by extended records. In a truncated
  // file, both offsets can be beyond the end.
  header.points_end = file.size();
  const auto end_before = [&](std::uint64_t at) {
    if (at >= header.points_at) header.points_end = std::min(header.points_end, at);
  };
  if (header.minor >= 3 && load<std::uint64_t>(head + 227) != 0) {
    end_before(load<std::uint64_t>(head + 227));
  }
  const std::uint32_t extended = header.minor >= 4 ? load<std::uint32_t>(head + 243) : 0;
  const std::uint64_t extended_at = extended ? load<std::uint64_t>(head + 235) : 0;
  if (extended) end_before(extended_at);
  check_count(file, header);
  if (extended) {
    read_records(file, {extended, std::min(extended_at, file.size()), file.size(), true}, crs);
  }
  header.crs = crs.text((load<std::uint16_t>(head + 6) & 0x10) != 0);
  return header;
}

}  // namespace vinerow::io
