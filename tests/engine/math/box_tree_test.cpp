#include "engine/math/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "engine/core/random.h"

namespace vinerow::box_tree_test {
namespace {

template <class Scalar, int kDimension>
struct Bench {
  using Tree = BoxTree<Scalar, kDimension>;
  using Box = typename Tree::Box;
  using Point = Eigen::Matrix<Scalar, kDimension, 1>;

  Point draw(double reach) {
    Point p;
    for (int k = 0; k < kDimension; ++k) p[k] = static_cast<Scalar>(random.uniform(0.0, reach));
    return p;
  }

  std::vector<Box> make_boxes(int count) {
    std::vector<Box> boxes;
    for (int i = 0; i < count; ++i) {
      const Point low = draw(50.0);
      boxes.emplace_back(low, Point(low + draw(2.0)));
    }
    return boxes;
  }

  /// Squared distance of the box nearest to p, by the tree; counts the visits of each box.
  double search(const std::vector<Box>& boxes, const Point& p, double within2,
                std::vector<int>& visits) {
    const Tree tree(boxes);
    double best2 = within2;
    tree.search(
        [&](const Box& box) { return static_cast<double>(box.squaredExteriorDistance(p)); }, best2,
        [&](std::uint32_t item) {
          ++visits[item];
          best2 = std::min(best2, static_cast<double>(boxes[item].squaredExteriorDistance(p)));
        });
    return best2;
  }

  RandomStream random{1, "test", "boxes"};
};

template <class Scalar, int kDimension>
void expect_nearest_as_by_a_loop() {
  Bench<Scalar, kDimension> bench;
  for (const int count : {1, 2, 6, 7, 13, 100, 1000}) {
    const auto boxes = bench.make_boxes(count);
    for (int i = 0; i < 50; ++i) {
      const auto p = bench.draw(60.0);
      double smallest2 = std::numeric_limits<double>::infinity();
      for (const auto& box : boxes) {
        smallest2 = std::min(smallest2, static_cast<double>(box.squaredExteriorDistance(p)));
      }
      std::vector<int> visits(boxes.size());
      const double found2 = bench.search(boxes, p, std::numeric_limits<double>::infinity(), visits);
      ASSERT_EQ(found2, smallest2) << count << " boxes";
      ASSERT_LE(*std::max_element(visits.begin(), visits.end()), 1);
      // In a tree of a thousand boxes a search visits few of them.
      if (count == 1000) {
        ASSERT_LT(std::count(visits.begin(), visits.end(), 1), 300);
      }
    }
  }
}

TEST(BoxTree, FindsTheNearestBoxAsALoopDoesInThePlane) {
  expect_nearest_as_by_a_loop<double, 2>();
}

TEST(BoxTree, FindsTheNearestBoxAsALoopDoesInSpace) {
  expect_nearest_as_by_a_loop<float, 3>();
}

TEST(BoxTree, VisitsAllBoxesWithinReachOnce) {
  Bench<double, 2> bench;
  const auto boxes = bench.make_boxes(500);
  const Eigen::Vector2d p(20.0, 30.0);
  constexpr double kWithin2 = 64.0;
  std::vector<int> visits(boxes.size());
  BoxTree<double, 2>(boxes).search([&](const auto& box) { return box.squaredExteriorDistance(p); },
                                   kWithin2, [&](std::uint32_t item) { ++visits[item]; });
  int within = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].squaredExteriorDistance(p) >= kWithin2) continue;
    ++within;
    EXPECT_EQ(visits[i], 1);
  }
  EXPECT_GT(within, 10);
}

TEST(BoxTree, TakesEqualBoxesAndNone) {
  const std::vector<Eigen::AlignedBox2d> equal(
      100, Eigen::AlignedBox2d(Eigen::Vector2d(1, 1), Eigen::Vector2d(2, 2)));
  int visits = 0;
  const double far2 = std::numeric_limits<double>::infinity();
  const auto from_origin = [](const auto& box) {
    return box.squaredExteriorDistance(Eigen::Vector2d(0, 0));
  };
  BoxTree<double, 2>(equal).search(from_origin, far2, [&](std::uint32_t) { ++visits; });
  EXPECT_EQ(visits, 100);
  BoxTree<double, 2>().search(from_origin, far2, [&](std::uint32_t) { ++visits; });
  EXPECT_EQ(visits, 100);
}

}  // namespace
}  // namespace vinerow::box_tree_test
