#pragma once
/// Space-filling samples of the unit cube.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vinerow::scenario {

/// Latin hypercube sample: for each coordinate, each of `count` equal slices contains one point at
/// a random position (McKay, Beckman, Conover, Technometrics 21(2), 1979). The same on every
/// machine.
/// @returns [point][dimension], each in [0, 1)
std::vector<std::vector<double>> latin_hypercube(std::size_t count, std::size_t dimensions,
                                                 std::uint64_t seed);

inline constexpr std::size_t kMaxSobolDimensions = 100;

/// Points 1 to `count` of the Sobol sequence (USSR Comput. Math. 7(4), 1967) with the direction
/// numbers of Joe and Kuo (SIAM J. Sci. Comput. 30(5), 2008); point 0, the origin, is omitted. A
/// larger `count` continues the same sequence. @pre dimensions in 1..kMaxSobolDimensions
/// @returns [point][dimension], each in [0, 1)
std::vector<std::vector<double>> sobol_points(std::size_t count, std::size_t dimensions);

}  // namespace vinerow::scenario
