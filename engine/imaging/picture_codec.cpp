#include "engine/imaging/picture_codec.h"

#include <png.h>

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstring>

#include "engine/imaging/png_encoder.h"

namespace vinerow::imaging {
namespace {

static_assert(std::endian::native == std::endian::little,
              "16-bit pictures have the lower byte first");

struct Source {
  std::string_view bytes;
  std::size_t at = 0;
};

void take_bytes(png_structp png, png_bytep bytes, std::size_t count) {
  auto& source = *static_cast<Source*>(png_get_io_ptr(png));
  if (count > source.bytes.size() - source.at) png_error(png, "the file ends too early");
  std::memcpy(bytes, source.bytes.data() + source.at, count);
  source.at += count;
}

void jump_out(png_structp png, png_const_charp) {
  png_longjmp(png, 1);
}
void drop_warning(png_structp, png_const_charp) {}

/// libpng returns from errors by longjmp, so this function's frame must not hold objects with
/// destructors.
bool read_rows(png_structp png, png_infop info, Source* source, Picture* picture) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_read_fn(png, source, &take_bytes);
  png_read_info(png, info);
  const int depth = png_get_bit_depth(png, info);
  const int colours = png_get_color_type(png, info);
  if (colours == PNG_COLOR_TYPE_RGB && depth == 8) {
    picture->format = Picture::Format::kRgb8;
  } else if (colours == PNG_COLOR_TYPE_GRAY && depth == 8) {
    picture->format = Picture::Format::kMono8;
  } else if (colours == PNG_COLOR_TYPE_GRAY && depth == 16) {
    picture->format = Picture::Format::kMono16;
    png_set_swap(png);
  } else {
    return false;
  }
  picture->width = png_get_image_width(png, info);
  picture->height = png_get_image_height(png, info);
  const std::size_t row = picture->width * Picture::bytes_per_pixel(picture->format);
  // A file cannot hold more than deflate's thousandfold; a forged size must not take memory.
  constexpr std::size_t kMostPerByte = 1100;
  if (row * picture->height > kMostPerByte * source->bytes.size()) return false;
  picture->data.resize(row * picture->height);
  for (std::uint32_t y = 0; y < picture->height; ++y) {
    png_read_row(png, &picture->data[y * row], nullptr);
  }
  return true;
}

}  // namespace

std::string encode_picture(const Picture& picture) {
  const std::size_t size =
      std::size_t{picture.width} * picture.height * Picture::bytes_per_pixel(picture.format);
  if (size == 0 || picture.data.size() != size) return {};
  PngForm form{static_cast<int>(picture.width), static_cast<int>(picture.height)};
  form.channels = picture.format == Picture::Format::kRgb8 ? 3 : 1;
  form.bytes_per_channel = Picture::bytes_per_pixel(picture.format) == 2 ? 2 : 1;
  form.differences = picture.format != Picture::Format::kMono8;
  return encode_png_rows(form, picture.data);
}

bool decode_picture(std::string_view bytes, Picture& picture) {
  Source source{bytes};
  png_structp png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, &jump_out, &drop_warning);
  png_infop info = png_create_info_struct(png);
  const bool is_decoded = read_rows(png, info, &source, &picture);
  png_destroy_read_struct(&png, &info, nullptr);
  return is_decoded;
}

}  // namespace vinerow::imaging
