#include "engine/imaging/jpeg.h"

#include <fmt/format.h>

#include <cerrno>
#include <csetjmp>
#include <cstdio>  // before jpeglib.h, which needs it
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>

#include <jpeglib.h>

#include "engine/core/check.h"

namespace vinerow::imaging {
namespace {

struct JpegErrors {
  jpeg_error_mgr manager;  // first, so that its address is that of the whole
  std::jmp_buf back;
  char message[JMSG_LENGTH_MAX];  // of the error, or of the first warning
};

[[noreturn]] void give_up(j_common_ptr jpeg) {
  std::longjmp(reinterpret_cast<JpegErrors*>(jpeg->err)->back, 1);
}

/// libjpeg returns from errors by longjmp, so this function's frame must not hold objects with
/// destructors.
bool compress(jpeg_compress_struct& jpeg, JpegErrors& errors, const Pixels& pixels, int quality,
              std::span<const std::string> segments, unsigned char** bytes, unsigned long* size) {
  if (setjmp(errors.back) != 0) return false;
  jpeg_create_compress(&jpeg);
  jpeg_mem_dest(&jpeg, bytes, size);
  jpeg.image_width = static_cast<JDIMENSION>(pixels.width);
  jpeg.image_height = static_cast<JDIMENSION>(pixels.height);
  jpeg.input_components = 4;
  jpeg.in_color_space = JCS_EXT_RGBX;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, quality, TRUE);
  jpeg.optimize_coding = TRUE;
  jpeg_start_compress(&jpeg, TRUE);
  for (const std::string& segment : segments) {
    jpeg_write_marker(&jpeg, JPEG_APP0 + 1, reinterpret_cast<const JOCTET*>(segment.data()),
                      static_cast<unsigned>(segment.size()));
  }
  while (jpeg.next_scanline < jpeg.image_height) {
    // libjpeg does not change the row.
    auto* row = const_cast<JSAMPLE*>(pixels.at(0, static_cast<int>(jpeg.next_scanline)));
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  return true;
}

/// Keeps the text of the first warning, and prints none.
void note_warning(j_common_ptr jpeg, int level) {
  if (level >= 0) return;  // not a warning
  if (jpeg->err->num_warnings++ == 0) {
    jpeg->err->format_message(jpeg, reinterpret_cast<JpegErrors*>(jpeg->err)->message);
  }
}

/// As compress(). @returns false after an error or a warning
bool decompress(jpeg_decompress_struct& jpeg, JpegErrors& errors, std::FILE* in, Pixels& pixels) {
  if (setjmp(errors.back) != 0) {
    errors.manager.format_message(reinterpret_cast<j_common_ptr>(&jpeg), errors.message);
    return false;
  }
  jpeg_create_decompress(&jpeg);
  jpeg_stdio_src(&jpeg, in);
  jpeg_read_header(&jpeg, TRUE);
  jpeg.out_color_space = JCS_EXT_RGBX;
  jpeg_start_decompress(&jpeg);
  pixels.width = static_cast<int>(jpeg.output_width);
  pixels.height = static_cast<int>(jpeg.output_height);
  pixels.rgba.assign(std::size_t{4} * jpeg.output_width * jpeg.output_height, 255);
  while (jpeg.output_scanline < jpeg.output_height) {
    JSAMPLE* row = pixels.at(0, static_cast<int>(jpeg.output_scanline));
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_decompress(&jpeg);
  return errors.manager.num_warnings == 0;
}

}  // namespace

std::string encode_jpeg(const Pixels& pixels, int quality, std::span<const std::string> segments) {
  VINEROW_DEMAND(pixels.width > 0 && pixels.height > 0 && pixels.width < 65'536 &&
                 pixels.height < 65'536 && quality >= 1 && quality <= 100);
  jpeg_compress_struct jpeg{};
  JpegErrors errors{};
  jpeg.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = &give_up;
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const bool compressed = compress(jpeg, errors, pixels, quality, segments, &bytes, &size);
  jpeg_destroy_compress(&jpeg);
  const std::unique_ptr<unsigned char, decltype(&std::free)> held(bytes, &std::free);
  if (!compressed) throw std::runtime_error("a picture cannot be encoded as JPEG");
  return {reinterpret_cast<const char*>(bytes), size};
}

Result<Pixels> read_jpeg(const std::string& file) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"),
                                                           &std::fclose);
  if (!in) return Failure{fmt::format("{}: {}", file, std::strerror(errno))};
  jpeg_decompress_struct jpeg{};
  JpegErrors errors{};
  jpeg.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = &give_up;
  errors.manager.emit_message = &note_warning;
  Pixels pixels;
  const bool is_read = decompress(jpeg, errors, in.get(), pixels);
  jpeg_destroy_decompress(&jpeg);
  if (!is_read) return Failure{fmt::format("{}: {}", file, errors.message)};
  for (std::size_t i = 3; i < pixels.rgba.size(); i += 4) pixels.rgba[i] = 255;
  return pixels;
}

}  // namespace vinerow::imaging
