#include "engine/live/transform_tree.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "engine/record/ros_fields.h"

namespace vinerow::live::transform_tree_test {
namespace {

const Time kNow{2'020'000'000};

struct Link {
  std::string parent;
  Time stamp;
  Pose X_PC;
};

/// Two vehicles: a rover with dead reckoning and estimate, a drone with neither.
struct Bench {
  explicit Bench(Localisation localisation) {
    Ports rover(bus, "rover", "test"), drone(bus, "drone", "test");
    truth = rover.write<Odometry>("truth");
    links = rover.write<LinkPoses>("links");
    estimate = rover.write<Odometry>("estimate");
    reckoning = rover.write<DeadReckoning>("wheels");
    reckoning_truth = rover.write<DeadReckoning>("wheels_truth");
    drone_truth = drone.write<Odometry>("truth");
    drone_links = drone.write<LinkPoses>("links");
    tree.emplace(bus, localisation);
  }

  /// By child, as a listener of tf reads the message.
  std::map<std::string, Link> listen(Time now = kNow) {
    std::map<std::string, Link> read;
    if (!tree->update(now)) return read;
    record::ByteBuffer buffer;
    record::CdrWriter out(buffer);
    tree->write(out);
    const auto bytes = buffer.view();
    record::CdrReader in({bytes.begin(), bytes.end()});
    const auto count = in.read<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) {
      Link link;
      link.stamp = Time{std::int64_t{in.read<std::int32_t>()} * 1'000'000'000};
      link.stamp = link.stamp + Duration{in.read<std::uint32_t>()};
      link.parent = in.read_text();
      const std::string child(in.read_text());
      record::read_pose(in, link.X_PC);
      EXPECT_FALSE(read.contains(child)) << child << " has two parents";
      read[child] = link;
    }
    EXPECT_TRUE(in.ok());
    return read;
  }
  void write_truth(Time now, const Pose& X_WB) {
    Odometry value;
    value.X_WB = X_WB;
    truth.write(now, value);
  }
  void write_reckoning(Time measured, const Pose& X_OB) {
    DeadReckoning value;
    value.X_OB = X_OB;
    reckoning.write(measured, value);
  }

  SignalBus bus;
  SignalWriter<Odometry> truth, estimate, drone_truth;
  SignalWriter<LinkPoses> links, drone_links;
  SignalWriter<DeadReckoning> reckoning, reckoning_truth;
  std::optional<TransformTree> tree;
};

Pose pose(double x, double y, double yaw_rad) {
  return {quaternion_from_rpy({0.0, 0.0, yaw_rad}), {x, y, 0.4}};
}

void expect_pose(const Pose& pose, const Pose& expected) {
  EXPECT_LT((pose.p - expected.p).norm(), 1e-12);
  EXPECT_LT(pose.q.angularDistance(expected.q), 1e-7);
}

TEST(TransformTree, CorrectsTheDriftOfDeadReckoning) {
  Bench bench(Localisation::kTruth);
  EXPECT_TRUE(bench.listen().empty());
  const Pose X_WB = pose(12.0, -3.0, 0.7), X_OB = pose(4.0, 1.0, 0.2);
  bench.write_truth(kNow, X_WB);
  bench.reckoning_truth.write(kNow, {});
  bench.write_reckoning(kNow, X_OB);
  bench.links.write(kNow, {{"wheel_l"}, {X_WB * pose(0.5, 0.3, 0.0)}});
  const auto tree = bench.listen();
  ASSERT_EQ(tree.size(), 3u);
  EXPECT_EQ(tree.at("rover/odom").parent, "map");
  EXPECT_EQ(tree.at("rover/base_link").parent, "rover/odom");
  EXPECT_EQ(tree.at("rover/wheel_l").parent, "rover/base_link");
  expect_pose(tree.at("rover/base_link").X_PC, X_OB);
  expect_pose(tree.at("rover/odom").X_PC * tree.at("rover/base_link").X_PC, X_WB);
  // Rounded to a nanometre, as in logs.
  EXPECT_LT((tree.at("rover/wheel_l").X_PC.p - pose(0.5, 0.3, 0.0).p).norm(), 1e-8);
  EXPECT_EQ(tree.at("rover/base_link").stamp, kNow);
  EXPECT_TRUE(bench.listen().empty()) << "once";
}

TEST(TransformTree, ALateReadingIsComparedWithThePoseOfItsTime) {
  Bench bench(Localisation::kTruth);
  const Pose then = pose(1.0, 0.0, 0.0), X_OB = pose(0.5, 0.0, 0.1);
  bench.write_truth(kNow, then);
  bench.reckoning_truth.write(kNow, {});
  EXPECT_TRUE(bench.listen().empty()) << "measured, not arrived";
  for (int i = 1; i <= 5; ++i) {
    const Time later = kNow + Duration{i * 20'000'000};
    bench.write_truth(later, pose(1.0 + i, 0.0, 0.0));
    bench.reckoning_truth.write(later, {});
    if (i < 5) {
      EXPECT_TRUE(bench.listen().empty());
    }
  }
  bench.write_reckoning(kNow, X_OB);
  const auto tree = bench.listen();
  EXPECT_EQ(tree.at("rover/odom").stamp, kNow);
  expect_pose(tree.at("rover/odom").X_PC * X_OB, then);
}

TEST(TransformTree, ForgetsWhatIsOlderThanTheLongestDelay) {
  Bench bench(Localisation::kTruth);
  bench.write_truth(kNow, pose(1.0, 0.0, 0.0));
  bench.reckoning_truth.write(kNow, {});
  EXPECT_TRUE(bench.listen().empty());
  const Time later = kNow + Duration{10'500'000'000};
  bench.reckoning_truth.write(later, {});
  EXPECT_TRUE(bench.listen(later).empty());
  bench.write_reckoning(kNow, pose(0.5, 0.0, 0.1));
  EXPECT_FALSE(bench.listen(later).contains("rover/odom"));
}

TEST(TransformTree, AParkedVehicleStaysInTheTree) {
  Bench bench(Localisation::kTruth);
  const Pose parked = pose(3.0, 4.0, 0.5);
  bench.write_truth(kNow, parked);
  bench.links.write(kNow, {});
  auto tree = bench.listen();
  expect_pose(tree.at("rover/odom").X_PC * tree.at("rover/base_link").X_PC, parked);
  // It works, and is parked again.
  const Pose X_OB = pose(1.0, 0.0, 0.0), moved = pose(4.0, 4.0, 0.5);
  Time now = kNow + Duration{20'000'000};
  bench.write_truth(now, moved);
  bench.reckoning_truth.write(now, {});
  bench.write_reckoning(now, X_OB);
  bench.links.write(now, {});
  tree = bench.listen(now);
  ASSERT_EQ(tree.size(), 2u) << "once each";
  now = now + Duration{900'000'000};
  bench.links.write(now, {});
  EXPECT_TRUE(bench.listen(now).empty()) << "the next reading may come";
  now = now + Duration{100'000'000};
  bench.links.write(now, {});
  tree = bench.listen(now);
  EXPECT_EQ(tree.at("rover/base_link").stamp, now);
  expect_pose(tree.at("rover/base_link").X_PC, X_OB);
  expect_pose(tree.at("rover/odom").X_PC * X_OB, moved);
}

TEST(TransformTree, PutsTheBodyWhereTheEstimatorSays) {
  Bench bench(Localisation::kEstimate);
  const Pose believed = pose(12.1, -3.0, 0.72), X_OB = pose(4.0, 1.0, 0.2);
  bench.write_truth(kNow, pose(12.0, -3.0, 0.7));
  bench.reckoning_truth.write(kNow, {});
  bench.write_reckoning(kNow, X_OB);
  auto tree = bench.listen();
  EXPECT_FALSE(tree.contains("rover/odom")) << "not yet localised";
  EXPECT_TRUE(tree.contains("rover/base_link"));
  const Time later = kNow + Duration{20'000'000};
  Odometry estimate;
  estimate.X_WB = believed;
  bench.estimate.write(later, estimate);
  bench.reckoning_truth.write(later, {});
  bench.write_reckoning(later, X_OB);
  tree = bench.listen();
  expect_pose(tree.at("rover/odom").X_PC * X_OB, believed);
}

TEST(TransformTree, LeavesTheMapToANodeOutside) {
  Bench bench(Localisation::kNone);
  bench.write_truth(kNow, pose(12.0, -3.0, 0.7));
  bench.reckoning_truth.write(kNow, {});
  bench.write_reckoning(kNow, pose(4.0, 1.0, 0.2));
  Odometry drone;
  drone.X_WB = pose(1.0, 2.0, 0.3);
  bench.drone_truth.write(kNow, drone);
  bench.drone_links.write(kNow, {});
  const auto tree = bench.listen();
  ASSERT_EQ(tree.size(), 2u);
  expect_pose(tree.at("rover/base_link").X_PC, pose(4.0, 1.0, 0.2));
  EXPECT_EQ(tree.at("drone/base_link").parent, "drone/odom");
  expect_pose(tree.at("drone/base_link").X_PC, drone.X_WB);
}

TEST(TransformTree, WithoutDeadReckoningOdomIsTheMap) {
  Bench bench(Localisation::kEstimate);
  Odometry drone;
  drone.X_WB = pose(1.0, 2.0, 0.3);
  bench.drone_truth.write(kNow, drone);
  bench.drone_links.write(kNow, {{"rotor"}, {drone.X_WB * pose(0.1, 0.0, 0.0)}});
  const auto tree = bench.listen();
  EXPECT_EQ(tree.at("drone/odom").parent, "map");
  expect_pose(tree.at("drone/odom").X_PC, {});
  expect_pose(tree.at("drone/base_link").X_PC, drone.X_WB);
  EXPECT_EQ(tree.at("drone/rotor").parent, "drone/base_link");
}

TEST(TransformTree, ASlowEstimateIsPassedOnOnce) {
  Bench bench(Localisation::kTruth);
  bench.drone_truth.write(kNow, {});
  bench.drone_links.write(kNow, {});
  EXPECT_EQ(bench.listen().size(), 2u);
  bench.drone_links.write(kNow + Duration{20'000'000}, {});
  EXPECT_TRUE(bench.listen().empty()) << "no transform repeats a stamp";
}

}  // namespace
}  // namespace vinerow::live::transform_tree_test
