#pragma once
/// A metric over two factors: a tile for each pair of levels, coloured by its value.

#include <cstdint>
#include <string>
#include <vector>

#include "tools/study/plots/frame.h"
#include "tools/study/plots/marks.h"
#include "tools/study/plots/quantity.h"

namespace vinerow::study {

/// One pair of levels.
struct HeatTile {
  double value = kNoValue;                 ///< NaN: hatched
  double low = kNoValue, high = kNoValue;  ///< its interval, where known
  std::string note;                        ///< why there is no value, or more about it
  std::int64_t cell = kNoCell;
};

struct HeatMap {
  PlotTexts texts;
  Quantity x, y, value;
  std::vector<std::string> x_levels;  ///< from left to right
  std::vector<std::string> y_levels;  ///< from bottom to top
  std::vector<HeatTile> tiles;        ///< tiles[y * x_levels.size() + x]
};

/// More tiles than this are not drawn: the figure says so.
inline constexpr std::size_t kMostTiles = 20'000;

/// <figure>; "" where a factor has no level.
/// @pre tiles.size() == x_levels.size() * y_levels.size()
std::string heat_map(const HeatMap& map);

}  // namespace vinerow::study
