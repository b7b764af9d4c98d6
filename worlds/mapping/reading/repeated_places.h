#pragma once
/// Number of points of a cloud that coincide exactly with another one.

#include <Eigen/Core>
#include <bit>
#include <cstdint>
#include <vector>

namespace vinerow::mapping {

/// Counts points whose three numbers equal those of an earlier point. Up to kMax places are all
/// remembered; beyond that, only those whose 64-bit hash ends in one, two, ... zero bits. Equal
/// points have equal hashes, so that a remembered place counts all of its points, and the total
/// follows from the share of remembered places: with an error of 4 % (1 sigma) if 1 % of many
/// millions are repeated once. Memory is 4 MB (8 MB for moments) for any cloud.
///
/// Source: Gibbons, "Distinct sampling for highly-accurate answers to distinct values queries",
/// VLDB 2001.
class RepeatedPlaces {
 public:
  static constexpr std::size_t kMax = 1 << 17;

  RepeatedPlaces();
  void add(const Eigen::Vector3d& place) {
    const std::uint64_t hash = hash_of(place);
    if ((hash & skipped_) == 0) remember(hash, 1);
  }
  std::uint64_t count() const;  ///< an estimate unless is_exact()
  bool is_exact() const { return skipped_ == 0; }

 private:
  struct Slot {
    std::uint64_t hash = 0;  // 0: free
    std::uint64_t points = 0;
  };
  static std::uint64_t hash_of(const Eigen::Vector3d& place) {
    std::uint64_t hash = 0;
    for (int k = 0; k < 3; ++k) {
      // Adding zero makes -0.0 and 0.0 the same. Constants: splitmix64 (Steele, Lea, Flood,
      // OOPSLA 2014).
      hash = (hash ^ std::bit_cast<std::uint64_t>(place[k] + 0.0)) * 0xbf58476d1ce4e5b9u;
      hash = (hash ^ (hash >> 31)) * 0x94d049bb133111ebu;
      hash ^= hash >> 29;
    }
    return hash;
  }
  void remember(std::uint64_t hash, std::uint64_t points);
  void thin();

  std::vector<Slot> slots_;  // open addressing, by the hash's upper bits
  std::size_t places_ = 0;
  std::uint64_t skipped_ = 0;  // bits that must be 0 in a hash to be remembered
};

}  // namespace vinerow::mapping
