#include "tools/photos/photo_facts.h"

#include <fmt/format.h>
#include <vinerow/version.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/core/check.h"
#include "engine/math/angles.h"

namespace vinerow::tools {
namespace {

enum class FieldType : std::uint16_t {
  kByte = 1,
  kAscii = 2,
  kShort = 3,
  kLong = 4,
  kRational = 5,
  kUndefined = 7
};

void put(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>((value >> (8 * i)) & 0xffu);
}

/// One directory of a TIFF file, lower byte first: fields, then the values that do not fit into
/// four bytes.
class Directory {
 public:
  void add_bytes(std::uint16_t tag, FieldType type, std::string_view bytes) {
    add(tag, type, bytes.size(), std::string(bytes));
  }
  /// With the zero that ends it.
  void add_text(std::uint16_t tag, const std::string& text) {
    add(tag, FieldType::kAscii, text.size() + 1, text + '\0');
  }
  void add_number(std::uint16_t tag, FieldType type, std::uint32_t value) {
    std::string bytes;
    put(bytes, value, type == FieldType::kShort ? 2 : type == FieldType::kByte ? 1 : 4);
    add(tag, type, 1, bytes);
  }
  /// Changes a number that was added.
  void set_number(std::uint16_t tag, std::uint32_t value) {
    for (Field& field : fields_) {
      if (field.tag != tag) continue;
      field.bytes.clear();
      put(field.bytes, value, 4);
    }
  }
  /// Each as a fraction of this denominator. @param values  >= 0, below 2^32 / denominator
  void add_fractions(std::uint16_t tag, std::initializer_list<double> values,
                     std::uint32_t denominator) {
    std::string bytes;
    for (const double value : values) {
      put(bytes, static_cast<std::uint32_t>(std::lround(value * denominator)), 4);
      put(bytes, denominator, 4);
    }
    add(tag, FieldType::kRational, values.size(), bytes);
  }

  std::size_t size() const {
    std::size_t bytes = 2 + 12 * fields_.size() + 4;
    for (const Field& field : fields_) bytes += beyond(field);
    return bytes;
  }
  /// @param start  offset of the directory in the file
  void write(std::string& out, std::size_t start) {
    std::sort(fields_.begin(), fields_.end(),
              [](const Field& a, const Field& b) { return a.tag < b.tag; });
    put(out, fields_.size(), 2);
    std::string values;
    const std::size_t first = start + 2 + 12 * fields_.size() + 4;
    for (const Field& field : fields_) {
      put(out, field.tag, 2);
      put(out, static_cast<std::uint16_t>(field.type), 2);
      put(out, field.count, 4);
      if (beyond(field) == 0) {
        out += field.bytes;
        out.append(4 - field.bytes.size(), '\0');
        continue;
      }
      put(out, first + values.size(), 4);
      values += field.bytes;
      values.append(beyond(field) - field.bytes.size(), '\0');
    }
    put(out, 0, 4);  // no further directory
    out += values;
  }

 private:
  struct Field {
    std::uint16_t tag;
    FieldType type;
    std::size_t count;
    std::string bytes;
  };

  void add(std::uint16_t tag, FieldType type, std::size_t count, std::string bytes) {
    fields_.push_back({tag, type, count, std::move(bytes)});
  }
  /// Bytes outside the field itself; even.
  static std::size_t beyond(const Field& field) {
    return field.bytes.size() <= 4 ? 0 : (field.bytes.size() + 1) / 2 * 2;
  }

