#pragma once
/// Open nodes of a search tree, drawn at random from the lowest non-empty quartile of distance
/// (paper A, section 4.1, after eq. 22).
///
/// The quartiles are those of all nodes ever added, open or not. A quartile whose nodes are all
/// closed is skipped; if all four are, the tree is exhausted. Distances are kept in buckets of 5 cm
/// with counts in Fenwick trees (Fenwick, "A new data structure for cumulative frequency tables",
/// Software: Practice and Experience 24, 1994), so that adding, closing and drawing cost a few
/// dozen steps, whatever the number of nodes.

#include <array>
#include <cstdint>
#include <vector>

#include "engine/core/random.h"

namespace vinerow::controllers {

class QuartileList {
 public:
  static constexpr double kBucket_m = 0.05;

  /// @param quartiles  false: all open nodes are drawn with the same chance
  explicit QuartileList(bool quartiles);

  /// Adds a node; numbers are assigned in order: 0, 1, 2, ... @param distance_m  >= 0, may be
  /// infinite
  /// @returns the new node's number; it is open
  int add(double distance_m);
  /// @pre the node was added. Closing twice is allowed.
  void close(int node);
  int open_count() const { return open_.total; }
  /// Upper ends of the quartiles, as bucket numbers. @pre a node was added
  std::array<int, 4> quartile_buckets() const;

  /// @returns an open node of the lowest quartile that has one, each with the same chance; -1 if
  /// nothing is open
  int draw(RandomStream& random) const;

 private:
  static constexpr int kBuckets = 1 << 13;  // up to 409 m; farther nodes are in the last bucket

  /// Counts per bucket with prefix sums.
  struct Counts {
    std::vector<int> sums = std::vector<int>(kBuckets + 1, 0);
    int total = 0;
    void add(int bucket, int change);
    int up_to(int bucket) const;  // buckets 0 .. bucket
    int find(int rank) const;     // bucket of the rank-th, from 0
  };

  bool quartiles_;
  Counts all_, open_;
  std::vector<int> bucket_;                // of each node
  std::vector<int> place_;                 // of each node in its bucket's list; -1 = closed
  std::vector<std::vector<int>> members_;  // open nodes of each bucket
};

}  // namespace vinerow::controllers
