#include "engine/imaging/png.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <vector>

#include "engine/core/random.h"
#include "tests/support/paths.h"

namespace vinerow::imaging::png_test {
namespace {

std::string temporary_file(const std::string& name) {
  const auto folder = std::filesystem::path(VINEROW_BINARY_DIR) / "test_output";
  std::filesystem::create_directories(folder);
  return (folder / name).string();
}

std::string bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::vector<std::uint8_t> random_rgb(int width, int height) {
  RandomStream random(7, "test", "png");
  std::vector<std::uint8_t> rgb;
  for (int i = 0; i < width * height * 3; ++i) {
    rgb.push_back(static_cast<std::uint8_t>(random.uniform(0.0, 256.0)));
  }
  return rgb;
}

TEST(Png, LibpngReadsBackEveryPixel) {
  const std::vector<std::uint8_t> rgb = random_rgb(37, 23);
  const std::string file = temporary_file("round_trip.png");
  write_png(file, 37, 23, rgb);
  // The decoder is libpng's own, used directly.
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&header, file.c_str()));
  header.format = PNG_FORMAT_RGB;
  ASSERT_EQ(header.width, 37u);
  ASSERT_EQ(header.height, 23u);
  std::vector<std::uint8_t> read(37 * 23 * 3);
  ASSERT_TRUE(png_image_finish_read(&header, nullptr, read.data(), 0, nullptr));
  EXPECT_EQ(read, rgb);
}

TEST(Png, WordsStandInTheFileAndAreReadBack) {
  const std::vector<std::uint8_t> rgb = random_rgb(9, 5);
  const std::string file = temporary_file("words.png");
  const std::map<std::string, std::string> words = {{"vinerow:seen", "rover 0.25\ndrone 0\n"},
                                                    {"Comment", "two"}};
  write_png(file, 9, 5, rgb, words);
  EXPECT_EQ(read_png_words(file), words);
  // As the format has it: keyword, a zero byte, the text (PNG specification 11.3.4.3).
  EXPECT_NE(bytes_of(file).find(std::string("tEXtComment\0two", 15)), std::string::npos);
  const auto pixels = read_png(file);
  ASSERT_TRUE(pixels.ok());
  EXPECT_EQ(pixels->at(3, 2)[0], rgb[(2 * 9 + 3) * 3]);
  write_png(file, 9, 5, rgb);
  EXPECT_TRUE(read_png_words(file).empty());
}

TEST(Png, AFileThatIsNoPngHasNoWords) {
  const std::string file = temporary_file("no.png");
  EXPECT_TRUE(read_png_words(temporary_file("absent.png")).empty());
  for (const char* bytes : {"", "no picture", "\x89PNG\r\n\x1a\n and then nothing"}) {
    std::ofstream(file, std::ios::binary) << bytes;
    EXPECT_TRUE(read_png_words(file).empty());
  }
}

TEST(Png, SameImageGivesTheSameFileWithoutTimeStamp) {
  const std::vector<std::uint8_t> rgb = random_rgb(16, 16);
  write_png(temporary_file("a.png"), 16, 16, rgb);
  write_png(temporary_file("b.png"), 16, 16, rgb);
  const std::string bytes = bytes_of(temporary_file("a.png"));
  EXPECT_EQ(bytes, bytes_of(temporary_file("b.png")));
  EXPECT_EQ(bytes.find("tIME"), std::string::npos);
}

TEST(Png, ReadsWhatItWrites) {
  const std::vector<std::uint8_t> rgb = random_rgb(5, 9);
  const std::string file = temporary_file("small.png");
  write_png(file, 5, 9, rgb);
  const Result<Pixels> pixels = read_png(file);
  ASSERT_TRUE(pixels.ok()) << pixels.reason();
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 5; ++x) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(pixels->at(x, y)[c], rgb[static_cast<std::size_t>(y * 5 + x) * 3 + c]);
      }
      EXPECT_EQ(pixels->at(x, y)[3], 255);
    }
  }
}

TEST(Png, FailuresNameTheFile) {
  const std::vector<std::uint8_t> rgb = random_rgb(2, 2);
  try {
    write_png("/nonexistent_folder/x.png", 2, 2, rgb);
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "'/nonexistent_folder/x.png' cannot be written: No such file or directory");
  }
  try {
    write_png(temporary_file("x.png"), 3, 3, std::vector<std::uint8_t>{1, 2, 3});
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("3 x 3 pixels with 3 bytes are not a valid image"),
              std::string::npos);
  }
  const Result<Pixels> missing = read_png("/nonexistent_folder/x.png");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.reason().find("/nonexistent_folder/x.png: "), 0u);
}

}  // namespace
}  // namespace vinerow::imaging::png_test
