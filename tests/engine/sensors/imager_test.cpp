/// Image sensors by the method of EMVA standard 1288: mean and variance of pictures of even light.

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/random.h"
#include "engine/math/srgb.h"
#include "engine/sensors/camera/imager.h"

namespace vinerow::sensors::imager_test {
namespace {

constexpr int kSide = 200;
constexpr std::size_t kPixels = kSide * kSide;

Picture picture_of(Picture::Format format) {
  Picture picture;
  picture.width = picture.height = kSide;
  picture.format = format;
  picture.data.resize(kPixels * Picture::bytes_per_pixel(format));
  return picture;
}

struct Moments {
  double mean = 0.0, variance = 0.0;
};

/// Numbers of a band's picture, stretched to 16 bits.
std::vector<double> numbers_of(const Picture& picture) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < kPixels; ++i) {
    numbers.push_back(picture.data[2 * i] + 256.0 * picture.data[2 * i + 1]);
  }
  return numbers;
}

Moments moments_of(const std::vector<double>& values) {
  Moments moments;
  for (const double x : values) moments.mean += x / static_cast<double>(values.size());
  for (const double x : values) {
    const double d = x - moments.mean;
    moments.variance += d * d / static_cast<double>(values.size());
  }
  return moments;
}

ImagerParams sixteen_bits() {
  ImagerParams params;
  params.exposure_s = 1e-3;
  params.bits = 16;
  params.full_well_e = 10'000.0;
  return params;
}

TEST(Imager, PhotonTransferHasTheSlopeOfTheGain) {
  ImagerParams params = sixteen_bits();
  params.dsnu_e = params.prnu = 0.0;
  params.read_noise_e = 5.0;
  Imager imager(params, kSide, kSide, 1, Eigen::Vector3f::Ones(), RandomStream(1, "", "pattern"));
  const double gain = 65535.0 / params.full_well_e;  // numbers per electron
  QuickNormals noise(RandomStream(2, "", "noise"));
  Picture reading = picture_of(Picture::Format::kMono16), truth = reading;
  std::vector<float> light(kPixels);
  for (const float radiance : {2e-4f, 1e-3f, 2e-3f}) {
    std::fill(light.begin(), light.end(), radiance);
    imager.expose(light, noise, reading, truth);
    const Moments m = moments_of(numbers_of(reading));
    // EMVA 1288: variance = gain^2 read noise^2 + gain (mean).
    const double expected = gain * gain * 25.0 + gain * m.mean;
    // Of n numbers the variance has a relative standard deviation of sqrt(2 / n).
    EXPECT_NEAR(m.variance / expected, 1.0, 4.0 * std::sqrt(2.0 / kPixels)) << radiance;
    EXPECT_NEAR(m.mean, numbers_of(truth)[0], 5.0 * std::sqrt(expected / kPixels)) << radiance;
  }
}

TEST(Imager, ElectronsAreThoseOfThePhotometry) {
  // A white wall in 100 klx has pi L = 1e5 lx; behind f/2.8 the image has L pi / (4 N^2) = 3189 lx,
  // and a pixel of 3.45 um gets 3189 x 4091 x 11.9 = 1.55e8 photons a second.
  ImagerParams params = sixteen_bits();
  params.noise = false;
  params.exposure_s = 5e-5;
  params.quantum_efficiency = 0.5;
  Imager imager(params, kSide, kSide, 1, Eigen::Vector3f::Ones(), RandomStream(1, "", "pattern"));
  QuickNormals noise(RandomStream(2, "", "noise"));
  Picture reading = picture_of(Picture::Format::kMono16), truth = reading;
  const std::vector<float> light(kPixels, static_cast<float>(100.0 / 128.0 / 3.14159265));
  imager.expose(light, noise, reading, truth);
  const double electrons = numbers_of(truth)[0] / 65535.0 * params.full_well_e;
  EXPECT_NEAR(electrons, 0.5 * 1.5529e8 * 5e-5, 5.0);
}

TEST(Imager, ColoursShowTheNumbersOfTheConverter) {
  // With 8 bits a number more or less is a level of the picture, or several in the dark.
  ImagerParams params;
  params.noise = false;
  params.bits = 8;
  params.exposure_s = 5e-5;
  params.quantum_efficiency = 0.5;
  Imager imager(params, kSide, kSide, 3, Eigen::Vector3f::Ones(), RandomStream(1, "", "pattern"));
  QuickNormals noise(RandomStream(2, "", "noise"));
  Picture reading = picture_of(Picture::Format::kRgb8), truth = reading;
  // As above: radiance 100 / 128 / pi gives 0.5 x 1.5529e8 electrons a second.
  const double electrons = 0.5 * 1.5529e8 * 5e-5 * 128.0 / 100.0 * 3.14159265;
  for (const int number : {0, 1, 7, 60, 128, 255}) {
    const double radiance = number / 255.0 * params.full_well_e / electrons;
    const std::vector<float> light(3 * kPixels, static_cast<float>(radiance));
    imager.expose(light, noise, reading, truth);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(truth.data[c], std::lround(255.0 * srgb_from_linear(number / 255.0))) << number;
      EXPECT_EQ(reading.data[3 * kPixels - 1 - c], truth.data[c]) << number;
    }
  }
}

