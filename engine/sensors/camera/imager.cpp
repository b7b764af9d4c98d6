#include "engine/sensors/camera/imager.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/core/parallel.h"
#include "engine/math/angles.h"
#include "engine/math/srgb.h"

namespace vinerow::sensors {
namespace {

constexpr double kSun_lx = 128e3;  // illuminance above the atmosphere
/// Photons per second and square micrometre for 1 lx at 555 nm: 1 / 683 W/m2 over h c / 555 nm.
/// That is also about what one of three colour filters passes of daylight, which has 1.1e4 in all.
constexpr double kPhotons_per_lx_s_um2 = 4091.0;

constexpr int kQuantileBits = 12;
constexpr int kQuantiles = 1 << kQuantileBits;

/// Middle of each share of the standard normal distribution, from its density by the trapezoidal
/// rule.
std::vector<float> make_quantiles() {
  std::vector<float> quantiles;
  quantiles.reserve(kQuantiles);
  constexpr double kFirst = -6.0, kStep = 1e-4;
  const double scale = 1.0 / std::sqrt(2.0 * kPi);
  const auto density = [&](double x) { return scale * std::exp(-0.5 * x * x); };
  double x = kFirst, sum = 0.0;
  for (int i = 0; i < kQuantiles; ++i) {
    const double wanted = (i + 0.5) / kQuantiles;
    while (x < -kFirst) {
      const double more = 0.5 * kStep * (density(x) + density(x + kStep));
      if (sum + more >= wanted) break;
      sum += more;
      x += kStep;
    }
    quantiles.push_back(static_cast<float>(x + (wanted - sum) / density(x)));
  }
  return quantiles;
}

/// Electrons of a pixel per second, for radiance 1.
double calc_electrons_per_s(const ImagerParams& params) {
  return params.quantum_efficiency * params.pixel_um * params.pixel_um * kPi /
         (4.0 * params.f_number * params.f_number) * kSun_lx * kPhotons_per_lx_s_um2;
}

const std::vector<float>& quantiles() {
  static const std::vector<float> table = make_quantiles();
  return table;
}

}  // namespace

const ParameterTable<ImagerParams>& imager_table() {
  using P = ImagerParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("exposure_s", "s", &P::exposure_s, between(0.0, 10.0),
                  "exposure time; 0: chosen for each picture")
          .number("exposure_min_s", "s", &P::exposure_min_s, between(1e-6, 10.0),
                  "shortest that is chosen")
          .number("exposure_max_s", "s", &P::exposure_max_s, between(1e-6, 10.0),
                  "longest that is chosen; beyond it the gain rises")
          .number("gain_max", "", &P::gain_max, between(1.0, 1000.0), "largest gain that is chosen")
          .number("brightness", "", &P::brightness, between(0.01, 0.9),
                  "share of the range at which the picture's geometric mean is exposed")
          .number("f_number", "", &P::f_number, between(0.5, 64.0), "of the lens")
          .number("pixel_um", "um", &P::pixel_um, between(0.5, 50.0), "width of a pixel")
          .number("quantum_efficiency", "", &P::quantum_efficiency, between(0.01, 1.0),
                  "electrons per photon")
          .number("full_well_e", "", &P::full_well_e, between(100.0, 1e7),
                  "electrons at which a pixel is full (EMVA 1288: saturation capacity)")
          .number("read_noise_e", "", &P::read_noise_e, between(0.0, 1000.0),
                  "electrons (EMVA 1288: temporal dark noise)")
          .number("dsnu_e", "", &P::dsnu_e, between(0.0, 1000.0),
                  "electrons by which pixels differ in the dark (EMVA 1288: DSNU)")
          .number("prnu", "", &P::prnu, between(0.0, 0.5),
                  "share by which pixels differ in light (EMVA 1288: PRNU)")
          .integer("bits", &P::bits, between(8, 16), "of the converter")
          .number("corner_light", "", &P::corner_light, between(0.05, 1.0),
                  "light in the corners against the middle (vignetting)")
          .boolean("noise", &P::noise, "false: pictures without noise")
          .rule([](const P& p) -> std::string {
            if (p.exposure_min_s <= p.exposure_max_s) return "";
            return fmt::format("exposure_min_s = {:g}, must be <= exposure_max_s = {:g}",
                               p.exposure_min_s, p.exposure_max_s);
          });
  return table;
}

QuickNormals::QuickNormals(RandomStream random) : random_(random) {}

std::uint32_t QuickNormals::draw() {
  if (left_ == 0) {
    bits_ = random_.next_u64();
    left_ = 64 / kQuantileBits;
  }
  const auto index = static_cast<std::uint32_t>(bits_ & (kQuantiles - 1));
  bits_ >>= kQuantileBits;
  --left_;
  return index;
}

float QuickNormals::next() {
  return quantile(draw());
}

float QuickNormals::quantile(std::uint32_t share) {
  return quantiles()[share];
}

float QuickNormals::next_share() {
  return static_cast<float>(draw()) / kQuantiles;
}

Imager::Imager(const ImagerParams& params, int width, int height, int channels,
               const Eigen::Vector3f& white, RandomStream pattern)
    : params_(params),
      width_(width),
      height_(height),
      channels_(channels),
      exposure_s_(params.exposure_s > 0.0 ? params.exposure_s : params.exposure_max_s) {
  // None is below 1: a full pixel stays white.
  for (int c = 0; c < 3; ++c) balance_[c] = white.maxCoeff() / white[c];
  electrons_per_s_ = calc_electrons_per_s(params);
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  if (params.noise) draws_.resize(pixels * channels);
  QuickNormals draws(pattern);
  for (std::size_t i = 0; i < pixels; ++i) {
    const double x = 2.0 * (static_cast<double>(i % width) + 0.5) / width - 1.0;
    const double y = 2.0 * (static_cast<double>(i / width) + 0.5) / height - 1.0;
    const double corner2 =
        (x * x * width * width + y * y * height * height) /
        (static_cast<double>(width) * width + static_cast<double>(height) * height);
    light_.push_back(static_cast<float>(1.0 - (1.0 - params.corner_light) * corner2));
    const double offset_e = params.noise ? params.dsnu_e * draws.next() : 0.0;
    const double gain = params.noise ? params.prnu * draws.next() : 0.0;
    offsets_e_.push_back(static_cast<float>(offset_e));
    gains_.push_back(static_cast<float>(1.0 + gain));
  }
  const double top = (1 << params.bits) - 1.0;
  values_.resize(channels);
  for (int c = 0; c < channels; ++c) {
    for (double number = 0.0; number <= top; ++number) {
      const double balanced = channels == 3 ? number * balance_[c] : number;
      const double whole = std::min(top, std::floor(balanced + 0.5));
      // A band stays linear; its range is stretched to 16 bits.
      const double value =
          channels == 3 ? 255.0 * srgb_from_linear(whole / top) : whole * 65535.0 / top;
      values_[c].push_back(static_cast<std::uint16_t>(std::lround(value)));
    }
  }
}

double Imager::calc_exposure_s(const ImagerParams& params, double radiance, double share) {
  return share * params.full_well_e / (calc_electrons_per_s(params) * radiance);
}

/// Chooses exposure and gain by the geometric mean, which a bright sky hardly moves. The camera is
/// taken as settled: it meters the picture itself, not the one before.
void Imager::meter(std::span<const float> radiance) {
  if (params_.exposure_s > 0.0) return;
  double sum = 0.0;
  std::size_t count = 0;
  constexpr int kEvery = 4;
  constexpr double kDark = 1e-5;
  for (int y = kEvery / 2; y < height_; y += kEvery) {
    for (int x = kEvery / 2; x < width_; x += kEvery, ++count) {
      const std::size_t pixel = static_cast<std::size_t>(y) * width_ + x;
      const float* values = &radiance[pixel * channels_];
      const double grey = channels_ == 3 ? 0.2126 * balance_[0] * values[0] +
                                               0.7152 * balance_[1] * values[1] +
                                               0.0722 * balance_[2] * values[2]
                                         : values[0];
      sum += std::log(light_[pixel] * grey + kDark);
    }
  }
  const double mean = std::exp(sum / static_cast<double>(std::max<std::size_t>(count, 1)));
  const double wanted_s = params_.brightness * params_.full_well_e / (electrons_per_s_ * mean);
  exposure_s_ = std::clamp(wanted_s, params_.exposure_min_s, params_.exposure_max_s);
  gain_ = std::clamp(wanted_s / exposure_s_, 1.0, params_.gain_max);
}

void Imager::develop(std::size_t pixel, int channel, double share_of_range,
                     Picture& picture) const {
  const std::vector<std::uint16_t>& values = values_[static_cast<std::size_t>(channel)];
  const auto top = static_cast<double>(values.size() - 1);
  const std::uint16_t value =
      values[static_cast<std::size_t>(std::clamp(share_of_range, 0.0, 1.0) * top + 0.5)];
  if (channels_ == 3) {
    picture.data[3 * pixel + channel] = static_cast<std::uint8_t>(value);
    return;
  }
  picture.data[2 * pixel] = static_cast<std::uint8_t>(value & 0xffu);
  picture.data[2 * pixel + 1] = static_cast<std::uint8_t>(value >> 8);
}

void Imager::expose(std::span<const float> radiance, QuickNormals& noise, Picture& reading,
                    Picture& truth) {
  meter(radiance);
  // The draws have an order, the pixels do not.
  if (params_.noise) {
    for (std::uint16_t& draw : draws_) draw = static_cast<std::uint16_t>(noise.draw());
  }
  const struct {
    std::span<const float> radiance;
    Picture& reading;
    Picture& truth;
  } pictures{radiance, reading, truth};
  constexpr std::size_t kRowsAtOnce = 16;
  for_chunks(static_cast<std::size_t>(height_), kRowsAtOnce,
             [this, &pictures](std::size_t, std::size_t begin, std::size_t end) {
               for (std::size_t pixel = begin * width_; pixel < end * width_; ++pixel) {
                 expose_pixel(pixel, pictures.radiance, pictures.reading, pictures.truth);
               }
             });
}

void Imager::expose_pixel(std::size_t pixel, std::span<const float> radiance, Picture& reading,
                          Picture& truth) const {
  const double scale = electrons_per_s_ * exposure_s_, to_share = gain_ / params_.full_well_e;
  const double read2_e2 = params_.read_noise_e * params_.read_noise_e;
  for (int c = 0; c < channels_; ++c) {
    const std::size_t i = pixel * channels_ + c;
    const double electrons = scale * light_[pixel] * radiance[i];
    const double full = std::min(electrons, params_.full_well_e);
    develop(pixel, c, full * to_share, truth);
    double read_e = electrons * gains_[pixel] + offsets_e_[pixel];
    if (params_.noise) {
      const double std_e = std::sqrt(std::max(read_e, 0.0) + read2_e2);
      read_e += std_e * QuickNormals::quantile(draws_[i]);
    }
    develop(pixel, c, std::min(read_e, params_.full_well_e) * to_share, reading);
  }
}

}  // namespace vinerow::sensors
