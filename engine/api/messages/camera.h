#pragma once
/// Pictures of camera sensors and the geometry of their lenses. Frames and units:
/// engine/api/messages.h.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/api/field.h"

namespace vinerow {

/// A picture, uppermost row first. ROS 2: sensor_msgs/msg/CompressedImage, as PNG without loss.
struct Picture {
  static constexpr const char* kType = "Picture";
  static constexpr MessageFrame kFrame = MessageFrame::kOwn;
  enum class Format : std::uint8_t {
    kRgb8 = 0,     ///< red, green, blue
    kMono8 = 1,    ///< one byte a pixel
    kDepth16 = 2,  ///< distance in millimetres, 0: none; two bytes a pixel, the lower one first
    kMono16 = 3    ///< two bytes a pixel, the lower one first
  };
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  Format format = Format::kRgb8;
  std::vector<std::uint8_t> data;  ///< row by row without gaps

  static constexpr std::size_t bytes_per_pixel(Format format) {
    return format == Format::kRgb8 ? 3 : format == Format::kMono8 ? 1 : 2;
  }

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"width", "", "pixels"}, self.width);
    f({"height", "", "pixels"}, self.height);
    f({"format"}, self.format);
    f({"data", "", "row by row, the uppermost first; two bytes: the lower one first"}, self.data);
  }
};

inline std::span<const EnumName> enum_names(Picture::Format) {
  using enum Picture::Format;
  static constexpr EnumName kNames[] = {enum_name(kRgb8, "RGB8"), enum_name(kMono8, "MONO8"),
                                        enum_name(kDepth16, "DEPTH16"),
                                        enum_name(kMono16, "MONO16")};
  return kNames;
}

/// Geometry of a camera. ROS 2: sensor_msgs/msg/CameraInfo.
///
/// A point at (x, y, z) of the optical frame (x to the right, y down, z along the axis) is at pixel
/// (fx x' + cx, fy y' + cy), where (0, 0) is the middle of the upper left pixel and (x', y') are
/// (x/z, y/z) after distortion.
struct CameraInfo {
  static constexpr const char* kType = "CameraInfo";
  static constexpr MessageFrame kFrame = MessageFrame::kOwn;
  enum class Lens : std::uint8_t {
    kBrownConrady = 0,  ///< ROS: plumb_bob; distortion: k1, k2, p1, p2, k3
    kFisheye = 1        ///< ROS: equidistant; distortion: k1, k2, k3, k4, 0
  };
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  Lens lens = Lens::kBrownConrady;
  std::array<double, 5> distortion{};
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  double tx_px_m =
      0.0;  ///< right camera of a stereo pair: -fx times its distance from the left one

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"width", "", "pixels"}, self.width);
    f({"height", "", "pixels"}, self.height);
    f({"lens"}, self.lens);
    f({"distortion", "", "k1, k2, p1, p2, k3; of a fisheye lens k1, k2, k3, k4, 0"},
      self.distortion);
    f({"fx", "px", "focal length"}, self.fx_px);
    f({"fy", "px", "focal length"}, self.fy_px);
    f({"cx", "px", "principal point"}, self.cx_px);
    f({"cy", "px", "principal point"}, self.cy_px);
    f({"tx", "px m", "right camera of a stereo pair: -fx times its distance from the left one"},
      self.tx_px_m);
  }
};

inline std::span<const EnumName> enum_names(CameraInfo::Lens) {
  using enum CameraInfo::Lens;
  static constexpr EnumName kNames[] = {enum_name(kBrownConrady, "BROWN_CONRADY"),
                                        enum_name(kFisheye, "FISHEYE")};
  return kNames;
}

}  // namespace vinerow
