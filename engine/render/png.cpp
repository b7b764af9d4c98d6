#include "engine/render/png.h"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <stdexcept>
#include <string>

#include "engine/core/hash.h"
#include "engine/core/whole_file.h"
#include "engine/render/scene.h"

namespace vinerow::render {

namespace {

void append_bytes(png_structp png, png_bytep bytes, std::size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(bytes), count);
}

/// libpng leaves by longjmp, so nothing with a destructor may live in this function's frame.
bool encode(png_structp png, png_infop info, std::string* out, const Image& image) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_write_fn(png, out, &append_bytes, nullptr);
  // Level 2 with the SUB filter: a quarter of the default's time at about the same size for
  // rendered pictures.
  png_set_compression_level(png, 2);
  png_set_filter(png, 0, PNG_FILTER_SUB);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  for (int y = 0; y < image.height; ++y) {
    png_write_row(png, &image.rgb[static_cast<std::size_t>(y) * image.width * 3]);
  }
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

void write_png(const std::string& file, const Image& image) {
  if (image.width < 1 || image.height < 1 ||
      image.rgb.size() != static_cast<std::size_t>(image.width) * image.height * 3) {
    throw std::runtime_error(fmt::format("{}: an image of {} x {} pixels with {} bytes is no image",
                                         file, image.width, image.height, image.rgb.size()));
  }
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const bool encoded = encode(png, info, &bytes, image);
  png_destroy_write_struct(&png, &info);
  if (!encoded) throw std::runtime_error(fmt::format("{}: cannot be encoded", file));
  write_whole_file(file, bytes);
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

std::string image_digest(const Image& image) {
  Hasher hasher;
  hasher.add(image.width);
  hasher.add(image.height);
  hasher.add_bytes(image.rgb.data(), image.rgb.size());
  return hasher.hex();
}

}  // namespace vinerow::render
