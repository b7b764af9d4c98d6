/// Pictures of camera sensors as PNG and back, and by libpng's own reader.

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <utility>

#include "engine/core/random.h"
#include "engine/imaging/picture_codec.h"

namespace vinerow::imaging::picture_codec_test {
namespace {

Picture random_picture(Picture::Format format, std::uint32_t width, std::uint32_t height) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  picture.format = format;
  picture.data.resize(std::size_t{width} * height * Picture::bytes_per_pixel(format));
  RandomStream random(5, "", "picture");
  for (std::uint8_t& byte : picture.data) byte = static_cast<std::uint8_t>(random.next_u64());
  return picture;
}

TEST(PictureCodec, KeepsEveryByte) {
  for (const auto format :
       {Picture::Format::kRgb8, Picture::Format::kMono8, Picture::Format::kMono16}) {
    for (const auto& [width, height] :
         {std::pair{37u, 21u}, {1u, 1u}, {1u, 50u}, {50u, 1u}, {700u, 500u}}) {
      Picture picture = random_picture(format, width, height);
      for (const bool is_even : {false, true}) {
        // Long runs of equal bytes, which are compressed otherwise than noise.
        if (is_even) std::fill(picture.data.begin() + 1, picture.data.end(), std::uint8_t{9});
        Picture back;
        ASSERT_TRUE(decode_picture(encode_picture(picture), back));
        EXPECT_EQ(back.width, width);
        EXPECT_EQ(back.height, height);
        EXPECT_EQ(back.format, format);
        EXPECT_EQ(back.data, picture.data);
      }
    }
  }
}

TEST(PictureCodec, OtherReadersSeeTheSameNumbers) {
  const Picture picture = random_picture(Picture::Format::kMono16, 8, 4);
  const std::string bytes = encode_picture(picture);
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()), 0);
  EXPECT_EQ(header.width, 8u);
  EXPECT_EQ(header.height, 4u);
  // Sixteen bits a channel, the higher byte first in the file: linear light to libpng.
  header.format = PNG_FORMAT_LINEAR_Y;
  std::vector<std::uint16_t> values(32);
  header.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  ASSERT_NE(png_image_finish_read(&header, nullptr, values.data(), 0, nullptr), 0);
  // sRGB to linear keeps the order of the values.
  std::vector<std::uint16_t> own;
  for (std::size_t i = 0; i < 32; ++i) {
    own.push_back(static_cast<std::uint16_t>(picture.data[2 * i] | picture.data[2 * i + 1] << 8));
  }
  for (std::size_t i = 0; i < 32; ++i) {
    for (std::size_t k = 0; k < 32; ++k) {
      if (own[i] < own[k]) {
        EXPECT_LE(values[i], values[k]);
      }
    }
  }
}

TEST(PictureCodec, RefusesWhatIsNoPicture) {
  Picture picture = random_picture(Picture::Format::kRgb8, 5, 5);
  const std::string whole = encode_picture(picture);
  Picture back;
  EXPECT_FALSE(decode_picture("", back));
  EXPECT_FALSE(decode_picture("no PNG", back));
  for (std::size_t size = 0; size + 20 < whole.size(); size += 7) {
    EXPECT_FALSE(decode_picture(std::string_view(whole).substr(0, size), back)) << size;
  }
  picture.data.pop_back();
  EXPECT_EQ(encode_picture(picture), "");
  EXPECT_EQ(encode_picture(Picture{}), "");
}

}  // namespace
}  // namespace vinerow::imaging::picture_codec_test