  std::vector<Field> fields_;
};

/// Degrees, minutes, seconds.
void add_angle(Directory& gps, std::uint16_t tag, double angle_rad) {
  constexpr std::int64_t kSteps = 100'000;  // of a second: 0.3 mm
  // In whole steps first, so that no part is rounded up to 60.
  const auto steps =
      static_cast<std::int64_t>(std::llround(std::abs(deg_from_rad(angle_rad)) * 3600.0 * kSteps));
  const std::int64_t seconds = steps / kSteps;
  gps.add_fractions(tag,
                    {static_cast<double>(seconds / 3600), static_cast<double>(seconds / 60 % 60),
                     static_cast<double>(seconds % 60) +
                         static_cast<double>(steps % kSteps) / static_cast<double>(kSteps)},
                    kSteps);
}

double pixel_mm(const PhotoFacts& facts) {
  return facts.sensor_width_mm / facts.columns;
}

}  // namespace

Eigen::Vector3d photo_angles(const Eigen::Quaterniond& q_WS) {
  // Axes of the picture in north, east, down.
  const auto in_ned = [](const Eigen::Vector3d& v_W) {
    return Eigen::Vector3d(v_W.y(), v_W.x(), -v_W.z());
  };
  const Eigen::Vector3d up = in_ned(q_WS * Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d right = in_ned(q_WS * -Eigen::Vector3d::UnitY());
  const Eigen::Vector3d axis = in_ned(q_WS * Eigen::Vector3d::UnitX());
  // Without -0.
  return {std::atan2(up.y(), up.x()) + 0.0, std::asin(std::clamp(-up.z(), -1.0, 1.0)) + 0.0,
          std::atan2(right.z(), axis.z()) + 0.0};
}

namespace {

/// The three directories of Exif in a TIFF file.
struct Directories {
  Directory main, exif, gps;

  std::size_t end() const { return 8 + main.size() + exif.size() + gps.size(); }

  /// Header and directories. The first one points to the others.
  void write(std::string& out) {
    const std::size_t exif_at = 8 + main.size(), gps_at = exif_at + exif.size();
    main.set_number(0x8769, static_cast<std::uint32_t>(exif_at));
    main.set_number(0x8825, static_cast<std::uint32_t>(gps_at));
    out.append("II*\0\10\0\0\0", 8);
    main.write(out, 8);
    exif.write(out, exif_at);
    gps.write(out, gps_at);
  }
};

Directories make_directories(const PhotoFacts& facts) {
  Directories directories;
  auto& [main, exif, gps] = directories;
  main.add_text(0x010f, "Vinerow");                          // Make
  main.add_text(0x0110, facts.model);                        // Model
  main.add_number(0x0112, FieldType::kShort, 1);             // Orientation: upper left
  main.add_fractions(0x011a, {72.0}, 1);                     // XResolution
  main.add_fractions(0x011b, {72.0}, 1);                     // YResolution
  main.add_number(0x0128, FieldType::kShort, 2);             // ResolutionUnit: inch
  main.add_text(0x0131, "Vinerow " VINEROW_VERSION_STRING);  // Software

  const double per_cm = 10.0 / pixel_mm(facts);                 // pixels per cm
  exif.add_bytes(0x9000, FieldType::kUndefined, "0232");        // ExifVersion
  exif.add_fractions(0x920a, {facts.focal_length_mm}, 10'000);  // FocalLength
  exif.add_bytes(0xa000, FieldType::kUndefined, "0100");        // FlashpixVersion
  exif.add_number(0xa002, FieldType::kLong, static_cast<std::uint32_t>(facts.columns));
  exif.add_number(0xa003, FieldType::kLong, static_cast<std::uint32_t>(facts.rows));
  exif.add_fractions(0xa20e, {per_cm}, 1000);     // FocalPlaneXResolution
  exif.add_fractions(0xa20f, {per_cm}, 1000);     // FocalPlaneYResolution
  exif.add_number(0xa210, FieldType::kShort, 3);  // in pixels per cm
  // Without FocalLengthIn35mmFilm: it is a whole number, and COLMAP prefers it to the exact ones.

  const double yaw_deg = deg_from_rad(photo_angles(facts.q_WS).x());
  gps.add_bytes(0x0000, FieldType::kByte, std::string_view("\2\3\0\0", 4));  // GPSVersionID
  gps.add_text(0x0001, facts.place.latitude_rad < 0.0 ? "S" : "N");
  add_angle(gps, 0x0002, facts.place.latitude_rad);
  gps.add_text(0x0003, facts.place.longitude_rad < 0.0 ? "W" : "E");
  add_angle(gps, 0x0004, facts.place.longitude_rad);
  gps.add_number(0x0005, FieldType::kByte, facts.place.altitude_m < 0.0 ? 1 : 0);
  gps.add_fractions(0x0006, {std::abs(facts.place.altitude_m)}, 10'000);
  gps.add_text(0x0010, "T");  // of GPSImgDirection: true north
  gps.add_fractions(0x0011, {yaw_deg < 0.0 ? yaw_deg + 360.0 : yaw_deg}, 10'000);
  gps.add_text(0x0012, "WGS-84");

  main.add_number(0x8769, FieldType::kLong, 0);  // where the others are
  main.add_number(0x8825, FieldType::kLong, 0);
  return directories;
}

std::string xmp_packet(const PhotoFacts& facts) {
  const Eigen::Vector3d angles = photo_angles(facts.q_WS);
  std::string band;
  if (facts.band) {
    band = fmt::format(
        " Camera:BandName=\"{}\" Camera:CentralWavelength=\"{:g}\" "
        "Camera:WavelengthFWHM=\"{:g}\"\n"
        " Camera:RigName=\"{}\" Camera:RigCameraIndex=\"{}\" Camera:CaptureUUID=\"{}\"\n",
        facts.band->name, facts.band->wavelength_nm, facts.band->width_nm, facts.model,
        facts.band->index, facts.band->capture);
  }
  return fmt::format(
      "<?xpacket begin=\"\xef\xbb\xbf\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n"
      "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n"
      "<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n"
      "<rdf:Description rdf:about=\"\" xmlns:Camera=\"http://pix4d.com/camera/1.0/\"\n"
      "{} Camera:ModelType=\"perspective\" Camera:PerspectiveFocalLength=\"{:.6f}\"\n"
      " Camera:PrincipalPoint=\"{:.6f},{:.6f}\" Camera:PerspectiveDistortion=\"0,0,0,0,0\"\n"
      " Camera:Yaw=\"{:.5f}\" Camera:Pitch=\"{:.5f}\" Camera:Roll=\"{:.5f}\"/>\n"
      "</rdf:RDF>\n</x:xmpmeta>\n<?xpacket end=\"r\"?>",
      band, facts.focal_length_mm, 0.5 * facts.sensor_width_mm, 0.5 * pixel_mm(facts) * facts.rows,
      deg_from_rad(angles.x()), deg_from_rad(angles.y()), deg_from_rad(angles.z()));
}

}  // namespace

std::string exif_segment(const PhotoFacts& facts) {
  Directories directories = make_directories(facts);
  directories.main.add_number(0x0213, FieldType::kShort, 1);  // YCbCrPositioning: centred
  directories.exif.add_bytes(0x9101, FieldType::kUndefined,
                             std::string_view("\1\2\3\0", 4));  // components
  directories.exif.add_number(0xa001, FieldType::kShort, 1);    // ColorSpace: sRGB
  std::string out("Exif\0\0", 6);
  directories.write(out);
  return out;
}

std::string xmp_segment(const PhotoFacts& facts) {
  std::string out = "http://ns.adobe.com/xap/1.0/";
  out += '\0';
  return out + xmp_packet(facts);
}

std::string tiff_file(const PhotoFacts& facts, const Picture& band) {
  VINEROW_DEMAND(band.format == Picture::Format::kMono16 && facts.band);
  Directories directories = make_directories(facts);
  Directory& main = directories.main;
  main.add_number(0x0100, FieldType::kLong, band.width);
  main.add_number(0x0101, FieldType::kLong, band.height);
  main.add_number(0x0102, FieldType::kShort, 16);          // BitsPerSample
  main.add_number(0x0103, FieldType::kShort, 1);           // Compression: none
  main.add_number(0x0106, FieldType::kShort, 1);           // PhotometricInterpretation: 0 is black
  main.add_number(0x0111, FieldType::kLong, 0);            // StripOffsets: one strip
  main.add_number(0x0115, FieldType::kShort, 1);           // SamplesPerPixel
  main.add_number(0x0116, FieldType::kLong, band.height);  // RowsPerStrip
  main.add_number(0x0117, FieldType::kLong, static_cast<std::uint32_t>(band.data.size()));
  main.add_bytes(0x02bc, FieldType::kByte, xmp_packet(facts));
  directories.exif.add_fractions(0x829a, {facts.band->exposure_s}, 1'000'000'000);  // ExposureTime
  directories.exif.add_fractions(0x829d, {facts.band->f_number}, 100);              // FNumber
  main.set_number(0x0111, static_cast<std::uint32_t>(directories.end()));
  std::string out;
  directories.write(out);
  out.append(reinterpret_cast<const char*>(band.data.data()), band.data.size());
  return out;
}

}  // namespace vinerow::tools
