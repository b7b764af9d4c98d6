#include "controllers/planning/search/quartile_list.h"

#include <algorithm>

#include "engine/core/check.h"

namespace vinerow::controllers {

void QuartileList::Counts::add(int bucket, int change) {
  total += change;
  for (int i = bucket + 1; i <= kBuckets; i += i & -i) sums[i] += change;
}

int QuartileList::Counts::up_to(int bucket) const {
  int count = 0;
  for (int i = bucket + 1; i > 0; i -= i & -i) count += sums[i];
  return count;
}

int QuartileList::Counts::find(int rank) const {
  int at = 0;
  for (int step = kBuckets; step > 0; step /= 2) {
    if (at + step <= kBuckets && sums[at + step] <= rank) {
      at += step;
      rank -= sums[at];
    }
  }
  return at;
}

QuartileList::QuartileList(bool quartiles) : quartiles_(quartiles), members_(kBuckets) {}

int QuartileList::add(double distance_m) {
  VINEROW_ASSERT(distance_m >= 0.0);
  const int node = static_cast<int>(bucket_.size());
  const int bucket = static_cast<int>(std::min(distance_m / kBucket_m, kBuckets - 1.0));
  bucket_.push_back(bucket);
  place_.push_back(static_cast<int>(members_[bucket].size()));
  members_[bucket].push_back(node);
  all_.add(bucket, 1);
  open_.add(bucket, 1);
  return node;
}

void QuartileList::close(int node) {
  const int place = place_[node];
  if (place < 0) return;
  std::vector<int>& members = members_[bucket_[node]];
  members[place] = members.back();
  place_[members[place]] = place;
  members.pop_back();
  place_[node] = -1;
  open_.add(bucket_[node], -1);
}

std::array<int, 4> QuartileList::quartile_buckets() const {
  VINEROW_DEMAND(all_.total > 0);
  std::array<int, 4> upper;
  for (int q = 0; q < 4; ++q) {
    // Last rank of the quartile: its share of the nodes, rounded up, is at or below it.
    const int count = static_cast<int>((static_cast<std::int64_t>(q + 1) * all_.total + 3) / 4);
    upper[q] = all_.find(count - 1);
  }
  return upper;
}

int QuartileList::draw(RandomStream& random) const {
  if (open_.total == 0) return -1;
  int first = 0, count = open_.total;  // ranks among the open nodes, in order of distance
  if (quartiles_) {
    int below = 0;
    for (const int bucket : quartile_buckets()) {
      const int up_to = open_.up_to(bucket);
      if (up_to > below) {
        first = below;
        count = up_to - below;
        break;
      }
      below = up_to;
    }
  }
  const int rank = first + std::min(static_cast<int>(random.uniform() * count), count - 1);
  const int bucket = open_.find(rank);
  const int before = bucket == 0 ? 0 : open_.up_to(bucket - 1);
  return members_[bucket][rank - before];
}

}  // namespace vinerow::controllers
