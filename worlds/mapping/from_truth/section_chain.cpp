#include "worlds/mapping/from_truth/section_chain.h"

#include <algorithm>
#include <cmath>

#include "engine/core/check.h"
#include "engine/math/angles.h"

namespace vinerow::mapping {
namespace {

std::vector<double> blend(const std::vector<double>& a, const std::vector<double>& b,
                          double share) {
  std::vector<double> result(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) result[k] = (1.0 - share) * a[k] + share * b[k];
  return result;
}

}  // namespace

std::vector<double> level_shares(int count) {
  VINEROW_DEMAND(count >= 2);
  std::vector<double> shares;
  for (int k = 0; k < count; ++k) {
    shares.push_back(0.5 - 0.5 * std::cos(kPi * k / (count - 1)));
  }
  return shares;
}

CanopyCut cut_at(const SectionChain& chain, double s_m) {
  VINEROW_DEMAND(!chain.empty());
  const auto after = std::find_if(chain.begin(), chain.end(),
                                  [&](const CanopyCut& cut) { return cut.s_m >= s_m; });
  CanopyCut result = after == chain.end() ? chain.back() : *after;
  if (after != chain.begin() && after != chain.end()) {
    const CanopyCut &a = *(after - 1), &b = *after;
    const double share = (s_m - a.s_m) / (b.s_m - a.s_m);
    result.base_m = (1.0 - share) * a.base_m + share * b.base_m;
    result.top_m = (1.0 - share) * a.top_m + share * b.top_m;
    result.left_m = blend(a.left_m, b.left_m, share);
    result.right_m = blend(a.right_m, b.right_m, share);
  }
  result.s_m = s_m;
  return result;
}

void keep_open(SectionChain& chain) {
  constexpr double kMinWidth_m = 0.04, kMinHeight_m = 0.1;
  for (CanopyCut& cut : chain) {
    cut.top_m = std::max(cut.top_m, cut.base_m + kMinHeight_m);
    for (std::size_t k = 0; k < cut.left_m.size(); ++k) {
      const double lacks_m = kMinWidth_m - (cut.left_m[k] + cut.right_m[k]);
      if (lacks_m > 0.0) {
        cut.left_m[k] += 0.5 * lacks_m;
        cut.right_m[k] += 0.5 * lacks_m;
      }
    }
  }
}

TriangleMesh make_chain_hull(const SectionChain& chain, const RowCurve& row,
                             const GroundHeight& ground) {
  VINEROW_DEMAND(chain.size() >= 2);
  const std::size_t levels = chain.front().left_m.size();
  const std::vector<double> shares = level_shares(static_cast<int>(levels));
  TriangleMesh mesh;
  for (const CanopyCut& cut : chain) {
    const Eigen::Vector2d middle = row.point_W(cut.s_m), ahead = row.direction_W(cut.s_m);
    const Eigen::Vector2d left(-ahead.y(), ahead.x());
    const double ground_m = ground(middle.x(), middle.y());
    const auto add = [&](std::size_t level, double across_m) {
      const Eigen::Vector2d p = middle + across_m * left;
      const double z = ground_m + cut.base_m + shares[level] * (cut.top_m - cut.base_m);
      mesh.vertices.push_back(Eigen::Vector3d(p.x(), p.y(), z).cast<float>());
    };
    // Seen against the row's direction from its start: up the right side, down the left.
    for (std::size_t k = 0; k < levels; ++k) add(k, -cut.right_m[k]);
    for (std::size_t k = levels; k-- > 0;) add(k, cut.left_m[k]);
  }
  const auto ring = static_cast<std::uint32_t>(2 * levels);
  const auto last = static_cast<std::uint32_t>(chain.size() - 1) * ring;
  for (std::uint32_t first = 0; first < last; first += ring) {
    for (std::uint32_t k = 0; k < ring; ++k) {
      const std::uint32_t a = first + k, b = first + (k + 1) % ring;
      mesh.triangles.push_back({a, a + ring, b + ring});
      mesh.triangles.push_back({a, b + ring, b});
    }
  }
  // Ends as ladders of levels: a fan from one corner would fold where a section is hollow.
  const auto side = static_cast<std::uint32_t>(levels);
  for (std::uint32_t k = 0; k + 1 < side; ++k) {
    const std::uint32_t right = k, right_up = k + 1, left = ring - 1 - k, left_up = ring - 2 - k;
    mesh.triangles.push_back({right, right_up, left_up});
    mesh.triangles.push_back({right, left_up, left});
    mesh.triangles.push_back({last + right, last + left_up, last + right_up});
    mesh.triangles.push_back({last + right, last + left, last + left_up});
  }
  return mesh;
}

}  // namespace vinerow::mapping
