#include "engine/sensors/camera/depth_reading.h"

#include <fmt/format.h>

#include "engine/api/parameter_table.h"

namespace vinerow::sensors {
namespace {

constexpr double kLargest_m = 65.535;

}  // namespace

const ParameterTable<DepthParams>& depth_table() {
  using P = DepthParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("depth_min_m", "m", &P::min_m, between(0.0, kLargest_m),
                  "nearest depth that is reported")
          .number("depth_max_m", "m", &P::max_m, between(0.0, kLargest_m),
                  "farthest depth that is reported")
          .number("depth_baseline_m", "m", &P::baseline_m, between(0.0, 10.0),
                  "distance of the two lenses that measure depth; 0: depth has no noise")
          .number("depth_disparity_std_px", "", &P::disparity_std_px, between(0.0, 10.0),
                  "error of the disparity between their pictures, pixels")
          .number("depth_dropout_share", "", &P::dropout_share, between(0.0, 1.0),
                  "pixels without a depth although there is one")
          .rule([](const P& p) -> std::string {
            if (p.min_m < p.max_m) return "";
            return fmt::format("depth_min_m = {:g}, must be < depth_max_m = {:g}", p.min_m,
                               p.max_m);
          });
  return table;
}

DepthReading::DepthReading(const DepthParams& params, double fx_px) : params_(params) {
  if (params.baseline_m > 0.0) {
    std_per_m2_ = params.disparity_std_px / (fx_px * params.baseline_m);
  }
}

std::uint16_t DepthReading::exact_mm(double depth_m) const {
  if (!(depth_m >= params_.min_m && depth_m <= params_.max_m)) return 0;
  return static_cast<std::uint16_t>(1000.0 * depth_m + 0.5);
}

std::uint16_t DepthReading::reading_mm(double depth_m, QuickNormals& noise) const {
  const double error = noise.next(), luck = noise.next_share();
  if (luck < params_.dropout_share) return 0;
  return exact_mm(depth_m + std_per_m2_ * depth_m * depth_m * error);
}

}  // namespace vinerow::sensors
