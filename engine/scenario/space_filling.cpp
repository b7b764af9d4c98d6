#include "engine/scenario/space_filling.h"

#include <boost/random/sobol.hpp>
#include <utility>

#include "engine/core/check.h"
#include "engine/core/random.h"

namespace vinerow::scenario {

std::vector<std::vector<double>> latin_hypercube(std::size_t count, std::size_t dimensions,
                                                 std::uint64_t seed) {
  std::vector<std::vector<double>> points(count, std::vector<double>(dimensions));
  RandomStream stream(seed, "study", "latin_hypercube");
  std::vector<std::size_t> slices(count);
  for (std::size_t k = 0; k < dimensions; ++k) {
    // A random order of the slices (Fisher-Yates shuffle), then a random position in each.
    for (std::size_t i = 0; i < count; ++i) slices[i] = i;
    for (std::size_t i = count; i > 1; --i) {
      const double drawn = stream.uniform();
      std::swap(slices[i - 1], slices[static_cast<std::size_t>(drawn * static_cast<double>(i))]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double place = static_cast<double>(slices[i]) + stream.uniform();
      points[i][k] = place / static_cast<double>(count);
    }
  }
  return points;
}

std::vector<std::vector<double>> sobol_points(std::size_t count, std::size_t dimensions) {
  VINEROW_DEMAND(dimensions >= 1 && dimensions <= kMaxSobolDimensions);
  boost::random::sobol sequence(dimensions);
  std::vector<std::vector<double>> points(count, std::vector<double>(dimensions));
  constexpr double kWords = 0x1p64;
  for (auto& point : points) {
    // Use the 53 leading bits, so that the quotient stays below 1.
    for (double& x : point) x = static_cast<double>(sequence() >> 11 << 11) / kWords;
  }
  return points;
}

}  // namespace vinerow::scenario
