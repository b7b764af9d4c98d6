#pragma once
/// A plain detector of posts and stems in laser scans, for tests: clusters that stand alone, taken
/// for circles of known radius, put together over many scans.

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/api/messages/sensors.h"

namespace vinerow::test {

class PostDetector {
 public:
  struct Post {
    Eigen::Vector2d p_W;
    int sightings = 0;
  };

  /// Adds what one scan shows, at its true pose.
  void add(const LaserScan& scan) {
    const std::size_t count = scan.ranges_m.size();
    std::size_t begin = 0;
    while (begin < count) {
      std::size_t end = begin + 1;
      if (std::isfinite(scan.ranges_m[begin])) {
        while (end < count && std::abs(scan.ranges_m[end] - scan.ranges_m[end - 1]) < kSame_m)
          ++end;
        if (begin > 0 && end < count) consider(scan, begin, end);
      }
      begin = end;
    }
  }

  /// Seen at least so often.
  std::vector<Post> posts(int min_sightings) const {
    std::vector<Post> result;
    std::copy_if(posts_.begin(), posts_.end(), std::back_inserter(result),
                 [&](const Post& post) { return post.sightings >= min_sightings; });
    return result;
  }

 private:
  static constexpr double kSame_m = 0.1;      // along the ray, between neighbours of a cluster
  static constexpr double kRadius_m = 0.03;   // of posts and stems alike
  static constexpr double kWidest_m = 0.16;   // an end post is 0.12 m thick
  static constexpr double kFarthest_m = 4.0;  // beyond, a post is two beams wide
  static constexpr std::size_t kFewest = 3;   // beams
  static constexpr double kMerge_m = 0.25;

  void consider(const LaserScan& scan, std::size_t begin, std::size_t end) {
    if (end - begin < kFewest) return;
    // What stands alone has nothing before it on either side.
    const double left_m = scan.ranges_m[end], right_m = scan.ranges_m[begin - 1];
    double sum_m = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum_m += scan.ranges_m[i];
    const double mean_m = sum_m / static_cast<double>(end - begin);
    if (mean_m > kFarthest_m || left_m < mean_m || right_m < mean_m) return;
    const double span_rad = static_cast<double>(end - begin) * scan.angle_step_rad;
    if (span_rad * mean_m > kWidest_m) return;
    // Beams spread evenly over a circle's front meet it pi/4 of its radius before its middle.
    const double middle =
        scan.first_angle_rad + 0.5 * static_cast<double>(begin + end - 1) * scan.angle_step_rad;
    const double r = mean_m + 0.785 * kRadius_m;
    const Eigen::Vector3d p_W =
        scan.X_WS * Eigen::Vector3d(r * std::cos(middle), r * std::sin(middle), 0.0);
    merge(p_W.head<2>());
  }

  void merge(const Eigen::Vector2d& p_W) {
    Post* nearest = nullptr;
    double best_m = kMerge_m;
    for (Post& post : posts_) {
      const double distance_m = (post.p_W - p_W).norm();
      if (distance_m < best_m) best_m = distance_m, nearest = &post;
    }
    if (nearest == nullptr) nearest = &posts_.emplace_back(Post{p_W, 0});
    ++nearest->sightings;
    nearest->p_W += (p_W - nearest->p_W) / nearest->sightings;
  }

  std::vector<Post> posts_;
};

}  // namespace vinerow::test
