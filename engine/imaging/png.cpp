#include "engine/imaging/png.h"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/core/whole_file.h"
#include "engine/imaging/png_encoder.h"

namespace vinerow::imaging {

namespace {

/// libpng returns from errors by longjmp, so this function's frame must not hold objects with
/// destructors. @returns the number of texts; 0 if the file cannot be read
int read_words(png_structp png, png_infop info, std::FILE* file, png_textp* words) {
  if (setjmp(png_jmpbuf(png))) return 0;
  png_init_io(png, file);
  png_read_info(png, info);
  int count = 0;
  png_get_text(png, info, words, &count);
  return count;
}

void ignore_png_warning(png_structp png, png_const_charp) {
  png_longjmp(png, 1);
}
void ignore(png_structp, png_const_charp) {}

}  // namespace

std::map<std::string, std::string> read_png_words(const std::string& file) {
  std::map<std::string, std::string> read;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"),
                                                           &std::fclose);
  if (!in) return read;
  png_structp png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, &ignore_png_warning, &ignore);
  png_infop info = png_create_info_struct(png);
  png_textp words = nullptr;
  const int count = read_words(png, info, in.get(), &words);
  for (int i = 0; i < count; ++i) read[words[i].key] = words[i].text;
  png_destroy_read_struct(&png, &info, nullptr);
  return read;
}

void write_png(const std::string& file, int width, int height, std::span<const std::uint8_t> rgb,
               const std::map<std::string, std::string>& words) {
  if (width < 1 || height < 1 || rgb.size() != static_cast<std::size_t>(width) * height * 3) {
    throw std::runtime_error(fmt::format("{}: {} x {} pixels with {} bytes are not a valid image",
                                         file, width, height, rgb.size()));
  }
  write_whole_file(file, encode_png_rows({.width = width, .height = height}, rgb, words));
}

Result<Pixels> read_png(const std::string& file) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&header, file.c_str())) {
    return Failure{fmt::format("{}: {}", file, header.message)};
  }
  header.format = PNG_FORMAT_RGBA;
  Pixels pixels(static_cast<int>(header.width), static_cast<int>(header.height));
  if (!png_image_finish_read(&header, nullptr, pixels.rgba.data(), 0, nullptr)) {
    return Failure{fmt::format("{}: {}", file, header.message)};
  }
  return pixels;
}

std::string encode_png(const Pixels& pixels) {
  bool opaque = true;
  for (std::size_t i = 3; opaque && i < pixels.rgba.size(); i += 4) opaque = pixels.rgba[i] == 255;
  std::vector<std::uint8_t> rgb;
  if (opaque) {
    rgb.reserve(pixels.rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < pixels.rgba.size(); i += 4) {
      rgb.insert(rgb.end(), {pixels.rgba[i], pixels.rgba[i + 1], pixels.rgba[i + 2]});
    }
  }
  const std::uint8_t* data = opaque ? rgb.data() : pixels.rgba.data();
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(pixels.width);
  header.height = static_cast<png_uint_32>(pixels.height);
  header.format = opaque ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(header), '\0');
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, data, 0, nullptr)) {
    throw std::runtime_error(fmt::format("an image of {} x {} pixels cannot be encoded: {}",
                                         pixels.width, pixels.height, header.message));
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace vinerow::imaging