TEST(Imager, PixelsDifferByDsnuAndPrnu) {
  ImagerParams params = sixteen_bits();
  params.read_noise_e = 0.0;
  params.dsnu_e = 20.0;
  params.prnu = 0.02;
  Imager imager(params, kSide, kSide, 1, Eigen::Vector3f::Ones(), RandomStream(1, "", "pattern"));
  QuickNormals noise(RandomStream(2, "", "noise"));
  Picture reading = picture_of(Picture::Format::kMono16), truth = reading;
  const std::vector<float> light(kPixels, 2e-3f);
  // The mean of many pictures leaves the pattern.
  std::vector<double> sum(kPixels, 0.0);
  constexpr int kPictures = 64;
  for (int i = 0; i < kPictures; ++i) {
    imager.expose(light, noise, reading, truth);
    const std::vector<double> numbers = numbers_of(reading);
    for (std::size_t k = 0; k < kPixels; ++k) sum[k] += numbers[k] / kPictures;
  }
  const Moments m = moments_of(sum);
  const double gain = 65535.0 / params.full_well_e, mean_e = m.mean / gain;
  const double pattern_e2 = 20.0 * 20.0 + 0.02 * 0.02 * mean_e * mean_e;
  const double rest_e2 = mean_e / kPictures;
  EXPECT_NEAR(m.variance / (gain * gain * (pattern_e2 + rest_e2)), 1.0,
              4.0 * std::sqrt(2.0 / kPixels));
}

TEST(Imager, ColoursAreWhiteWhereTheLightIs) {
  ImagerParams params;
  params.noise = false;
  const Eigen::Vector3f white(0.30f, 0.28f, 0.20f);  // late in the day
  Imager imager(params, kSide, kSide, 3, white, RandomStream(1, "", "pattern"));
  QuickNormals noise(RandomStream(2, "", "noise"));
  Picture reading = picture_of(Picture::Format::kRgb8), truth = reading;
  std::vector<float> light(3 * kPixels);
  for (std::size_t i = 0; i < light.size(); ++i) light[i] = 0.18f * white[i % 3];
  imager.expose(light, noise, reading, truth);
  // The whole picture is grey, and is exposed to 18 % of the range.
  const double expected = 255.0 * srgb_from_linear(0.18);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(reading.data[c], expected, 1.5) << c;
}

TEST(Imager, ExposesForTheScene) {
  ImagerParams params;
  params.noise = false;
  Imager imager(params, kSide, kSide, 1, Eigen::Vector3f::Ones(), RandomStream(1, "", "pattern"));
  QuickNormals noise(RandomStream(2, "", "noise"));
  Picture reading = picture_of(Picture::Format::kMono16), truth = reading;
  const std::vector<float> bright(kPixels, 0.05f), dim(kPixels, 0.005f), dark(kPixels, 1e-6f);
  imager.expose(bright, noise, reading, truth);
  const double bright_s = imager.exposure_s();
  EXPECT_NEAR(numbers_of(truth)[0] / 65535.0, params.brightness, 0.01);
  imager.expose(dim, noise, reading, truth);
  EXPECT_NEAR(imager.exposure_s() / bright_s, 10.0, 0.05);
  imager.expose(dark, noise, reading, truth);
  EXPECT_EQ(imager.exposure_s(), params.exposure_max_s);
}

TEST(Imager, CornersGetLessLight) {
  ImagerParams params = sixteen_bits();
  params.noise = false;
  params.corner_light = 0.6;
  Imager imager(params, kSide, kSide, 1, Eigen::Vector3f::Ones(), RandomStream(1, "", "pattern"));
  QuickNormals noise(RandomStream(2, "", "noise"));
  Picture reading = picture_of(Picture::Format::kMono16), truth = reading;
  imager.expose(std::vector<float>(kPixels, 1e-3f), noise, reading, truth);
  const std::vector<double> numbers = numbers_of(truth);
  EXPECT_NEAR(numbers[0] / numbers[kPixels / 2 + kSide / 2], 0.6, 0.01);
}

TEST(QuickNormals, AreNormal) {
  QuickNormals draws(RandomStream(3, "", "draws"));
  double sum = 0.0, squares = 0.0, fourth = 0.0;
  constexpr int kCount = 400'000;
  for (int i = 0; i < kCount; ++i) {
    const double x = draws.next();
    sum += x / kCount;
    squares += x * x / kCount;
    fourth += x * x * x * x / kCount;
  }
  EXPECT_NEAR(sum, 0.0, 5.0 / std::sqrt(kCount));
  EXPECT_NEAR(squares, 1.0, 5.0 * std::sqrt(2.0 / kCount) + 1e-3);
  // Quantiles in the middle of their shares cut the tails off at 3.7: a little less than 3.
  EXPECT_NEAR(fourth, 3.0, 0.05);
}

}  // namespace
}  // namespace vinerow::sensors::imager_test
