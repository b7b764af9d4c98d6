#include "engine/imaging/jpeg.h"

#include <csetjmp>
#include <cstdio>  // before jpeglib.h, which needs it
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include <jpeglib.h>

#include "engine/core/check.h"

namespace vinerow::imaging {
namespace {

struct JpegErrors {
  jpeg_error_mgr manager;  // first, so that its address is that of the whole
  std::jmp_buf back;
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

}  // namespace vinerow::imaging
