#pragma once
/// Quick encoder of PNG (ISO/IEC 15948). libdeflate compresses the rows of a rendered picture in
/// half of zlib's time and to fewer bytes, and libpng cannot use it. Files are read by libpng.

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>

namespace vinerow::imaging {

struct PngForm {
  int width = 0, height = 0;
  int channels = 3;           ///< 3: RGB, 1: grey
  int bytes_per_channel = 1;  ///< 2: the lower byte first, in `rows`
  /// Store differences to the pixel on the left: smaller for photographs, not for runs of equal
  /// labels.
  bool differences = true;

  std::size_t row_bytes() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels) *
           static_cast<std::size_t>(bytes_per_channel);
  }
};

/// @param rows   the pixels, top row first; form.height times form.row_bytes() (demanded)
/// @param words  stored before the pixels (chunks tEXt), by keyword of 1 to 79 letters
/// @returns the file; equal pixels give equal bytes
std::string encode_png_rows(const PngForm& form, std::span<const std::uint8_t> rows,
                            const std::map<std::string, std::string>& words = {});

}  // namespace vinerow::imaging
