#include "engine/imaging/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

#include "engine/imaging/jpeg.h"
#include "engine/imaging/png.h"
#include "engine/math/srgb.h"

namespace vinerow::imaging {

Result<Pixels> read_image(const std::string& file) {
  std::string head(8, '\0');
  {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"),
                                                             &std::fclose);
    if (!in) return Failure{fmt::format("{}: {}", file, std::strerror(errno))};
    head.resize(std::fread(head.data(), 1, head.size(), in.get()));
  }
  if (head.starts_with("\xff\xd8\xff")) return read_jpeg(file);
  if (head.starts_with("\x89PNG\r\n\x1a\n")) return read_png(file);
  return Failure{file + ": is neither PNG nor JPEG"};
}

Texture::Texture(const Pixels& pixels) {
  std::array<std::uint16_t, 256> linear;
  for (std::size_t i = 0; i < linear.size(); ++i) {
    linear[i] = static_cast<std::uint16_t>(
        std::lround(65535.0 * linear_from_srgb(static_cast<double>(i) / 255.0)));
  }
  Level first{pixels.width, pixels.height, {}};
  first.linear.reserve(pixels.rgba.size() / 4);
  for (std::size_t i = 0; i + 3 < pixels.rgba.size(); i += 4) {
    first.linear.push_back(
        {linear[pixels.rgba[i]], linear[pixels.rgba[i + 1]], linear[pixels.rgba[i + 2]]});
  }
  levels_.push_back(std::move(first));
  // Each level has half the size of the one before, and the mean of four of its pixels.
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& from = levels_.back();
    Level to{std::max(1, from.width / 2), std::max(1, from.height / 2), {}};
    to.linear.reserve(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height));
    for (int y = 0; y < to.height; ++y) {
      for (int x = 0; x < to.width; ++x) {
        std::array<std::uint32_t, 3> sum{};
        for (int k = 0; k < 4; ++k) {
          const int sx = std::min(2 * x + (k & 1), from.width - 1);
          const int sy = std::min(2 * y + (k >> 1), from.height - 1);
          const auto& pixel =
              from.linear[static_cast<std::size_t>(sy) * static_cast<std::size_t>(from.width) +
                          static_cast<std::size_t>(sx)];
          for (std::size_t c = 0; c < 3; ++c) sum[c] += pixel[c];
        }
        std::array<std::uint16_t, 3> mean{};
        for (std::size_t c = 0; c < 3; ++c) mean[c] = static_cast<std::uint16_t>((sum[c] + 2) / 4);
        to.linear.push_back(mean);
      }
    }
    levels_.push_back(std::move(to));
  }
}

Eigen::Vector3f Texture::sample(const Level& level, double u, double v) {
  // Between the middles of four pixels; the row counts down, v up.
  const double x = (u - std::floor(u)) * level.width - 0.5;
  const double y = (1.0 - (v - std::floor(v))) * level.height - 0.5;
  const double left = std::floor(x), top = std::floor(y);
  const auto right_share = static_cast<float>(x - left), low_share = static_cast<float>(y - top);
  const auto wrapped = [](double value, int size) {
    const int i = static_cast<int>(value) % size;
    return static_cast<std::size_t>(i < 0 ? i + size : i);
  };
  const auto at = [&](double column, double row) {
    const auto& p =
        level.linear[wrapped(row, level.height) * static_cast<std::size_t>(level.width) +
                     wrapped(column, level.width)];
    return Eigen::Vector3f(p[0], p[1], p[2]);
  };
  const Eigen::Vector3f upper = at(left, top) + right_share * (at(left + 1.0, top) - at(left, top));
  const Eigen::Vector3f lower =
      at(left, top + 1.0) + right_share * (at(left + 1.0, top + 1.0) - at(left, top + 1.0));
  return (upper + low_share * (lower - upper)) / 65535.0f;
}

Eigen::Vector3f Texture::colour(double u, double v, double spot) const {
  if (!std::isfinite(u) || !std::isfinite(v)) return Eigen::Vector3f::Zero();
  // The level whose pixels are as wide as the spot, mixed from the two beside it.
  const double pixels = spot * std::sqrt(static_cast<double>(levels_[0].width) * levels_[0].height);
  const double last = static_cast<double>(levels_.size() - 1);
  const double level = pixels > 1.0 ? std::min(std::log2(pixels), last) : 0.0;
  const auto fine = static_cast<std::size_t>(level);
  const auto coarse_share = static_cast<float>(level - std::floor(level));
  const Eigen::Vector3f near = sample(levels_[fine], u, v);
  if (coarse_share == 0.0f) return near;
  return near + coarse_share * (sample(levels_[fine + 1], u, v) - near);
}

}  // namespace vinerow::imaging
