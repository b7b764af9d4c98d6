/// Mapping of camera pictures and of the cameras' geometry.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "engine/imaging/picture_codec.h"
#include "engine/record/ros_fields.h"
#include "engine/record/ros_mapping.h"

namespace vinerow::record {
namespace {

/// As compressed_image_transport writes it: encoding of the raw picture, then how it is compressed.
std::string_view format_text(Picture::Format format) {
  switch (format) {
    case Picture::Format::kRgb8:
      return "rgb8; png compressed bgr8";
    case Picture::Format::kMono8:
      return "mono8; png compressed mono8";
    case Picture::Format::kDepth16:
      return "16UC1; png compressed 16UC1";
    case Picture::Format::kMono16:
      return "mono16; png compressed mono16";
  }
  return "";
}

constexpr std::string_view kPlumbBob = "plumb_bob", kEquidistant = "equidistant";
constexpr std::size_t kFisheyeCoefficients = 4;

}  // namespace

void RosMapping<Picture>::write(CdrWriter& out, const WriteContext& to, const Picture& value) {
  write_header(out, to.stamp, to.frames.own);
  out.add(format_text(value.format));
  const std::string bytes = imaging::encode_picture(value);
  out.add_count(bytes.size());
  std::copy(bytes.begin(), bytes.end(), out.extend_octets(bytes.size()));
}

bool RosMapping<Picture>::read(CdrReader& in, const FrameNames&, Picture& value) {
  skip_header(in);
  value = {};
  const std::string_view text = in.read_text();
  using Format = Picture::Format;
  const bool is_depth = text == format_text(Format::kDepth16);
  for (const auto format : {Format::kMono8, Format::kMono16}) {
    if (text == format_text(format)) value.format = format;
  }
  std::string bytes(in.read_count(1), '\0');
  in.read_octets(reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size());
  const bool is_read = in.ok() && (bytes.empty() || imaging::decode_picture(bytes, value));
  // A PNG file does not know what its 16 bits are.
  if (is_depth && (bytes.empty() || value.format == Format::kMono16)) {
    value.format = Format::kDepth16;
  }
  return is_read;
}

void RosMapping<CameraInfo>::write(CdrWriter& out, const WriteContext& to,
                                   const CameraInfo& value) {
  write_header(out, to.stamp, to.frames.own);
  out.add(value.height);
  out.add(value.width);
  const bool is_fisheye = value.lens == CameraInfo::Lens::kFisheye;
  out.add(is_fisheye ? kEquidistant : kPlumbBob);
  const std::size_t count = is_fisheye ? kFisheyeCoefficients : value.distortion.size();
  out.add_count(count);
  out.add_doubles(value.distortion.data(), count);
  const double fx = value.fx_px, fy = value.fy_px, cx = value.cx_px, cy = value.cy_px;
  const std::array<double, 9> k = {fx, 0, cx, 0, fy, cy, 0, 0, 1};
  const std::array<double, 9> r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::array<double, 12> p = {fx, 0, cx, value.tx_px_m, 0, fy, cy, 0, 0, 0, 1, 0};
  out.add_doubles(k.data(), k.size());
  out.add_doubles(r.data(), r.size());
  out.add_doubles(p.data(), p.size());
  for (int i = 0; i < 6; ++i) out.add(std::uint32_t{0});  // binning, region of interest: none
  out.add(false);
}

bool RosMapping<CameraInfo>::read(CdrReader& in, const FrameNames&, CameraInfo& value) {
  skip_header(in);
  value.height = in.read<std::uint32_t>();
  value.width = in.read<std::uint32_t>();
  const std::string model(in.read_text());
  if (model != kPlumbBob && model != kEquidistant) return false;
  value.lens = model == kEquidistant ? CameraInfo::Lens::kFisheye : CameraInfo::Lens::kBrownConrady;
  const std::size_t count = in.read_count(sizeof(double));
  if (count > value.distortion.size()) return false;
  value.distortion = {};
  in.read_doubles(value.distortion.data(), count);
  std::array<double, 9> k{}, r{};
  std::array<double, 12> p{};
  in.read_doubles(k.data(), k.size());
  in.read_doubles(r.data(), r.size());
  in.read_doubles(p.data(), p.size());
  value.fx_px = k[0];
  value.cx_px = k[2];
  value.fy_px = k[4];
  value.cy_px = k[5];
  value.tx_px_m = p[3];
  for (int i = 0; i < 6; ++i) in.read<std::uint32_t>();
  in.read_bool();
  return in.ok();
}

}  // namespace vinerow::record
