/// Pictures on surfaces against closed forms, and JPEG files against libjpeg's own encoder.

#include "engine/imaging/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "engine/core/whole_file.h"
#include "engine/imaging/jpeg.h"
#include "engine/imaging/png.h"
#include "engine/math/srgb.h"
#include "tests/support/paths.h"

namespace vinerow::imaging::texture_test {
namespace {

using Eigen::Vector3f;

std::filesystem::path output(const std::string& name) {
  const auto folder = std::filesystem::path(VINEROW_BINARY_DIR) / "test_output";
  std::filesystem::create_directories(folder);
  return folder / name;
}

/// Black and white upper row, red and green lower one.
Pixels four_colours() {
  Pixels pixels(2, 2);
  const std::uint8_t values[] = {0, 0, 0, 255, 255, 255, 255, 255, 200, 0, 0, 255, 0, 100, 0, 255};
  std::memcpy(pixels.rgba.data(), values, sizeof values);
  return pixels;
}

TEST(Texture, LowerLeftCornerIsZero) {
  const Texture texture(four_colours());
  const auto red = static_cast<float>(linear_from_srgb(200.0 / 255.0));
  const auto green = static_cast<float>(linear_from_srgb(100.0 / 255.0));
  EXPECT_TRUE(texture.colour(0.25, 0.25, 0.0).isApprox(Vector3f(red, 0, 0), 1e-3f));
  EXPECT_TRUE(texture.colour(0.75, 0.25, 0.0).isApprox(Vector3f(0, green, 0), 1e-3f));
  EXPECT_LT(texture.colour(0.25, 0.75, 0.0).norm(), 1e-4f);
  EXPECT_TRUE(texture.colour(0.75, 0.75, 0.0).isApprox(Vector3f::Ones(), 1e-3f));
  // It repeats.
  EXPECT_TRUE(texture.colour(-2.75, 5.25, 0.0).isApprox(Vector3f(red, 0, 0), 1e-3f));
}

TEST(Texture, MixesLightNotNumbers) {
  const Texture texture(four_colours());
  // Halfway between black and white: half the light.
  EXPECT_NEAR(texture.colour(0.5, 0.75, 0.0).x(), 0.5f, 1e-3f);
  // All of it: the mean of four.
  const auto red = static_cast<float>(linear_from_srgb(200.0 / 255.0));
  EXPECT_NEAR(texture.colour(0.3, 0.9, 1.0).x(), (1.0f + red) / 4.0f, 1e-3f);
  EXPECT_NEAR(texture.colour(0.3, 0.9, 100.0).z(), 0.25f, 1e-3f);
}

TEST(Texture, FinerDetailThanTheSpotIsAveraged) {
  // Stripes one pixel wide.
  Pixels stripes(64, 64);
  for (std::size_t i = 0; i < stripes.rgba.size(); ++i) {
    stripes.rgba[i] = i % 4 == 3 ? 255 : (i / 4) % 2 == 0 ? 0 : 255;
  }
  const Texture texture(stripes);
  double sharp = 0.0, wide = 0.0;
  for (int i = 0; i < 64; ++i) {
    sharp = std::max(sharp, std::abs(texture.colour((i + 0.5) / 64, 0.4, 0.0).x() - 0.5));
    wide = std::max(wide, std::abs(texture.colour((i + 0.5) / 64, 0.4, 2.0 / 64).x() - 0.5));
  }
  EXPECT_NEAR(sharp, 0.5, 1e-3);
  EXPECT_LT(wide, 1e-3);
}

TEST(ReadImage, ReadsPngAndJpegByTheirFirstBytes) {
  Pixels pixels(48, 32);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 48; ++x) {
      const std::uint8_t rgba[] = {static_cast<std::uint8_t>(5 * x),
                                   static_cast<std::uint8_t>(7 * y), 90, 255};
      std::memcpy(pixels.at(x, y), rgba, 4);
    }
  }
  // The endings do not matter.
  write_whole_file(output("texture_a.jpg"), encode_png(pixels));
  write_whole_file(output("texture_b.png"), encode_jpeg(pixels, 98));
  const Result<Pixels> a = read_image(output("texture_a.jpg").string());
  const Result<Pixels> b = read_image(output("texture_b.png").string());
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->rgba, pixels.rgba);
  ASSERT_EQ(b->rgba.size(), pixels.rgba.size());
  for (std::size_t i = 0; i < pixels.rgba.size(); ++i) {
    EXPECT_NEAR(b->rgba[i], pixels.rgba[i], 6) << i;
  }
}

TEST(ReadImage, SaysWhatIsWrong) {
  const std::string jpeg = encode_jpeg(Pixels(64, 64), 90);
  const auto reason = [&](const std::string& bytes) {
    const std::string file = output("texture_faults").string();
    write_whole_file(file, bytes);
    const Result<Pixels> read = read_image(file);
    return read ? std::string("none") : read.reason().substr(file.size());
  };
  EXPECT_EQ(reason("GIF89a"), ": is neither PNG nor JPEG");
  EXPECT_EQ(reason(""), ": is neither PNG nor JPEG");
  EXPECT_EQ(reason(jpeg.substr(0, jpeg.size() - 20)), ": Premature end of JPEG file");
  EXPECT_NE(reason(jpeg.substr(0, 4)), "none");
  const std::string absent = output("absent.png").string();
  EXPECT_EQ(read_image(absent).reason(), absent + ": No such file or directory");
}

}  // namespace
}  // namespace vinerow::imaging::texture_test
