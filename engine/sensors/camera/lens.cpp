#include "engine/sensors/camera/lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::sensors {
namespace {

constexpr std::size_t kBrownCoefficients = 5, kFisheyeCoefficients = 4;
constexpr double kMostPixels = 4096.0 * 4096.0;

/// As given, or by the width of view: a pinhole's pixels are even in the tangent, a fisheye's in
/// the angle.
double calc_fx_px(const LensParams& p) {
  const double half_rad = 0.5 * p.horizontal_fov_rad;
  const double half_width = p.lens == CameraInfo::Lens::kFisheye ? half_rad : std::tan(half_rad);
  return p.fx_px.value_or(0.5 * p.width_px / half_width);
}

std::string fault_of(const LensParams& p) {
  const bool is_fisheye = p.lens == CameraInfo::Lens::kFisheye;
  const std::size_t count = is_fisheye ? kFisheyeCoefficients : kBrownCoefficients;
  if (!p.distortion.empty() && p.distortion.size() != count) {
    return fmt::format("distortion has {} coefficient{}, must have {} for lens {} ({}) or none",
                       p.distortion.size(), p.distortion.size() == 1 ? "" : "s", count,
                       is_fisheye ? "fisheye" : "brown_conrady",
                       is_fisheye ? "k1, k2, k3, k4" : "k1, k2, p1, p2, k3");
  }
  if (static_cast<double>(p.width_px) * p.height_px > kMostPixels) {
    return fmt::format("width_px x height_px = {} x {}, must be at most {:.0f} pixels", p.width_px,
                       p.height_px, kMostPixels);
  }
  constexpr double kWidest_rad = 2.8;
  if (is_fisheye) return "";
  if (!p.fx_px && p.horizontal_fov_rad > kWidest_rad) {
    return fmt::format(
        "horizontal_fov_deg = {:g}, must be at most {:.0f} for lens brown_conrady; lens fisheye is "
        "wider",
        deg_from_rad(p.horizontal_fov_rad), deg_from_rad(kWidest_rad));
  }
  // Along a row and across the rows, from the principal point to the farther border.
  const double fx_px = calc_fx_px(p), fy_px = p.fy_px.value_or(fx_px);
  struct Axis {
    const char *size, *focal, *middle, *pixels;
    double px, f_px;
    bool has_f;
    std::optional<double> c_px;
  };
  const Axis axes[] = {{"width_px", "fx_px", "cx_px", "pixels in a row", double{1} * p.width_px,
                        fx_px, p.fx_px.has_value(), p.cx_px},
                       {"height_px", "fy_px", "cy_px", "rows", double{1} * p.height_px, fy_px,
                        p.fy_px.has_value(), p.cy_px}};
  const double steepest = std::tan(0.5 * kWidest_rad);
  for (const Axis& axis : axes) {
    const double middle_px = 0.5 * (axis.px - 1.0), c_px = axis.c_px.value_or(middle_px);
    const double reach_px = 0.5 + std::max(c_px, axis.px - 1.0 - c_px);
    if (reach_px <= steepest * axis.f_px * (1.0 + 1e-9)) continue;
    if (0.5 * axis.px <= steepest * axis.f_px) {
      return fmt::format(
          "{} = {:g} with {} {} and a focal length of {:.4g} pixels looks {:.1f} deg aside, must "
          "be at most {:.0f} deg for lens brown_conrady",
          axis.middle, c_px, axis.px, axis.pixels, axis.f_px,
          deg_from_rad(std::atan(reach_px / axis.f_px)), deg_from_rad(0.5 * kWidest_rad));
    }
    if (axis.has_f) {
      return fmt::format(
          "{} = {:g}, must be at least {:.3g} for lens brown_conrady with {} {}, which is a view "
          "of {:.0f} deg; lens fisheye is wider",
          axis.focal, axis.f_px, 0.5 * axis.px / steepest, axis.px, axis.pixels,
          deg_from_rad(kWidest_rad));
    }
    return fmt::format(
        "{} = {}, must be at most {:.0f} for lens brown_conrady with a focal length of {:.4g} "
        "pixels, which is a view of {:.0f} deg; lens fisheye is wider",
        axis.size, axis.px, std::floor(2.0 * steepest * axis.f_px), axis.f_px,
        deg_from_rad(kWidest_rad));
  }
  return "";
}

}  // namespace

const ParameterTable<LensParams>& lens_table() {
  using P = LensParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .integer("width_px", &P::width_px, between(16, 8192), "pixels in a row")
          .integer("height_px", &P::height_px, between(16, 8192), "rows of pixels")
          .choice("lens", &P::lens,
                  {{"brown_conrady", CameraInfo::Lens::kBrownConrady},
                   {"fisheye", CameraInfo::Lens::kFisheye}},
                  "model of the lens (ROS: plumb_bob, equidistant)")
          .degrees("horizontal_fov_deg", &P::horizontal_fov_rad, between(1.0, 220.0),
                   "width of view without distortion; sets fx if that is absent")
          .number("fx_px", "", &P::fx_px, above(0.0, 1e6), "focal length along a row, pixels")
          .number("fy_px", "", &P::fy_px, above(0.0, 1e6),
                  "focal length across rows, pixels; absent: as fx")
          .number("cx_px", "", &P::cx_px, between(-1e5, 1e5),
                  "principal point, pixels from the middle of the left column; absent: the middle")
          .number("cy_px", "", &P::cy_px, between(-1e5, 1e5),
                  "principal point, pixels from the middle of the upper row; absent: the middle")
          .numbers("distortion", "", &P::distortion, kAnyNumber,
                   "k1, k2, p1, p2, k3 of brown_conrady or k1, k2, k3, k4 of fisheye; empty: none")
          .rule(&fault_of);
  return table;
}

Lens make_lens(const LensParams& params, const std::string& who) {
  CameraInfo info;
  info.width = static_cast<std::uint32_t>(params.width_px);
  info.height = static_cast<std::uint32_t>(params.height_px);
  info.lens = params.lens;
  std::copy(params.distortion.begin(), params.distortion.end(), info.distortion.begin());
  info.fx_px = calc_fx_px(params);
  info.fy_px = params.fy_px.value_or(info.fx_px);
  info.cx_px = params.cx_px.value_or(0.5 * (params.width_px - 1));
  info.cy_px = params.cy_px.value_or(0.5 * (params.height_px - 1));
  const Lens lens(info);
  // If the lens maps the picture's border one to one, it does so inside: both models are smooth and
  // fold first where they are farthest from the axis.
  const auto check = [&](double u, double v) {
    if (lens.direction(u, v)) return;
    throw ConfigError(fmt::format(
        "{}: the lens folds: with this distortion and focal length no single direction belongs to "
        "pixel ({:g}, {:g})",
        who, u, v));
  };
  constexpr int kChecks = 32;
  for (int i = 0; i <= kChecks; ++i) {
    const double share = static_cast<double>(i) / kChecks;
    const double u = share * (lens.width() - 1), v = share * (lens.height() - 1);
    check(u, 0.0);
    check(u, lens.height() - 1.0);
    check(0.0, v);
    check(lens.width() - 1.0, v);
  }
  return lens;
}

}  // namespace vinerow::sensors
