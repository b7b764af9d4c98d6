#pragma once
/// Heat map of a metric over two factors: one tile per pair of levels, coloured by its value.

#include <cstdint>
#include <string>
#include <vector>

#include "tools/study/plots/frame.h"
#include "tools/study/plots/marks.h"
#include "tools/study/plots/quantity.h"

namespace vinerow::study {

/// Tile of one pair of levels.
struct HeatTile {
  double value = kNoValue;                 ///< NaN: hatched
  double low = kNoValue, high = kNoValue;  ///< its interval, if known
  std::string note;                        ///< reason of a missing value, or a note
  std::int64_t cell = kNoCell;
};

struct HeatMap {
  PlotTexts texts;
  Quantity x, y, value;
  std::vector<std::string> x_levels;  ///< from left to right
  std::vector<std::string> y_levels;  ///< from bottom to top
  std::vector<HeatTile> tiles;        ///< tiles[y * x_levels.size() + x]
};

/// Maximum number of tiles; beyond it the figure contains a sentence instead.
inline constexpr std::size_t kMaxTiles = 20'000;

/// <figure>; "" if a factor has no level.
/// @pre tiles.size() == x_levels.size() * y_levels.size()
std::string heat_map(const HeatMap& map);

}  // namespace vinerow::study
