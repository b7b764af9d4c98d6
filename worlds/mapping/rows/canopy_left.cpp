#include "worlds/mapping/rows/canopy_left.h"

#include <algorithm>
#include <cmath>

namespace vinerow::mapping {

std::vector<CanopyLeft> find_canopy_left(const CanopyRaster& raster, const RowLocator& rows,
                                         double min_m2) {
  // Coarse squares join what gaps of a metre or two part: a row that was left out is one piece, not
  // a hundred vines. A square with less canopy than a leaf or two joins nothing.
  constexpr double kSquare_m = 2.0, kFewest_m2 = 0.1;
  const auto count = [&](int cells) {
    return static_cast<int>(std::ceil(cells * raster.cell_m / kSquare_m)) + 1;
  };
  const int columns = count(raster.columns), lines = count(raster.rows);
  std::vector<double> area_m2(static_cast<std::size_t>(columns) * lines, 0.0);
  const double cell_m2 = raster.cell_m * raster.cell_m;
  // Canopy of each square that no row has.
  for (int j = 0; j < raster.rows; ++j) {
    for (int i = 0; i < raster.columns; ++i) {
      const float weight = raster.weights[static_cast<std::size_t>(j) * raster.columns + i];
      if (weight <= 0.0f) continue;
      const Eigen::Vector2d p = raster.middle_of(i, j);
      if (rows.locate(p.x(), p.y()).row >= 0) continue;
      const Eigen::Vector2d at = (p - raster.corner) / kSquare_m;
      area_m2[static_cast<std::size_t>(at.y()) * columns + static_cast<std::size_t>(at.x())] +=
          cell_m2;
    }
  }
  // Squares that touch, at corners too, are one piece; what is counted is emptied.
  std::vector<CanopyLeft> pieces;
  std::vector<std::pair<int, int>> open;
  for (int j = 0; j < lines; ++j) {
    for (int i = 0; i < columns; ++i) {
      CanopyLeft piece;
      piece.low = raster.corner + kSquare_m * Eigen::Vector2d(i, j);
      piece.high = piece.low;
      open.assign(1, {i, j});
      while (!open.empty()) {
        const auto [h, v] = open.back();
        open.pop_back();
        if (h < 0 || v < 0 || h >= columns || v >= lines) continue;
        double& here_m2 = area_m2[static_cast<std::size_t>(v) * columns + h];
        if (here_m2 < kFewest_m2) continue;
        piece.area_m2 += here_m2;
        here_m2 = 0.0;
        const Eigen::Vector2d corner = raster.corner + kSquare_m * Eigen::Vector2d(h, v);
        piece.low = piece.low.cwiseMin(corner);
        piece.high = piece.high.cwiseMax(corner + Eigen::Vector2d::Constant(kSquare_m));
        for (int dv = -1; dv <= 1; ++dv) {
          for (int dh = -1; dh <= 1; ++dh) {
            if (dh != 0 || dv != 0) open.emplace_back(h + dh, v + dv);
          }
        }
      }
      if (piece.area_m2 >= min_m2) pieces.push_back(piece);
    }
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const CanopyLeft& a, const CanopyLeft& b) { return a.area_m2 > b.area_m2; });
  return pieces;
}

}  // namespace vinerow::mapping
