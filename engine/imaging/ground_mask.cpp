#include "engine/imaging/ground_mask.h"

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"

namespace vinerow::imaging {

namespace {

constexpr double kFade_m = 2.4;  // length over which tracks fade beyond the end of an alley

void stamp_line(GroundMask& mask, const std::vector<Eigen::Vector3d>& line, int channel) {
  const Eigen::Array2d cell(mask.size_m.x() / mask.pixels.width,
                            mask.size_m.y() / mask.pixels.height);
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Eigen::Vector2d a = line[k].head<2>();
    const Eigen::Vector2d b = line[k + 1].head<2>();
    const Eigen::Vector2d along = b - a;
    const double length2 = std::max(along.squaredNorm(), 1e-12);
    const Eigen::Array2d low =
        (a.cwiseMin(b).array() - GroundMask::kReach_m - mask.corner_W.array()) / cell;
    const Eigen::Array2d high =
        (a.cwiseMax(b).array() + GroundMask::kReach_m - mask.corner_W.array()) / cell;
    const int x0 = std::max(0, static_cast<int>(low.x()));
    const int y0 = std::max(0, static_cast<int>(low.y()));
    const int x1 = std::min(mask.pixels.width - 1, static_cast<int>(high.x()) + 1);
    const int y1 = std::min(mask.pixels.height - 1, static_cast<int>(high.y()) + 1);
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const Eigen::Vector2d p =
            mask.corner_W + Eigen::Vector2d((x + 0.5) * cell.x(), (y + 0.5) * cell.y());
        const double share = (p - a).dot(along) / length2;
        // Alleys are extended straight and fade out; a round end would give rings of tracks.
        const double over = kFade_m / std::sqrt(length2);
        const bool alley = channel == 1;
        const double low_t = alley && k == 0 ? -over : 0.0;
        const double high_t = alley && k + 2 == line.size() ? 1.0 + over : 1.0;
        if (alley && (share < low_t || share > high_t)) continue;
        const double t = std::clamp(share, low_t, high_t);
        if (alley) {
          const double beyond = std::max({0.0, -t, t - 1.0}) / over;
          std::uint8_t& inside = mask.pixels.at(x, y)[2];
          inside = std::max(inside, static_cast<std::uint8_t>(std::lround(255.0 * (1.0 - beyond))));
        }
        const double d = (p - a - t * along).norm();
        const auto value = static_cast<std::uint8_t>(
            std::min(255L, std::lround(d * 255.0 / GroundMask::kReach_m)));
        std::uint8_t& stored = mask.pixels.at(x, y)[channel];
        stored = std::min(stored, value);
      }
    }
  }
}

void clear(Pixels& pixels) {
  for (int i = 0; i < pixels.width * pixels.height; ++i) {
    std::uint8_t* p = &pixels.rgba[4 * static_cast<std::size_t>(i)];
    p[0] = p[1] = p[3] = 255;
    p[2] = 0;
  }
}

}  // namespace

double GroundMask::lookup(double x, double y, int channel) const {
  const double u = (x - corner_W.x()) / size_m.x() * pixels.width;
  const double v = (y - corner_W.y()) / size_m.y() * pixels.height;
  if (!(u >= 0.0 && v >= 0.0 && u < pixels.width && v < pixels.height)) return kReach_m;
  return pixels.at(static_cast<int>(u), static_cast<int>(v))[channel] * (kReach_m / 255.0);
}

GroundMask make_ground_mask(const RowMap& rows) {
  GroundMask mask;
  Eigen::AlignedBox2d box;
  for (const PlantRow& row : rows.rows) {
    for (const Eigen::Vector3d& p : row.line_W) box.extend(Eigen::Vector2d(p.head<2>()));
  }
  for (const Alley& alley : rows.alleys) {
    for (const Eigen::Vector3d& p : alley.line_W) box.extend(Eigen::Vector2d(p.head<2>()));
  }
  if (box.isEmpty()) {
    mask.pixels = Pixels(1, 1);
    clear(mask.pixels);
    return mask;
  }
  const double border = GroundMask::kReach_m + 0.5;
  mask.corner_W = box.min().array() - border;
  mask.size_m = box.sizes().array() + 2.0 * border;
  constexpr double kWantedCell_m = 0.12;
  mask.pixels = Pixels(texture_side(mask.size_m.x() / kWantedCell_m),
                       texture_side(mask.size_m.y() / kWantedCell_m));
  clear(mask.pixels);
  for (const PlantRow& row : rows.rows) stamp_line(mask, row.line_W, 0);
  for (const Alley& alley : rows.alleys) stamp_line(mask, alley.line_W, 1);
  return mask;
}

}  // namespace vinerow::imaging
