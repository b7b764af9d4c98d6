#include "engine/math/standard_atmosphere.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "engine/core/constants.h"

namespace vinerow {
namespace {

constexpr double kEarthRadius_m = 6'356'766.0;
constexpr double kGasConstant_JpkgK = 8314.32 / 28.9644;  // the standard's R* over M0
/// g0 M0 / R*, K/m.
constexpr double kHydrostatic_Kpm = kStandardGravity_mps2 / kGasConstant_JpkgK;

/// Layer: base height, temperature at the base, temperature gradient. Table 4 of the standard.
struct Layer {
  double base_m, temperature_K, lapse_Kpm;
};
constexpr Layer kLayers[] = {{0.0, 288.15, -0.0065},    {11'000.0, 216.65, 0.0},
                             {20'000.0, 216.65, 0.001}, {32'000.0, 228.65, 0.0028},
                             {47'000.0, 270.65, 0.0},   {51'000.0, 270.65, -0.0028},
                             {71'000.0, 214.65, -0.002}};

/// Pressure relative to that at the layer's base.
double pressure_ratio(const Layer& layer, double above_m) {
  if (layer.lapse_Kpm == 0.0) return std::exp(-kHydrostatic_Kpm * above_m / layer.temperature_K);
  return std::pow(1.0 + layer.lapse_Kpm * above_m / layer.temperature_K,
                  -kHydrostatic_Kpm / layer.lapse_Kpm);
}

}  // namespace

double geopotential_height_m(double altitude_m) {
  return kEarthRadius_m * altitude_m / (kEarthRadius_m + altitude_m);
}

AirState calc_standard_air(double altitude_m) {
  const double height_m = geopotential_height_m(std::clamp(altitude_m, -5'000.0, 86'000.0));
  double pressure_Pa = kSeaLevelPressure_Pa;
  std::size_t i = 0;
  for (; i + 1 < std::size(kLayers) && height_m > kLayers[i + 1].base_m; ++i) {
    pressure_Pa *= pressure_ratio(kLayers[i], kLayers[i + 1].base_m - kLayers[i].base_m);
  }
  const Layer& layer = kLayers[i];
  const double above_m = height_m - layer.base_m;
  pressure_Pa *= pressure_ratio(layer, above_m);
  const double temperature_K = layer.temperature_K + layer.lapse_Kpm * above_m;
  return {pressure_Pa, temperature_K, pressure_Pa / (kGasConstant_JpkgK * temperature_K)};
}

double calc_standard_density_kgm3(double altitude_m) {
  return calc_standard_air(altitude_m).density_kgm3;
}

}  // namespace vinerow
