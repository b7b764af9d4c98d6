#include "tools/export/scan_files.h"

#include <fmt/format.h>

#include "engine/record/cdr.h"

namespace vinerow::tools {
namespace {

using record::RosKind;

/// Names of a type of numbers in both formats.
struct NumberName {
  const char* ply;
  char pcd;  ///< the size is beside it
};
NumberName name_of(RosKind kind) {
  switch (kind) {
    case RosKind::kInt8:
      return {"char", 'I'};
    case RosKind::kUint8:
      return {"uchar", 'U'};
    case RosKind::kInt16:
      return {"short", 'I'};
    case RosKind::kUint16:
      return {"ushort", 'U'};
    case RosKind::kInt32:
      return {"int", 'I'};
    case RosKind::kUint32:
      return {"uint", 'U'};
    case RosKind::kFloat64:
      return {"double", 'F'};
    default:
      return {"float", 'F'};
  }
}

/// Both headers separate names by blanks and end them with their line.
std::string word_of(const std::string& name) {
  std::string word;
  for (const char c : name) word += static_cast<unsigned char>(c) <= ' ' ? '_' : c;
  return word.empty() ? "_" : word;
}

std::string pcd_header(std::span<const CloudField> fields, const std::string& mark,
                       const std::string& points) {
  std::string names, sizes, types, counts;
  for (const CloudField& field : fields) {
    names += " " + word_of(field.name);
    sizes += fmt::format(" {}", record::size_of(field.kind));
    types += fmt::format(" {}", name_of(field.kind).pcd);
    counts += " 1";
  }
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\n# written by Vinerow {}\nVERSION 0.7\n"
      "FIELDS{}\nSIZE{}\nTYPE{}\nCOUNT{}\nWIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
      "POINTS {}\nDATA binary\n",
      mark, names, sizes, types, counts, points, points);
}

std::string ply_header(std::span<const CloudField> fields, const std::string& mark,
                       const std::string& points) {
  std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment written by Vinerow {}\nelement vertex {}\n",
      mark, points);
  for (const CloudField& field : fields) {
    header += fmt::format("property {} {}\n", name_of(field.kind).ply, word_of(field.name));
  }
  return header + "end_header\n";
}

}  // namespace

const char* ending_of(CloudFormat format) {
  return format == CloudFormat::kPcd ? ".pcd" : ".ply";
}

std::string cloud_header(CloudFormat format, std::span<const CloudField> fields,
                         std::uint64_t points) {
  // A comment fills the digits that the number does not need.
  constexpr std::size_t kDigits = 20;  // of 2^64 - 1
  const std::string number = fmt::format("{}", points);
  const std::size_t times = format == CloudFormat::kPcd ? 2 : 1;
  const std::string mark(times * (kDigits - number.size()) + 1, '-');
  return format == CloudFormat::kPcd ? pcd_header(fields, mark, number)
                                     : ply_header(fields, mark, number);
}

ScanFiles::ScanFiles(std::filesystem::path folder, CloudFormat format)
    : files_(std::move(folder), "frame_id,points"), format_(format) {}

bool ScanFiles::add(std::int64_t stamp_ns, std::int64_t logged_ns,
                    std::span<const std::uint8_t> message) {
  record::CdrReader in(message);
  in.read<std::int32_t>();
  in.read<std::uint32_t>();
  const std::string frame(in.read_text());
  const auto cloud = read_cloud(in);
  if (!cloud) return false;
  std::string bytes = cloud_header(format_, cloud->fields, cloud->size());
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    for (const CloudField& field : cloud->fields) {
      bytes.append(reinterpret_cast<const char*>(cloud->point(i) + field.offset),
                   record::size_of(field.kind));
    }
  }
  files_.add(stamp_ns, logged_ns, {frame, fmt::format("{}", cloud->size())}, bytes,
             ending_of(format_));
  return true;
}

}  // namespace vinerow::tools
