/// The bytes of every shipped message, in the digest of a run and in its log, as digests: were they
/// others, logs and golden digests of before would be worth nothing.

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "engine/api/signal.h"
#include "engine/core/hash.h"
#include "engine/record/ros_mapping.h"
#include "tests/engine/record/message_samples.h"

namespace vinerow::record::message_bytes_test {
namespace {

struct Digests {
  std::string signal;  ///< what the run's digest takes
  std::string log;     ///< messages of the channel and of its exact one
};

// As they were when every hash, definition and reader was still written by hand.
const std::map<std::string, Digests> kDigests = {
    {"Odometry",
     {"d83dff353512442d9b399bb9c6bf5edc", "c913a1b12210493bf38772867eb9f8a6"}},
    {"DeadReckoning",
     {"470ef8fec4203a2eca933bfe00736c7e", "6036613d9281eb78b4df1bd597107eb7"}},
    {"ImuSample",
     {"eddff62d463f0084d879330ba3219fc7", "3d2a5768f4f7fe7852c82ec2015fb8dd"}},
    {"GnssFix",
     {"7c65838ff8b13ad16d748cbf4ab70480", "7650a494a9ed0ac2cc2f789b609dce44"}},
    {"RangeSample",
     {"113601be411bda25629693435aa9a792", "513f646902b643c2bccc1e15067ed8f6"}},
    {"PressureSample",
     {"8bf495501b0f488d660f77f31bedd1cc", "550b3518ddfbb9c28e4bb93bb1eeca50"}},
    {"MagneticSample",
     {"5804eb1387bb68921bf591c84af7d77a", "89d0d92229b3f572d1a3364089b013d2"}},
    {"LaserScan",
     {"71d1d3beca374c24df04887955cba02b", "7b9da5773057fbc69a2277707016b54b"}},
    {"PointCloud",
     {"b091eb891d32f956420858bda14ab38d", "5a0b441dd42187a358eed565829b5dc3"}},
    {"Picture",
     {"1558fff3297347d54bcc9559b6200a44", ""}},
    {"CameraInfo",
     {"38703cdc4932ced499a90951f128a804", "59cd790a3d14b1fccb45efd08874cf5b"}},
    {"PositionEllipsoid",
     {"ac9ee19863a37d86c05c93ca87149f4b", "5f9ca171cd65973a6dfce8eb15a9bc31"}},
    {"GnssHeading",
     {"2ce143f7cbd9e45596c64400b050af28", "b338dca0b6906339e69e486f17ee15c8"}},
    {"PoseTarget",
     {"0c7e2daf109b51116f7c70cca009325e", "95fa831cf734308248511ec88da88434"}},
    {"VelocityCommand",
     {"e1796e7c9165b49ecef26d85c548884a", "fb181c93ded5c2813bda04995dd70d1a"}},
    {"LocalCommand",
     {"bcdafaeaeda61b9e4587335cd38312fd", "d986bfb39fdd4ab6ec67168f5926fd43"}},
    {"LineList",
     {"a2b9958f0a39e693180f7726f6114372", "6144381b50156c059d27d33f6cad37ae"}},
    {"OccupancyGrid",
     {"104cf6e9a1fe06d36e865b58c0699f53", "fbdb872e84ff9e4f60e30e02d18694fb"}},
    {"NamedValues",
     {"8d318d4a9a56dfc9e758fe1dcd53e4d7", "6d909365518f9a26888c4a922206cde0"}},
    {"LinkPoses",
     {"f94885a416e82ac61d7cedc701e7f8d5", "5322e19dae0203de8456c9cea7106797"}},
    {"PlannedPath",
     {"ce747e195990f1ec4ac60e9469b9379c", "76ab5db1dddeb915a9e7839e55c8bf96"}},
    {"FollowerState",
     {"98edeffcaf844265ee6d884e34103d40", "9554fe7d812b94fd3f04add97122af04"}},
    {"MovementAuthority",
     {"784429ad9f7e520fd99854277d24547d", "d1694cadd2984bb8e899faf67b5cdf9f"}},
    {"ReferenceTrajectory",
     {"1e612d4a28534307db2c8fdb092c3b10", "6dd5b547ecee28680e115773732ed57d"}},
    {"AirReference",
     {"638ebfed32d33c6730b44f7b4e80e87d", "93a19c2992dd743dbc85e64f1ef0744a"}},
    {"AirData",
     {"220a6faa808e4d0cae43de9046ea5088", "544cf184ebe676399df228d17d8e504d"}},
    {"CameraShot",
     {"773770de8b94d9358885e9ed1a0a872e", "39516792a0df6e24a2adfe0b4f5c9a8f"}},
    {"BatteryState",
     {"6557a7cc2ba8e832e2e9088614fd0f8d", "83777d05d568139ad6b95b28ff1e3b2f"}},
    {"Event",
     {"2595adacf0e42832c2d43134a67a3f6a", "c96b31be16e41e07fff270c8cbe39bd1"}}};

/// Of 20 values of one type.
template <class T>
Digests digests_of() {
  RandomStream random(7, "bytes", T::kType);
  Hasher hashes, bytes;
  const FrameNames frames = FrameNames::of_signal("rover/x");
  Signal<T> signal("rover/x");
  for (int i = 0; i < 20; ++i) {
    T value;
    test::fill(random, value);
    signal.write(Time{1'500'000'000LL * i}, value);
    signal.hash_into(hashes);
    const Pose X_WB{quaternion_from_rpy({0.1, 0.2, 0.3}), {1, 2, 3}};
    const WriteContext context{frames, signal.stamp(), i % 2 == 0 ? &X_WB : nullptr};
    ByteBuffer buffer;
    CdrWriter out(buffer);
    RosMapping<T>::write(out, context, value);
    if constexpr (requires { &RosMapping<T>::write_exact; }) {
      CdrWriter exact(buffer);
      RosMapping<T>::write_exact(exact, context, value);
    }
    bytes.add_bytes(buffer.data(), buffer.size());
  }
  return {hashes.hex(), bytes.hex()};
}

TEST(MessageBytes, StayWhatTheyAre) {
  for_each_message_type([]<class T>(T*) {
    const Digests digests = digests_of<T>();
    ASSERT_TRUE(kDigests.contains(T::kType)) << T::kType;
    EXPECT_EQ(digests.signal, kDigests.at(T::kType).signal) << T::kType;
    // The bytes of a PNG depend on the release of zlib; round_trip_test reads them back.
    if constexpr (std::is_same_v<T, Picture>) return;
    EXPECT_EQ(digests.log, kDigests.at(T::kType).log) << T::kType;
  });
}

}  // namespace
}  // namespace vinerow::record::message_bytes_test
