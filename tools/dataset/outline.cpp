#include "tools/dataset/outline.h"

#include <array>
#include <cstdint>
#include <limits>
#include <utility>

namespace vinerow::dataset {
namespace {

using Eigen::Vector2i;
using Ring = std::vector<Vector2i>;

// Right, down, left, up. A pixel's edges are followed in this order, so that it lies to the right.
constexpr int kDirections = 4;
const Vector2i kStep[kDirections] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};

/// The edges between a mask's pixels and others, by the corner where they begin.
class Edges {
 public:
  Edges(const Mask& mask, int picture_height)
      : mask_(mask),
        inside_(static_cast<std::size_t>(mask.width) * static_cast<std::size_t>(mask.height)),
        leaving_(static_cast<std::size_t>(mask.width + 1) *
                 static_cast<std::size_t>(mask.height + 1)) {
    mark_pixels(picture_height);
    for (int y = 0; y < mask.height; ++y) {
      for (int x = 0; x < mask.width; ++x) {
        if (!is_inside(x, y)) continue;
        if (!is_inside(x, y - 1)) add({x, y}, 0);
        if (!is_inside(x + 1, y)) add({x + 1, y}, 1);
        if (!is_inside(x, y + 1)) add({x + 1, y + 1}, 2);
        if (!is_inside(x - 1, y)) add({x, y + 1}, 3);
      }
    }
  }

  /// Takes all edges, as rings of corners. The order is that of their first corners.
  std::vector<Ring> take_rings() {
    std::vector<Ring> rings;
    for (int y = 0; y <= mask_.height; ++y) {
      for (int x = 0; x <= mask_.width; ++x) {
        while (leaving_[corner({x, y})] != 0) rings.push_back(take_ring({x, y}));
      }
    }
    return rings;
  }

 private:
  bool is_inside(int x, int y) const {
    return x >= 0 && y >= 0 && x < mask_.width && y < mask_.height &&
           inside_[static_cast<std::size_t>(y * mask_.width + x)];
  }
  std::size_t corner(const Vector2i& p) const {
    return static_cast<std::size_t>(p.y() * (mask_.width + 1) + p.x());
  }
  void add(const Vector2i& from, int direction) {
    leaving_[corner(from)] |= static_cast<std::uint8_t>(1 << direction);
  }

  void mark_pixels(int picture_height) {
    std::size_t pixel = 0;
    for (std::size_t run = 0; run < mask_.runs.size(); ++run) {
      for (std::uint32_t i = 0; i < mask_.runs[run]; ++i, ++pixel) {
        if (run % 2 == 0) continue;
        const int x = static_cast<int>(pixel) / picture_height - mask_.left;
        const int y = static_cast<int>(pixel) % picture_height - mask_.top;
        inside_[static_cast<std::size_t>(y * mask_.width + x)] = true;
      }
    }
  }

  Ring take_ring(const Vector2i& first) {
    Ring ring;
    Vector2i at = first;
    int direction = -1;
    do {
      // Where two pixels touch by a corner, the ring goes on around its own one.
      int next = direction < 0 ? 0 : (direction + 1) % kDirections;
      while (((leaving_[corner(at)] >> next) & 1) == 0) {
        next = direction < 0 ? next + 1 : (next + kDirections - 1) % kDirections;
      }
      leaving_[corner(at)] &= static_cast<std::uint8_t>(~(1 << next));
      if (next != direction) ring.push_back(at + Vector2i(mask_.left, mask_.top));
      direction = next;
      at += kStep[direction];
    } while (at != first);
    return ring;
  }

  const Mask& mask_;
  std::vector<bool> inside_;
  std::vector<std::uint8_t> leaving_;  ///< a bit for each direction
};

/// Puts a ring into a polygon, at the corners of both that are nearest to each other.
void link_ring(Ring& polygon, const Ring& ring) {
  std::size_t here = 0, there = 0;
  int least = std::numeric_limits<int>::max();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    for (std::size_t j = 0; j < ring.size(); ++j) {
      const int distance = (polygon[i] - ring[j]).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      here = i;
      there = j;
    }
  }
  Ring way;  // to the ring, around it, and back
  way.insert(way.end(), ring.begin() + static_cast<std::ptrdiff_t>(there), ring.end());
  way.insert(way.end(), ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(there) + 1);
  way.push_back(polygon[here]);
  polygon.insert(polygon.begin() + static_cast<std::ptrdiff_t>(here) + 1, way.begin(), way.end());
}

}  // namespace

std::vector<Vector2i> outline_of(const Mask& mask, int picture_height) {
  const std::vector<Ring> rings = Edges(mask, picture_height).take_rings();
  Ring polygon = rings.front();
  for (std::size_t k = 1; k < rings.size(); ++k) link_ring(polygon, rings[k]);
  return polygon;
}

}  // namespace vinerow::dataset
