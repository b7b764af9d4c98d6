/// Images as files, and their digest. The tests of PNG itself are in tests/engine/imaging.

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "engine/core/random.h"
#include "engine/imaging/png.h"
#include "engine/render/scene.h"
#include "tests/support/paths.h"

namespace vinerow::render::image_file_test {
namespace {

std::string temporary_file(const std::string& name) {
  const auto folder = std::filesystem::path(VINEROW_BINARY_DIR) / "test_output";
  std::filesystem::create_directories(folder);
  return (folder / name).string();
}

Image random_image(int width, int height) {
  RandomStream random(7, "test", "png");
  Image image{width, height, {}};
  for (int i = 0; i < width * height * 3; ++i) {
    image.rgb.push_back(static_cast<std::uint8_t>(random.uniform(0.0, 256.0)));
  }
  return image;
}

TEST(ImageFile, HoldsPixelsAndWords) {
  const Image image = random_image(7, 4);
  const std::string file = temporary_file("image_file.png");
  const std::map<std::string, std::string> words = {{"Comment", "two"}};
  write_png(file, image, words);
  EXPECT_EQ(imaging::read_png_words(file), words);
  const auto pixels = imaging::read_png(file);
  ASSERT_TRUE(pixels.ok()) << pixels.reason();
  ASSERT_EQ(pixels->width, 7);
  ASSERT_EQ(pixels->height, 4);
  for (int i = 0; i < 7 * 4; ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(pixels->rgba[4 * i + c], image.rgb[3 * i + c]);
  }
}

TEST(ImageFile, AnImageWithTooFewBytesIsRefused) {
  try {
    write_png(temporary_file("image_refused.png"), Image{3, 3, {1, 2, 3}});
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("3 x 3 pixels with 3 bytes are not a valid image"),
              std::string::npos);
  }
}

TEST(ImageDigest, TellsSizeAndEveryPixel) {
  Image image = random_image(4, 6);
  const std::string digest = image_digest(image);
  EXPECT_EQ(digest.size(), 32u);
  EXPECT_EQ(digest, image_digest(random_image(4, 6)));
  std::swap(image.width, image.height);
  EXPECT_NE(digest, image_digest(image));
  std::swap(image.width, image.height);
  image.rgb[71] ^= 1;
  EXPECT_NE(digest, image_digest(image));
}

}  // namespace
}  // namespace vinerow::render::image_file_test
