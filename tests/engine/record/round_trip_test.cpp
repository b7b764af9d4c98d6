/// What is recorded comes back: every type, to the bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/record/log_reader.h"
#include "engine/record/recorder.h"
#include "engine/record/ros_fields.h"
#include "tests/engine/record/log_files.h"
#include "tests/engine/record/message_samples.h"
#include "tests/engine/record/raw_messages.h"

namespace vinerow::record::round_trip_test {
namespace {

using test::bytes_of;
using test::TemporaryFile;

constexpr int kSamples = 50;

class RoundTrip : public ::testing::TestWithParam<std::string> {};

TEST_P(RoundTrip, EveryTypeComesBackToTheBit) {
  const TemporaryFile file;
  SignalBus bus;
  RandomStream random(1, "test", "round_trip");
  RecorderOptions options;
  options.compression = GetParam();
  options.chunk_bytes = 20'000;  // several chunks
  options.compact_poses = false;
  Recorder recorder(file.path(), options, {});
  std::map<std::string, std::vector<std::vector<std::uint8_t>>> written;

  for_each_message_type([&]<class T>(T*) {
    const std::string name = std::string("rover/") + T::kType;
    auto writer = bus.advertise<T>(name, "test");
    recorder.channels().add_signal(*bus.find(name), Duration{0});
    for (int i = 0; i < kSamples; ++i) {
      T value;
      test::fill(random, value);
      writer.write(Time{i * 1'000'003}, value);
      recorder.record(Time{i * 1'000'003 + 5});
      written[name].push_back(bytes_of(value));
    }
  });
  recorder.finish();

  const LogReader log(file.path());
  EXPECT_TRUE(log.info().complete);
  for_each_message_type([&]<class T>(T*) {
    const std::string name = std::string("rover/") + T::kType;
    std::size_t i = 0;
    log.read<T>("/" + name, [&](Time stamp, const T& value) {
      ASSERT_LT(i, written[name].size());
      EXPECT_EQ(stamp.ns, static_cast<std::int64_t>(i) * 1'000'003) << name;
      EXPECT_EQ(bytes_of(value), written[name][i]) << name << " " << i;
      ++i;
    });
    EXPECT_EQ(i, static_cast<std::size_t>(kSamples)) << name;
  });
  EXPECT_EQ(log.info().damaged, 0u);
}

INSTANTIATE_TEST_SUITE_P(Compressions, RoundTrip, ::testing::Values("zstd", "lz4", "none"));

TEST(RoundTrip, LinksComeBackBesideTheFrameOfDeadReckoning) {
  const TemporaryFile file;
  SignalBus bus;
  Recorder recorder(file.path(), {}, {});
  auto truth = bus.advertise<Odometry>("rover/truth", "test");
  auto links = bus.advertise<LinkPoses>("rover/links", "test");
  auto reckoning = bus.advertise<DeadReckoning>("rover/odom", "test");
  for (const char* name : {"rover/truth", "rover/links", "rover/odom"}) {
    recorder.channels().add_signal(*bus.find(name), Duration{0});
  }
  Odometry body;
  body.X_WB = {Eigen::Quaterniond(0.8, 0.0, 0.0, 0.6), {10.0, -4.0, 0.5}};
  const Pose X_BL{Eigen::Quaterniond::Identity(), {0.5, 0.25, -0.125}};
  const LinkPoses written{{"base", "wheel"}, {body.X_WB, body.X_WB * X_BL}};
  DeadReckoning reckoned;
  reckoned.X_OB = {Eigen::Quaterniond::Identity(), {3.0, 1.0, 0.0}};
  truth.write(Time{}, body);
  links.write(Time{}, written);
  reckoning.write(Time{}, reckoned);
  recorder.record(Time{});
  recorder.finish();

  const LogReader log(file.path());
  int count = 0;
  log.read<LinkPoses>("/rover/links", [&](Time, const LinkPoses& read) {
    ++count;
    EXPECT_EQ(read.names, written.names);
    ASSERT_EQ(read.X_WL.size(), 2u);
    // Rounded to nanometres.
    EXPECT_LT((read.X_WL[1].p - written.X_WL[1].p).norm(), 1e-8);
  });
  EXPECT_EQ(count, 1);
  // The transforms as another reader sees them: the body where the truth is, and the odometry's
  // frame where it puts the body.
  std::map<std::string, std::pair<std::string, Pose>> tree;  // by child
  test::read_raw(file.path(), [&](Time, const ChannelInfo& channel, const auto& bytes) {
    if (channel.topic != "/rover/links") return;
    CdrReader in(bytes);
    for (auto left = in.read<std::uint32_t>(); left > 0; --left) {
      skip_time(in);
      const std::string parent(in.read_text()), child(in.read_text());
      Pose pose;
      read_pose(in, pose);
      tree[child] = {parent, pose};
    }
    EXPECT_TRUE(in.ok());
  });
  EXPECT_EQ(tree.at("rover/base_link").first, "map");
  EXPECT_EQ(tree.at("rover/wheel").first, "rover/base_link");
  EXPECT_EQ(tree.at("rover/odom").first, "map");
  const Pose reckoned_W = tree.at("rover/odom").second * reckoned.X_OB;
  EXPECT_LT((reckoned_W.p - body.X_WB.p).norm(), 1e-12);
  EXPECT_LT(reckoned_W.q.angularDistance(body.X_WB.q), 1e-7);
}

TEST(RoundTrip, MessagesInAnotherOrderAreReadInTheOrderOfTheirStamps) {
  // As merged logs and other writers leave them. Two have one stamp: they keep the file's order.
  const TemporaryFile file;
  const std::int64_t stamps_ns[] = {300, 100, 700, 200, 700, 0, 600};
  SignalBus bus;
  auto shuffled = bus.advertise<RangeSample>("rover/shuffled", "test");
  auto sorted = bus.advertise<RangeSample>("rover/sorted", "test");
  {
    RecorderOptions options;
    options.chunk_bytes = 200;  // several chunks
    Recorder recorder(file.path(), options, {});
    for (const auto& signal : bus.signals()) recorder.channels().add_signal(*signal, Duration{0});
    RangeSample sample;
    for (int i = 0; i < 7; ++i) {
      sample.range_m = i;
      shuffled.write(Time{stamps_ns[i]}, sample);
      sorted.write(Time{100 * i}, sample);
      recorder.record(Time{1000 + i});
    }
    recorder.finish();
  }
  const LogReader log(file.path());
  std::vector<std::pair<std::int64_t, double>> read;
  const auto keep = [&](Time stamp, const RangeSample& sample) {
    read.emplace_back(stamp.ns, sample.range_m);
  };
  log.read<RangeSample>("/rover/sorted", keep);
  EXPECT_EQ(read.size(), 7u);
  EXPECT_TRUE(log.info().warnings.empty());
  for (int i = 0; i < 2; ++i) {
    read.clear();
    log.read<RangeSample>("/rover/shuffled", keep);
    const std::vector<std::pair<std::int64_t, double>> wanted = {
        {0, 5}, {100, 1}, {200, 3}, {300, 0}, {600, 6}, {700, 2}, {700, 4}};
    EXPECT_EQ(read, wanted);
  }
  ASSERT_EQ(log.info().warnings.size(), 1u);
  EXPECT_EQ(
      log.info().warnings[0],
      file.path().string() +
          ": the messages of topic '/rover/shuffled/exact' are not in the order of their stamps; "
          "they were sorted");
  EXPECT_EQ(log.info().damaged, 0u);
}

TEST(RoundTrip, TopicsOfAPassAreReadAsEachAlone) {
  const TemporaryFile file;
  // By topic the stamps of messages, in the order in which they are logged.
  const std::map<std::string, std::vector<std::int64_t>> stamps_ns = {
      {"ascending", {0, 10, 10, 30, 40, 50, 60}},
      {"shuffled", {30, 10, 70, 20, 70, 0, 60}},
      {"late", {5, 6, 7, 8, 9, 10, 11}}};
  SignalBus bus;
  std::map<std::string, SignalWriter<RangeSample>> writers;
  for (const auto& [name, stamps] : stamps_ns) {
    writers.emplace(name, bus.advertise<RangeSample>("rover/" + name, "test"));
  }
  {
    RecorderOptions options;
    options.chunk_bytes = 200;  // several chunks
    Recorder recorder(file.path(), options, {});
    for (const auto& signal : bus.signals()) recorder.channels().add_signal(*signal, Duration{0});
    for (std::size_t i = 0; i < 7; ++i) {
      for (auto& [name, writer] : writers) {
        RangeSample sample;
        sample.range_m = static_cast<double>(i);
        writer.write(Time{stamps_ns.at(name)[i]}, sample);
      }
      recorder.record(Time{1000 + static_cast<std::int64_t>(i)});
    }
    recorder.finish();
  }
  const LogReader log(file.path());
  using Read = std::vector<std::pair<std::int64_t, double>>;
  std::map<std::string, Read> together, again;
  LogPass pass(log);
  for (const auto& [name, stamps] : stamps_ns) {
    for (std::map<std::string, Read>* reads : {&together, &again}) {  // a topic twice, too
      Read& read = (*reads)[name];
      pass.read<RangeSample>("/rover/" + name, [&read](Time t, const RangeSample& sample) {
        read.emplace_back(t.ns, sample.range_m);
      });
    }
  }
  EXPECT_TRUE(together["late"].empty()) << "read before the pass runs";
  pass.run();
  for (const auto& [name, stamps] : stamps_ns) {
    Read wanted;
    for (std::size_t i = 0; i < 7; ++i) wanted.emplace_back(stamps[i], static_cast<double>(i));
    std::ranges::stable_sort(wanted, {}, &std::pair<std::int64_t, double>::first);
    EXPECT_EQ(together[name], wanted) << name;
    EXPECT_EQ(again[name], wanted) << name;
    Read alone;
    log.read<RangeSample>("/rover/" + name, [&](Time t, const RangeSample& sample) {
      alone.emplace_back(t.ns, sample.range_m);
    });
    EXPECT_EQ(alone, wanted) << name;
  }
  EXPECT_EQ(log.info().warnings.size(), 1u) << "the topic that is not in order is named once";
  LogPass wrong(log);
  EXPECT_THROW(wrong.read<RangeSample>("/rover/lat", [](Time, const RangeSample&) {}), ConfigError);
  EXPECT_THROW(wrong.read<Odometry>("/rover/late", [](Time, const Odometry&) {}), ConfigError);
  wrong.run();  // of no topic
}

TEST(RoundTrip, AStampOfNoTimeIsLeftOut) {
  const TemporaryFile file;
  SignalBus bus;
  auto range = bus.advertise<RangeSample>("rover/range", "test");
  {
    Recorder recorder(file.path(), {}, {});
    recorder.channels().add_signal(*bus.find("rover/range"), Duration{0});
    for (const std::int64_t stamp_ns : {std::int64_t{5}, std::int64_t{-1}, std::int64_t{6}}) {
      range.write(Time{stamp_ns}, RangeSample{});
      recorder.record(Time{10});
    }
    recorder.finish();
  }
  const LogReader log(file.path());
  std::vector<std::int64_t> stamps_ns;
  log.read<RangeSample>("/rover/range",
                        [&](Time t, const RangeSample&) { stamps_ns.push_back(t.ns); });
  EXPECT_EQ(stamps_ns, (std::vector<std::int64_t>{5, 6}));
  EXPECT_EQ(log.info().damaged, 1u);
  EXPECT_NE(log.info().warnings.back().find("message 2 of topic"), std::string::npos);
}

TEST(RoundTrip, SpecialNumbersComeBackToTheBit) {
  const TemporaryFile file;
  const double special[] = {
      std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), -0.0,
      std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()};
  SignalBus bus;
  auto values = bus.advertise<NamedValues>("rover/values", "test");
  auto range = bus.advertise<RangeSample>("rover/range", "test");
  NamedValues wanted_values{{"a", "b", "c", "d", "e"}, {std::begin(special), std::end(special)}};
  RangeSample wanted_range;
  wanted_range.range_m = special[0];
  wanted_range.X_WS.p = {-0.0, 1.0, -0.0};
  {
    Recorder recorder(file.path(), {}, {});
    for (const auto& signal : bus.signals()) recorder.channels().add_signal(*signal, Duration{0});
    values.write(Time{0}, wanted_values);
    range.write(Time{0}, wanted_range);
    recorder.record(Time{0});
  }
  const LogReader log(file.path());
  log.read<NamedValues>("/rover/values", [&](Time, const NamedValues& value) {
    EXPECT_EQ(bytes_of(value), bytes_of(wanted_values));
  });
  log.read<RangeSample>("/rover/range", [&](Time, const RangeSample& value) {
    EXPECT_EQ(bytes_of(value), bytes_of(wanted_range));
  });
}

// The one exception: poses of links and sensors, where the body's is known, go through a grid of
// 2^-30. Half a step per coordinate, the same for the quaternion, which moves a point at most 2 m
// from the body (as far as any link here) by 2 m * 2 * |dq|; so 1e-8 is well above and far below
// what a picture shows.
TEST(RoundTrip, CompactPosesComeBackWithinNanometres) {
  const TemporaryFile file;
  SignalBus bus;
  RandomStream random(2, "test", "compact");
  auto truth_out = bus.advertise<Odometry>("rover/truth", "test");
  auto links_out = bus.advertise<LinkPoses>("rover/links", "test");
  auto range_out = bus.advertise<RangeSample>("rover/us", "test");
  std::vector<Odometry> truths;
  std::vector<LinkPoses> links;
  std::vector<RangeSample> ranges;
  {
    Recorder recorder(file.path(), {}, {});
    for (const auto& signal : bus.signals()) recorder.channels().add_signal(*signal, Duration{0});
    for (int i = 0; i < kSamples; ++i) {
      Odometry truth;
      test::fill(random, truth);
      const auto near_body = [&] {
        Odometry any;
        test::fill(random, any);
        return truth.X_WB * Pose{any.X_WB.q, any.X_WB.p.normalized() * random.uniform()};
      };
      // The body itself is a link, and one link shares the body frame's name.
      links.push_back({{"body", "wheel", "base_link"}, {truth.X_WB, near_body(), near_body()}});
      RangeSample range;
      test::fill(random, range);
      range.X_WS = near_body();
      ranges.push_back(range);
      truths.push_back(truth);
      truth_out.write(Time{i}, truth);
      links_out.write(Time{i}, links.back());
      range_out.write(Time{i}, range);
      recorder.record(Time{i});
    }
  }
  const auto expect_near = [](const Pose& a, const Pose& b) {
    EXPECT_LT((a.p - b.p).norm(), 1e-8);
    EXPECT_LT((a.q.coeffs() - b.q.coeffs()).norm(), 1e-8);
  };
  const LogReader log(file.path());
  std::size_t i = 0;
  log.read<LinkPoses>("/rover/links", [&](Time, const LinkPoses& value) {
    EXPECT_EQ(value.names, links[i].names);
    ASSERT_EQ(value.X_WL.size(), links[i].X_WL.size());
    for (std::size_t k = 0; k < value.X_WL.size(); ++k)
      expect_near(value.X_WL[k], links[i].X_WL[k]);
    ++i;
  });
  EXPECT_EQ(i, links.size());
  i = 0;
  log.read<RangeSample>("/rover/us", [&](Time, const RangeSample& value) {
    expect_near(value.X_WS, ranges[i].X_WS);
    EXPECT_EQ(value.range_m, ranges[i].range_m);
    EXPECT_EQ(value.half_angle_rad, ranges[i].half_angle_rad);
    ++i;
  });
  EXPECT_EQ(i, ranges.size());
  i = 0;
  log.read<Odometry>("/rover/truth", [&](Time, const Odometry& value) {
    EXPECT_EQ(bytes_of(value), bytes_of(truths[i++]));
  });
}

TEST(RoundTrip, LinksWrittenAtAnotherTimeThanTheTruthAreExact) {
  const TemporaryFile file;
  SignalBus bus;
  RandomStream random(3, "test", "late");
  auto truth_out = bus.advertise<Odometry>("rover/truth", "test");
  auto links_out = bus.advertise<LinkPoses>("rover/links", "test");
  Odometry truth;
  test::fill(random, truth);
  const LinkPoses links{{"body", "wheel"}, {truth.X_WB, truth.X_WB}};
  {
    Recorder recorder(file.path(), {}, {});
    for (const auto& signal : bus.signals()) recorder.channels().add_signal(*signal, Duration{0});
    truth_out.write(Time{1}, truth);
    links_out.write(Time{2}, links);
    recorder.record(Time{2});
  }
  int count = 0;
  LogReader(file.path()).read<LinkPoses>("/rover/links", [&](Time, const LinkPoses& value) {
    EXPECT_EQ(bytes_of(value), bytes_of(links));
    ++count;
  });
  EXPECT_EQ(count, 1);
}

}  // namespace
}  // namespace vinerow::record::round_trip_test
