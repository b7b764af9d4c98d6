/// A message that only a plug-in knows is recorded by its own description and read back.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/record/log_reader.h"
#include "engine/record/recorder.h"
#include "tests/engine/record/log_files.h"
#include "tests/support/soil_sample.h"

namespace vinerow::record::plugin_message_test {

namespace {

using test::OtherSample;
using test::SoilSample;

SoilSample make_sample() {
  SoilSample sample;
  sample.taken = true;
  sample.state = SoilSample::State::kWet;
  sample.p_W = {1.5, -2.5, 0.0};
  sample.layers = {{0.1, 0.25f}, {0.2, 0.5f}, {0.4, 0.75f}};
  sample.raw = {-3, 0, 300};
  sample.counts = {1, 2, 3};
  sample.place = "row 3";
  sample.X_WP.p = {1, 2, 3};
  return sample;
}

void expect_same(const SoilSample& read, const SoilSample& wanted) {
  EXPECT_EQ(read.taken, wanted.taken);
  EXPECT_EQ(read.state, wanted.state);
  EXPECT_EQ(read.p_W, wanted.p_W);
  ASSERT_EQ(read.layers.size(), wanted.layers.size());
  for (std::size_t i = 0; i < read.layers.size(); ++i) {
    EXPECT_EQ(read.layers[i].depth_m, wanted.layers[i].depth_m);
    EXPECT_EQ(read.layers[i].moisture, wanted.layers[i].moisture);
  }
  EXPECT_EQ(read.raw, wanted.raw);
  EXPECT_EQ(read.counts, wanted.counts);
  EXPECT_EQ(read.place, wanted.place);
  EXPECT_EQ(read.X_WP.p, wanted.X_WP.p);
  EXPECT_EQ(read.X_WP.q.coeffs(), wanted.X_WP.q.coeffs());
}

TEST(PluginMessage, IsRecordedAndReadBack) {
  const test::TemporaryFile file;
  SignalBus bus;
  auto soil = bus.advertise<SoilSample>("rover/soil", "test");
  auto other = bus.advertise<OtherSample>("sprayer/soil", "test");
  {
    Recorder recorder(file.path(), {}, {});
    for (const auto& signal : bus.signals()) recorder.channels().add_signal(*signal, Duration{0});
    soil.write(Time{0}, {});
    other.write(Time{0}, {0.5});
    recorder.record(Time{0});
    soil.write(Time{10}, make_sample());
    recorder.record(Time{10});
  }
  const LogReader log(file.path());
  std::vector<SoilSample> read;
  log.read<SoilSample>("/rover/soil",
                       [&](Time, const SoilSample& value) { read.push_back(value); });
  ASSERT_EQ(read.size(), 2u);
  expect_same(read[0], SoilSample{});
  expect_same(read[1], make_sample());
  int others = 0;
  log.read<OtherSample>("/sprayer/soil", [&](Time, const OtherSample& value) {
    EXPECT_EQ(value.depth_m, 0.5);
    ++others;
  });
  EXPECT_EQ(others, 1);
  EXPECT_EQ(log.info().channels[0].schema, "acme/msg/SoilSample");
  EXPECT_EQ(log.info().channels[0].metadata.at("vinerow_type"), "acme/SoilSample");
}

TEST(PluginMessage, DefinesItself) {
  const std::string rule = std::string(80, '=') + "\nMSG: ";
  const std::string numbers = "float64 x\nfloat64 y\nfloat64 z\n";
  EXPECT_EQ(RosMapping<SoilSample>::definition(),
            "std_msgs/Header header\n"
            "bool taken\n"
            "uint16 DRY=1\nuint16 WET=7\nuint16 state\n"
            "# m\ngeometry_msgs/Point position\n"
            "acme/Layer[] layers\n"
            "int16[] raw\n"
            "uint32[3] counts\n"
            "string place\n"
            "# of its tip\ngeometry_msgs/Pose body\ngeometry_msgs/Pose probe\n" +
                rule + "std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + rule +
                "geometry_msgs/Point\n" + numbers + rule +
                "acme/Layer\n# m\nfloat64 depth\n# share of the pores that hold water\nfloat32 "
                "moisture\n" +
                rule +
                "geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion "
                "orientation\n" +
                rule + "builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n" + rule +
                "geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n");
}

TEST(PluginMessage, DamagedBytesAreRefused) {
  const FrameNames frames = FrameNames::of_signal("rover/soil");
  ByteBuffer buffer;
  CdrWriter out(buffer);
  RosMapping<SoilSample>::write(out, {frames, Time{0}}, make_sample());
  SoilSample value;
  // Cut anywhere, it is no message.
  for (std::size_t size = 0; size < buffer.size(); ++size) {
    CdrReader in(buffer.view().first(size));
    EXPECT_FALSE(RosMapping<SoilSample>::read(in, frames, value)) << size;
  }
  CdrReader whole(buffer.view());
  ASSERT_TRUE(RosMapping<SoilSample>::read(whole, frames, value));
  expect_same(value, make_sample());

  // An invalid state.
  SoilSample strange = make_sample();
  strange.state = static_cast<SoilSample::State>(2);
  ByteBuffer other;
  CdrWriter strange_out(other);
  RosMapping<SoilSample>::write(strange_out, {frames, Time{0}}, strange);
  CdrReader in(other.view());
  EXPECT_FALSE(RosMapping<SoilSample>::read(in, frames, value));
}

}  // namespace
}  // namespace vinerow::record::plugin_message_test
