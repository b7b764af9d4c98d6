#pragma once
/// Points that fill a unit cube evenly with few of them.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vinerow::scenario {

/// Of each coordinate one point lies in each of `count` equal slices, anywhere in it (McKay,
/// Beckman, Conover, Technometrics 21(2), 1979). The same on every machine.
/// @returns [point][dimension], each in [0, 1)
std::vector<std::vector<double>> latin_hypercube(std::size_t count, std::size_t dimensions,
                                                 std::uint64_t seed);

inline constexpr std::size_t kMostSobolDimensions = 100;

/// The points 1 to `count` of the sequence of Sobol (USSR Comput. Math. 7(4), 1967) with the
/// direction numbers of Joe and Kuo (SIAM J. Sci. Comput. 30(5), 2008); point 0 is the corner at 0.
/// More points continue the same sequence. @pre dimensions in 1..kMostSobolDimensions
/// @returns [point][dimension], each in [0, 1)
std::vector<std::vector<double>> sobol_points(std::size_t count, std::size_t dimensions);

}  // namespace vinerow::scenario
