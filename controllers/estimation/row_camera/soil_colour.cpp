#include "controllers/estimation/row_camera/soil_colour.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/math/srgb.h"

namespace vinerow::controllers {
namespace {

constexpr double kRed_nm = 610.0, kGreen_nm = 540.0, kBlue_nm = 460.0;  // of usual filters
constexpr double kBlueShare = (1.0 / kGreen_nm - 1.0 / kRed_nm) / (1.0 / kBlue_nm - 1.0 / kRed_nm);

constexpr int kBins = 64;  // of the histogram of colours, which lies within +-kWidest
constexpr float kWidest = 1.0f;
constexpr float kLeastApart = 0.2f;

/// Logarithm of the linear light of each byte; 0 counts as 1.
std::array<float, 256> log_of_bytes() {
  std::array<float, 256> logs;
  for (int byte = 0; byte < 256; ++byte) {
    const double linear = linear_from_srgb(std::max(byte, 1) / 255.0);
    logs[static_cast<std::size_t>(byte)] = static_cast<float>(std::log(linear));
  }
  return logs;
}

}  // namespace

float soil_colour(const std::uint8_t* rgb) {
  static const std::array<float, 256> kLogs = log_of_bytes();
  constexpr auto kBlue = static_cast<float>(kBlueShare);
  return (1.0f - kBlue) * kLogs[rgb[0]] + kBlue * kLogs[rgb[2]] - kLogs[rgb[1]];
}

bool SoilClasses::differ() const {
  return soil - grass > kLeastApart;
}

float SoilClasses::share(float colour) const {
  return std::clamp((colour - grass) / (soil - grass), 0.0f, 1.0f);
}

SoilClasses split_soil(std::span<const float> colours) {
  std::array<int, kBins> histogram{};
  for (const float colour : colours) {
    const int bin = static_cast<int>(0.5f * (colour / kWidest + 1.0f) * kBins);
    ++histogram[static_cast<std::size_t>(std::clamp(bin, 0, kBins - 1))];
  }
  double total = 0.0, sum = 0.0;
  for (int i = 0; i < kBins; ++i) {
    total += histogram[i];
    sum += static_cast<double>(i) * histogram[i];
  }
  const auto colour = [](double bin) {
    return kWidest * static_cast<float>(2.0 * (bin + 0.5) / kBins - 1.0);
  };
  SoilClasses classes;
  double below = 0.0, below_sum = 0.0, best = 0.0;
  for (int i = 0; i + 1 < kBins; ++i) {
    below += histogram[i];
    below_sum += static_cast<double>(i) * histogram[i];
    const double above = total - below;
    if (below <= 0.0 || above <= 0.0) continue;
    const double low = below_sum / below, high = (sum - below_sum) / above;
    const double variance = below * above * (high - low) * (high - low);
    if (variance > best) {
      best = variance;
      classes = {colour(low), colour(high)};
    }
  }
  return classes;
}

}  // namespace vinerow::controllers
