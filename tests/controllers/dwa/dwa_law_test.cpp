// Rollouts against closed forms, costs by hand, room of outlines.

#include "controllers/dwa/dwa_law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "tests/controllers/dwa/course.h"

namespace vinerow::test::dwa_law_test {
namespace {

const SteeredVehicle kRover{0.75, 0.75, rad_from_deg(23), 2.0};

AxleAngles steering_deg(double front, double rear) {
  return {rad_from_deg(front), rad_from_deg(rear)};
}

controllers::Rollout::Node end_of(const controllers::Pose2& start, double v,
                                  const AxleAngles& steering, double s) {
  controllers::Rollout rollout;
  controllers::roll_out(start, v, steering, steering, kRover, s, 0.1, &rollout);
  return rollout.nodes[rollout.count - 1];
}

TEST(DwaRollout, TurnsAboutTheInstantaneousCentre) {
  // Centres and yaw rates of the reference table, m and rad/s.
  struct Row {
    double front_deg, rear_deg, v, icr_x, icr_y, yaw_rate;
  };
  for (const Row& row :
       {Row{10, -10, 1.0, 0, 4.253, 0.2351}, Row{-10, 10, 1.0, 0, -4.253, -0.2351},
        Row{23, -23, 0.8, 0, 1.767, 0.4528}, Row{15, 0, 1.0, -0.750, 5.598, 0.1771},
        Row{0, -12, 0.6, 0.750, 7.057, 0.0845}, Row{18, 5, 1.0, -1.303, 6.318, 0.1550},
        Row{12, -8, -0.7, -0.153, 4.248, -0.1647}}) {
    const controllers::Pose2 start{{3.0, -2.0}, 0.7};
    const double t = 1.4;
    const auto end = end_of(start, row.v, steering_deg(row.front_deg, row.rear_deg), t);
    const Eigen::Rotation2Dd R_WB(start.yaw_rad);
    const Eigen::Vector2d centre = start.p + R_WB * Eigen::Vector2d(row.icr_x, row.icr_y);
    // The table has four digits: they check each other here, and the rollout more closely.
    const double yaw_rate = std::copysign(row.v / std::hypot(row.icr_x, row.icr_y), row.yaw_rate);
    EXPECT_NEAR(yaw_rate, row.yaw_rate, 1e-4);
    const Eigen::Vector2d expected = centre + Eigen::Rotation2Dd(yaw_rate * t) * (start.p - centre);
    EXPECT_NEAR((end.p - expected).norm(), 0.0, 2e-4) << row.front_deg << " " << row.rear_deg;
    EXPECT_NEAR(end.yaw_rad, start.yaw_rad + yaw_rate * t, 2e-4);
    EXPECT_NEAR((end.ahead - controllers::direction(end.yaw_rad)).norm(), 0.0, 1e-12);
  }
}

TEST(DwaRollout, CrabsAlongALine) {
  const controllers::Pose2 start{{1.0, 2.0}, -0.3};
  const auto end = end_of(start, 1.0, steering_deg(10, 10), 1.4);
  EXPECT_NEAR((end.p - start.p - 1.4 * controllers::direction(-0.3 + rad_from_deg(10))).norm(), 0.0,
              1e-12);
  EXPECT_DOUBLE_EQ(end.yaw_rad, -0.3);
  const auto back = end_of(start, -0.5, steering_deg(0, 0), 1.0);
  EXPECT_NEAR((back.p - start.p + 0.5 * controllers::direction(-0.3)).norm(), 0.0, 1e-12);
}

TEST(DwaRollout, BothAxlesRollWithoutSkidding) {
  RandomStream random(1, "", "steering");
  for (int i = 0; i < 100; ++i) {
    const double limit = kRover.max_axle_steer_rad;
    const AxleAngles steering{random.uniform(-limit, limit), random.uniform(-limit, limit)};
    const double v = random.uniform(0.1, 1.0);
    constexpr double kTiny_s = 1e-6;
    controllers::Rollout rollout;
    controllers::roll_out({}, v, steering, steering, kRover, kTiny_s, kTiny_s, &rollout);
    const auto& to = rollout.nodes[0];
    const auto velocity = [&](double x) {
      return Eigen::Vector2d((to.p + x * to.ahead - Eigen::Vector2d(x, 0)) / kTiny_s);
    };
    const Eigen::Vector2d front = velocity(0.75), rear = velocity(-0.75);
    EXPECT_NEAR(std::atan2(front.y(), front.x()), steering.front_rad, 1e-5);
    EXPECT_NEAR(std::atan2(rear.y(), rear.x()), steering.rear_rad, 1e-5);
    EXPECT_NEAR(front.norm() * std::cos(steering.front_rad),
                rear.norm() * std::cos(steering.rear_rad), 1e-5);
    EXPECT_NEAR(0.5 * (front + rear).norm(), v, 1e-5);
  }
}

TEST(DwaRollout, SteersAtItsRate) {
  // Against small Euler steps of the same kinematics.
  const AxleAngles from = steering_deg(-20, 5), to = steering_deg(23, -23);
  controllers::Rollout rollout;
  controllers::roll_out({}, 0.8, from, to, kRover, 1.4, 0.1, &rollout);
  Eigen::Vector2d p(0, 0);
  double yaw = 0, front = from.front_rad, rear = from.rear_rad;
  constexpr double kStep_s = 1e-5;
  for (int i = 0; i < 140000; ++i) {
    const double k = (std::tan(front) - std::tan(rear)) / 1.5;
    const double s = (std::tan(front) + std::tan(rear)) / 2.0;
    const double v_x = 0.8 / std::hypot(1.0, s);
    p += kStep_s * v_x * (Eigen::Rotation2Dd(yaw) * Eigen::Vector2d(1.0, s));
    yaw += kStep_s * k * v_x;
    front += std::clamp(to.front_rad - front, -2.0 * kStep_s, 2.0 * kStep_s);
    rear += std::clamp(to.rear_rad - rear, -2.0 * kStep_s, 2.0 * kStep_s);
  }
  const auto& end = rollout.nodes[rollout.count - 1];
  EXPECT_NEAR((end.p - p).norm(), 0.0, 2e-3);
  EXPECT_NEAR(end.yaw_rad, yaw, 2e-3);
}

TEST(DwaCost, ByHand) {
  controllers::DwaCost cost;
  EXPECT_NEAR(controllers::calc_score({0.5, 1.0, -0.2, 0.1}, cost),
              0.4 * 0.5 - 1.0 - 0.3 * 0.2 - 3.0 * 0.1, 1e-15);
  EXPECT_NEAR(controllers::calc_score({2.0, 0.0, 0.0, 0.0}, cost), 0.4 * 0.6, 1e-15);
  cost.as_printed = true;
  EXPECT_NEAR(controllers::calc_score({2.0, 3.0, 1.0, 1.0}, cost), 0.4 * 2.0 + 3.0, 1e-15);
}

/// An open field with a wall from y = 1 upwards, a path along x.
struct Bench {
  explicit Bench(double wall_y_m = 1.0, controllers::DwaCost cost = {}) {
    Course course;
    course.known = {make_box(-3, 9, wall_y_m, 3)};
    course.grid = Eigen::AlignedBox2d(Eigen::Vector2d(-3, -3), Eigen::Vector2d(9, 3));
    known = controllers::DistanceField(make_map(course).occupancy);
    params.geometry = kRover;
    params.cost = cost;
    for (int i = 0; i <= 20; ++i) path.add({{0.1 * i, 0.0}, 0.0}, 0.1 * i);
    task.path = &path;
    task.goal_W = {1.4, 0.0};
    task.need = {0.05, 0.15};
  }
  controllers::DwaLaw law() const {
    return controllers::DwaLaw(params, controllers::DiscOutline::three_circles(0.56, 0.5),
                               controllers::FreeSpaceFinder(known, unknown));
  }
  controllers::DistanceField known;
  controllers::PointField unknown;
  controllers::DwaParams params;
  controllers::LocalPath path;
  controllers::DwaTask task;
};

TEST(DwaLaw, JudgesTheEndAndTheWay) {
  Bench bench;
  controllers::Rollout rollout;
  controllers::roll_out({{0, 0.1}, 0}, 0.5, {}, {}, kRover, 1.4, 0.1, &rollout);
  const controllers::DwaTerms terms = bench.law().judge(rollout, bench.task);
  EXPECT_NEAR(terms.goal_m, std::hypot(0.7, 0.1), 1e-12);
  EXPECT_NEAR(terms.path_m, 0.1, 1e-12);
  EXPECT_NEAR(terms.heading_error_rad, 0.0, 1e-12);
  EXPECT_NEAR(terms.clearance_m, 1.0 - 0.1 - 0.56, 1e-6);
}

TEST(DwaLaw, GoesForwardAndThePrintedCostBackwards) {
  Bench bench;
  bench.task.v_low_mps = -0.8;
  bench.task.v_high_mps = 0.8;
  const controllers::DwaChoice right = bench.law().choose({}, bench.task);
  EXPECT_TRUE(right.is_admissible);
  EXPECT_NEAR(right.v_mps, 0.1, 1e-12);  // a_max * window
  EXPECT_NEAR(right.steering.front_rad, 0.0, 1e-12);
  Bench printed(1.0, {.as_printed = true});
  printed.task.v_low_mps = -0.8;
  printed.task.v_high_mps = 0.8;
  EXPECT_NEAR(printed.law().choose({}, printed.task).v_mps, -0.1, 1e-12);
}

TEST(DwaLaw, ChoosesWhatTheVehicleCanReach) {
  Bench bench;
  bench.params.geometry.steer_rate_radps = 0.5;
  for (const double v : {0.0, 0.3, 0.8}) {
    const controllers::DwaState state{{{0, -0.5}, 0.2}, v, {0.1, -0.1}};
    const controllers::DwaChoice choice = bench.law().choose(state, bench.task);
    EXPECT_LE(std::abs(choice.v_mps - v), 0.1 + 1e-12);
    EXPECT_LE(std::abs(choice.steering.front_rad - 0.1), 0.1 + 1e-12);
    EXPECT_LE(std::abs(choice.steering.rear_rad + 0.1), 0.1 + 1e-12);
  }
}

TEST(DwaLaw, NeverChoosesASpeedItCannotStopFrom) {
  // Random poses before the wall: on the way chosen there is room to stop (v^2 <= 2 a s).
  Bench bench;
  const controllers::DwaLaw law = bench.law();
  RandomStream random(2, "", "poses");
  int admissible = 0;
  for (int i = 0; i < 300; ++i) {
    controllers::DwaState state;
    state.pose = {{random.uniform(0.0, 1.0), random.uniform(-1.5, -0.2)}, random.uniform(0.0, 1.6)};
    state.v_mps = random.uniform(0.0, 1.0);
    const controllers::DwaChoice choice = law.choose(state, bench.task);
    admissible += choice.is_admissible;
    EXPECT_LE(choice.v_mps * choice.v_mps, 2.0 * 0.5 * choice.travel_m + 1e-9);
    if (choice.is_admissible) {
      EXPECT_GE(choice.clearance.known_m, 0.0);
    }
  }
  EXPECT_GT(admissible, 100);
  EXPECT_LT(admissible, 300);
}

TEST(DwaLaw, DoesNotRefuseToLeaveAWall) {
  // 2 cm off the wall, with a margin of 5 cm: driving away and along is allowed, towards it not.
  Bench bench;
  const controllers::DwaLaw law = bench.law();
  const controllers::Pose2 pose{{0, 1.0 - 0.56 - 0.02}, 0};
  bench.task.need = law.calc_need(pose, {0.05, 0.15});
  const controllers::DwaChoice choice = law.choose({pose, 0.3, {}}, bench.task);
  EXPECT_TRUE(choice.is_admissible);
  EXPECT_GT(choice.v_mps, 0.3);
  EXPECT_GE(choice.clearance.known_m, 0.019);
  bench.task.need = {0.05, 0.15};
  EXPECT_FALSE(law.choose({pose, 0.3, {}}, bench.task).is_admissible);
}

TEST(DwaLaw, SingleCircleDoesNotFitACanopyOfSeventyCentimetres) {
  // Reference: 0.049, -0.001, -0.051 m at canopies of 0.6, 0.7, 0.8 m; three circles 0.39 .. 0.29.
  const Polygon hull = make_box(-0.75, 0.75, -0.5, 0.5);
  const controllers::PointField nothing;
  for (const auto& [half_m, single_m, three_m] :
       {std::tuple{0.3, 0.049, 0.39}, std::tuple{0.35, -0.001, 0.34},
        std::tuple{0.4, -0.051, 0.29}}) {
    // One canopy; from the middle the other one is as far.
    Course course = make_alley(half_m);
    course.known.pop_back();
    const controllers::DistanceField known(make_map(course).occupancy);
    const controllers::FreeSpaceFinder finder(known, nothing);
    const controllers::Pose2 middle{{10.0, 0.0}, 0.0};
    EXPECT_NEAR(finder.measure(controllers::DiscOutline::circumscribed(hull), middle).known_m,
                single_m, 1e-3);
    EXPECT_NEAR(finder.measure(controllers::DiscOutline::three_circles(0.56, 0.5), middle).known_m,
                three_m, 1e-3);
    EXPECT_NEAR(finder.measure(controllers::DiscOutline::polygon(hull), middle).known_m,
                0.75 - half_m, 1e-3);
  }
}

TEST(DwaFreeSpace, SeesPointsInsideAndOutsideThePolygon) {
  const Polygon outline = make_four_wheel_rover().footprint_B;
  const controllers::DiscOutline polygon = controllers::DiscOutline::polygon(outline);
  const controllers::DistanceField no_map;
  RandomStream random(3, "", "points");
  int inside = 0;
  double deepest_m = 0.0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector2d point(random.uniform(-1.6, 1.6), random.uniform(-1.2, 1.2));
    controllers::PointField field;
    field.build({0, 0}, {&point, 1});
    const double measured_m = controllers::FreeSpaceFinder(no_map, field)
                                  .measure(polygon, controllers::Pose2{})
                                  .unknown_m;
    // A tiny square about the point against the polygon.
    const double true_m = distance_between(
        outline, make_box(point.x() - 1e-6, point.x() + 1e-6, point.y() - 1e-6, point.y() + 1e-6));
    inside += true_m == 0.0;
    if (true_m == 0.0) {
      EXPECT_LT(measured_m, 0.07) << point.transpose();
      deepest_m = std::min(deepest_m, measured_m);
    } else {
      EXPECT_NEAR(measured_m, true_m, true_m > 0.1 ? 0.025 : 0.07) << point.transpose();
    }
  }
  EXPECT_NEAR(deepest_m, -0.45, 0.05);
  EXPECT_GT(inside, 50);
}

TEST(DwaFreeSpace, PointFieldIsTheDistanceToTheNearestPoint) {
  RandomStream random(4, "", "points");
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 40; ++i) points.push_back({random.uniform(5, 9), random.uniform(-3, 3)});
  points.push_back({1e6, 0.0});
  controllers::PointField field;
  field.build({7, 0}, points);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d p(random.uniform(3.5, 10.5), random.uniform(-3.5, 3.5));
    double nearest = 1e9;
    for (const Eigen::Vector2d& q : points) nearest = std::min(nearest, (p - q).norm());
    if (nearest < 1.15) {
      // Too far by the curvature of a distance, too near where two points are equally far.
      EXPECT_LT(field.at(p), nearest + std::min(0.07, 0.01 / (4.0 * nearest) + 1e-4));
      EXPECT_GT(field.at(p), nearest - 0.07);
    } else if (nearest > 1.45) {
      EXPECT_TRUE(std::isinf(field.at(p)));
    }
  }
}

}  // namespace
}  // namespace vinerow::test::dwa_law_test
