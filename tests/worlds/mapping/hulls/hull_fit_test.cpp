/// Hulls fitted to boxes of points, where volume and cost are known in closed form.

#include "worlds/mapping/hulls/hull_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/random.h"
#include "engine/math/angles.h"

namespace vinerow::mapping::hull_fit_test {
namespace {

using Eigen::Vector3f;

/// Sides of a box: down, right, up, left in the (y, z) plane. Their lengths do not depend on their
/// own offsets, so that the volume is linear in each offset.
HullDirections box_directions() {
  return HullDirections({-0.5 * kPi, 0.0, 0.5 * kPi, kPi});
}
constexpr int kDown = 0, kRight = 1, kUp = 2, kLeft = 3;

/// Stretch with the points of each slice of 0.5 m from s = 2 m.
RowStretch stretch_of(const std::vector<std::vector<Vector3f>>& slices) {
  RowStretch stretch;
  stretch.from_m = 2.0;
  stretch.to_m = 2.0 + 0.5 * static_cast<double>(slices.size());
  stretch.first.push_back(0);
  for (const auto& points : slices) {
    stretch.points.insert(stretch.points.end(), points.begin(), points.end());
    stretch.first.push_back(stretch.points.size());
  }
  return stretch;
}

struct Box {
  double half_width_m = 0.3, base_m = 0.6, top_m = 2.0;
};

/// Points on the four sides of a box in slice i, `count` on each.
std::vector<Vector3f> slice_of(int i, const Box& box, int count) {
  std::vector<Vector3f> points;
  for (int k = 0; k < count; ++k) {
    const double share = (k + 0.5) / count, s = 2.0 + 0.5 * (i + share);
    const double y = box.half_width_m * (2.0 * share - 1.0);
    const double z = box.base_m + share * (box.top_m - box.base_m);
    for (const Eigen::Vector3d& p :
         {Eigen::Vector3d(s, box.half_width_m, z), Eigen::Vector3d(s, -box.half_width_m, z),
          Eigen::Vector3d(s, y, box.base_m), Eigen::Vector3d(s, y, box.top_m)}) {
      points.push_back(p.cast<float>());
    }
  }
  return points;
}

RowStretch prism(int slices, const Box& box, int count) {
  std::vector<std::vector<Vector3f>> all;
  for (int i = 0; i < slices; ++i) all.push_back(slice_of(i, box, count));
  return stretch_of(all);
}

TEST(HullFit, BeginsAsTheBoxOfItsPoints) {
  const RowStretch stretch = prism(8, {}, 40);
  HullFit fit(stretch, box_directions());
  EXPECT_EQ(fit.sections(), 9);
  EXPECT_DOUBLE_EQ(fit.length_m(), 4.0);
  EXPECT_NEAR(fit.volume_m3(), 0.6 * 1.4 * 4.0, 1e-5);
  EXPECT_NEAR(fit.side_area_m2(), 2.0 * (0.6 + 1.4) * 4.0, 1e-5);
  EXPECT_NEAR(fit.side_area_m2(kUp), 0.6 * 4.0, 1e-5);
  EXPECT_NEAR(fit.side_area_m2(kLeft), 1.4 * 4.0, 1e-5);
  const HullChain chain = fit.chain();
  EXPECT_DOUBLE_EQ(chain.from_m(), 2.0);
  EXPECT_DOUBLE_EQ(chain.to_m(), 6.0);
  EXPECT_NEAR(chain.section(4)[kDown], -0.6, 1e-6);
}

TEST(HullFit, OffsetMovesEverySideOut) {
  const RowStretch stretch = prism(8, {}, 40);
  HullFit fit(stretch, box_directions());
  for (const double out_m : {0.05, -0.05}) {
    HullFit moved = fit;
    moved.offset(out_m);
    EXPECT_NEAR(moved.volume_m3(), (0.6 + 2.0 * out_m) * (1.4 + 2.0 * out_m) * 4.0, 1e-5);
  }
  const std::vector<double> before = fit.offsets();
  fit.offset(0.1);
  fit.set_offsets(before);
  EXPECT_EQ(fit.offsets(), before);
}

TEST(HullFit, SlicesWithoutPointsTakeTheOuterNeighbour) {
  std::vector<std::vector<Vector3f>> slices;
  for (int i = 0; i < 6; ++i) {
    const bool is_empty = i == 0 || i == 2 || i == 3;
    slices.push_back(is_empty ? std::vector<Vector3f>()
                              : slice_of(i, {.half_width_m = i == 1 ? 0.2 : 0.3}, 40));
  }
  const RowStretch stretch = stretch_of(slices);
  const HullFit fit(stretch, box_directions());
  const HullChain chain = fit.chain();
  // Knots 0 to 6; a knot takes the outer one of its two slices.
  const double wanted_m[] = {0.2, 0.2, 0.2, 0.2, 0.3, 0.3, 0.3};
  for (int j = 0; j < 7; ++j) EXPECT_NEAR(chain.section(j)[kRight], wanted_m[j], 1e-6) << j;
}

/// Volume plus price of the points outside, over all points: 1 for each side that a point is more
/// than the tolerance outside of, 20 for the side that looks down.
double brute_cost(const HullChain& chain, const RowStretch& stretch, double price_m3,
                  double tolerance_m) {
  double cost = 0.0;
  for (int j = 0; j + 1 < chain.sections(); ++j) {
    // Of a box with linear sides: width and height are linear, and their product is quadratic.
    const double *a = chain.section(j), *b = chain.section(j + 1);
    const auto area_m2 = [&](double share) {
      const auto at = [&](int k) { return (1.0 - share) * a[k] + share * b[k]; };
      return (at(kLeft) + at(kRight)) * (at(kUp) + at(kDown));
    };
    cost +=
        (chain.s_m[j + 1] - chain.s_m[j]) / 6.0 * (area_m2(0) + 4.0 * area_m2(0.5) + area_m2(1));
  }
  for (const Vector3f& p : stretch.points) {
    const double step_m = chain.s_m[1] - chain.s_m[0];
    const int j =
        std::clamp(static_cast<int>((p.x() - chain.from_m()) / step_m), 0, chain.sections() - 2);
    const double share = (p.x() - chain.s_m[j]) / step_m;
    const double value[] = {-p.z(), p.y(), p.z(), -p.y()};
    for (int k = 0; k < 4; ++k) {
      const double level =
          (1.0 - share) * chain.section(j)[k] + share * chain.section(j + 1)[k] + tolerance_m;
      if (value[k] > level) cost += price_m3 * (k == kDown ? 20.0 : 1.0);
    }
  }
  return cost;
}

TEST(HullFit, NoSideOfAnySectionCanMoveToALowerCost) {
  RandomStream random(7, "test", "points");
  std::vector<std::vector<Vector3f>> slices;
  for (int i = 0; i < 4; ++i) {
    slices.emplace_back();
    for (int n = 0; n < 60; ++n) {
      slices.back().push_back(Eigen::Vector3d(2.0 + 0.5 * (i + random.uniform()),
                                              0.2 * random.normal(), 1.2 + 0.3 * random.normal())
                                  .cast<float>());
    }
  }
  const RowStretch stretch = stretch_of(slices);
  const double price_m3 = 0.02, tolerance_m = 0.01;
  HullFit fit(stretch, box_directions());
  double before = brute_cost(fit.chain(), stretch, price_m3, tolerance_m);
  const double begun = before;
  for (int round = 0; round < 30; ++round) {
    fit.collect(0.31);
    fit.sweep(price_m3, tolerance_m, 0.3);
    const double cost = brute_cost(fit.chain(), stretch, price_m3, tolerance_m);
    EXPECT_LE(cost, before + 1e-6) << round;
    before = cost;
  }
  EXPECT_LT(before, 0.9 * begun);
  // Moves of one offset, tried one by one. Points are floats, so that those on a side count or not.
  const std::vector<double> best = fit.offsets();
  for (std::size_t n = 0; n < best.size(); ++n) {
    for (double move_m = -0.25; move_m <= 0.25; move_m += 0.001) {
      std::vector<double> moved = best;
      moved[n] += move_m;
      HullFit other = fit;
      other.set_offsets(moved);
      EXPECT_GT(brute_cost(other.chain(), stretch, price_m3, tolerance_m), before - 2e-6)
          << "offset " << n << " by " << move_m;
    }
  }
}

TEST(HullFit, SidesThatLookDownAreDearer) {
  // Two points at the first section, 0.1 m above and below a dense box. Its side moves out to one
  // of them for 0.1 m 0.5 m (0.6 m / 3 + 0.6 m / 6) = 0.015 m3: more than one point costs, and less
  // than twenty.
  std::vector<std::vector<Vector3f>> slices{slice_of(0, {}, 200), slice_of(1, {}, 200)};
  slices[0].insert(slices[0].end(), {{2.0f, 0.0f, 2.1f}, {2.0f, 0.0f, 0.5f}});
  const RowStretch stretch = stretch_of(slices);
  HullFit fit(stretch, box_directions());
  for (int round = 0; round < 10; ++round) {
    fit.collect(0.2);
    fit.sweep(0.01, 0.0, 0.15);
  }
  const HullChain chain = fit.chain();
  EXPECT_NEAR(chain.section(0)[kUp], 2.0, 0.01);
  EXPECT_NEAR(chain.section(0)[kDown], -0.5, 1e-5);
}

TEST(HullFit, CountsThePointsAboveAnExcess) {
  const RowStretch stretch = prism(4, {}, 50);
  HullFit fit(stretch, box_directions());
  // 0.1 m inside the points: each is outside its own side by that.
  fit.offset(-0.1);
  ExcessCounts counts(4);
  fit.count_excess(counts);
  std::int64_t all = 0;
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(static_cast<double>(counts.count(k)), 4.0 * 50.0, 1.0);
    EXPECT_NEAR(counts.share_m(k, 0.5), 0.1, 2.0 * ExcessCounts::kStep_m);
    all += counts.count(k);
  }
  EXPECT_EQ(all, static_cast<std::int64_t>(stretch.points.size()));
  std::vector<Vector3f> above;
  fit.find_above(0.09, above);
  EXPECT_EQ(above.size(), stretch.points.size());
  above.clear();
  fit.find_above(0.11, above);
  EXPECT_TRUE(above.empty());
}

TEST(HullFit, SectionsOfAPrismAreRemovedForNothing) {
  const RowStretch stretch = prism(10, {}, 40);
  HullFit fit(stretch, box_directions());
  const std::vector<double> before = fit.offsets();
  fit.collect(0.15);
  const auto any = [](double, double) { return true; };
  const std::vector<Removal> removals = fit.find_removals(0.1, 0.0, 1e-4, 2, any);
  ASSERT_EQ(removals.size(), 9u);
  EXPECT_EQ(fit.sections(), 11);
  EXPECT_EQ(fit.offsets(), before);
  const double volume_m3 = fit.volume_m3();
  fit.apply(removals, removals.size());
  EXPECT_EQ(fit.sections(), 2);
  EXPECT_NEAR(fit.volume_m3(), volume_m3, 1e-4);
  // None of them if the row's line bends.
  HullFit bent(stretch, box_directions());
  bent.collect(0.15);
  EXPECT_TRUE(bent.find_removals(0.1, 0.0, 1e-4, 2, [](double, double) { return false; }).empty());
}

TEST(HullFit, TheSectionsOfABulgeAreRemovedLast) {
  std::vector<std::vector<Vector3f>> slices;
  for (int i = 0; i < 12; ++i) {
    slices.push_back(slice_of(i, {.half_width_m = i == 6 ? 0.5 : 0.3}, 40));
  }
  const RowStretch stretch = stretch_of(slices);
  HullFit fit(stretch, box_directions());
  fit.collect(0.15);
  const std::vector<Removal> removals =
      fit.find_removals(0.1, 0.0, 1e9, 2, [](double, double) { return true; });
  ASSERT_EQ(removals.size(), 11u);
  // Slice 6 is between knots 6 and 7, and 5 and 8 hold the wall down beside it.
  for (std::size_t n = 0; n < removals.size(); ++n) {
    EXPECT_GE(removals[n].added_m3, removals[n == 0 ? 0 : n - 1].added_m3);
    const bool is_bulge = removals[n].knot >= 5 && removals[n].knot <= 8;
    EXPECT_EQ(is_bulge, n >= 7u) << "knot " << removals[n].knot << " as number " << n;
  }
  EXPECT_LT(removals[6].added_m3, 0.01);
  EXPECT_GT(removals[10].added_m3, 0.05);
}

TEST(HullFit, LowerEdgeIsSmoothedWhereFewLowPointsWereSeen) {
  for (const bool is_dense : {false, true}) {
    SCOPED_TRACE(is_dense);
    // Slices of 0.1 m; the base of one is 0.2 m higher. 50 points per metre are few.
    std::vector<std::vector<Vector3f>> slices;
    for (int i = 0; i < 12; ++i) {
      const Box box{.base_m = i == 6 ? 0.8 : 0.6};
      slices.push_back(slice_of(i, box, is_dense ? 60 : 3));
    }
    RowStretch stretch = stretch_of(slices);
    stretch.to_m = stretch.from_m + 1.2;
    for (std::size_t n = 0; n < stretch.points.size(); ++n) {
      stretch.points[n].x() = static_cast<float>(2.0 + (stretch.points[n].x() - 2.0) / 5.0);
    }
    HullFit fit(stretch, box_directions());
    // As if the fit had moved the side up to the points between knots 6 and 7.
    std::vector<double> h = fit.offsets();
    for (const std::size_t j : {6u, 7u}) h[4 * j + kDown] = -0.8;
    fit.set_offsets(h);
    fit.smooth_lower_edge();
    for (const int j : {6, 7}) {
      EXPECT_NEAR(fit.chain().section(j)[kDown], is_dense ? -0.8 : -0.6, 1e-6) << j;
    }
    EXPECT_NEAR(fit.chain().section(6)[kUp], 2.0, 1e-6);
  }
}

}  // namespace
}  // namespace vinerow::mapping::hull_fit_test
