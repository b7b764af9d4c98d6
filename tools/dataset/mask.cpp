#include "tools/dataset/mask.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace vinerow::dataset {

Mask make_mask(std::span<const std::uint32_t> pixels, int picture_height) {
  Mask mask;
  const auto h = static_cast<std::uint32_t>(picture_height);
  std::uint32_t next = 0;  // pixel after the last run inside
  int top = std::numeric_limits<int>::max(), bottom = -1;
  for (const std::uint32_t pixel : pixels) {
    if (mask.runs.empty() || pixel != next) {
      mask.runs.push_back(pixel - next);
      mask.runs.push_back(0);
    }
    ++mask.runs.back();
    next = pixel + 1;
    const int y = static_cast<int>(pixel % h);
    top = std::min(top, y);
    bottom = std::max(bottom, y);
  }
  mask.left = static_cast<int>(pixels.front() / h);
  mask.top = top;
  mask.width = static_cast<int>(pixels.back() / h) - mask.left + 1;
  mask.height = bottom - top + 1;
  mask.area = static_cast<int>(pixels.size());
  return mask;
}

std::string coco_counts(const Mask& mask, std::uint32_t pixels) {
  std::vector<std::int64_t> runs(mask.runs.begin(), mask.runs.end());
  const std::int64_t rest = pixels - std::accumulate(runs.begin(), runs.end(), std::int64_t{0});
  if (rest > 0) runs.push_back(rest);
  std::string text;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::int64_t value = i > 2 ? runs[i] - runs[i - 2] : runs[i];
    for (bool is_more = true; is_more;) {
      std::int64_t bits = value & 0x1f;
      value >>= 5;
      // Done when the rest is only the sign of the group's highest bit.
      is_more = (bits & 0x10) != 0 ? value != -1 : value != 0;
      if (is_more) bits |= 0x20;
      text += static_cast<char>(bits + 48);
    }
  }
  return text;
}

}  // namespace vinerow::dataset
