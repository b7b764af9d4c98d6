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
     {"14bd8d75fb378774b2963ba01ef70c68", "c12ccbc62532a5fa80440af883a8e2be"}},
    {"ImuSample",
     {"9fde4e41b4059b70c39fa9afdc475447", "9352c4d798cff274a6ae1130a2b1dc4f"}},
    {"GnssFix",
     {"4d22b2b39587d5de98786ff7d5114226", "230835d88f3d4f7aa3c967c6c97957d1"}},
    {"RangeSample",
     {"5beb75c27f74245124f8373598aeb15f", "e3cb666143a62b98a5abf1ed2dffd737"}},
    {"PressureSample",
     {"8bf495501b0f488d660f77f31bedd1cc", "550b3518ddfbb9c28e4bb93bb1eeca50"}},
    {"MagneticSample",
     {"cf0b3c17696a134bdac6123a8771f290", "0bc086d35224f2107ac111223aca8696"}},
    {"LaserScan",
     {"c9b1deae4a17c30d8ced1326a1f7ba4b", "a9df3d91c941bf555a30f164614799cb"}},
    {"PositionEllipsoid",
     {"5114b46a4652eca5434320468fa8b445", "3cc4f413afb6d850e0789073a0c833ec"}},
    {"GnssHeading",
     {"2ce143f7cbd9e45596c64400b050af28", "b338dca0b6906339e69e486f17ee15c8"}},
    {"VelocityCommand",
     {"804c009d8e5e5a813d1142fb34d07f22", "e9ab789e48273e7c5add587f3f4e19d9"}},
    {"LocalCommand",
     {"ed23a7fccd3a7779afbbccae538425d3", "661fdcee870eda169a82ba6c03b1606d"}},
    {"LineList",
     {"604c508128f143dfe9982e9771ecf5e0", "315f537cda13d600bd54c78608c109b2"}},
    {"OccupancyGrid",
     {"66b87bbdd430641325835d231da23e9f", "a162c8c4e6ba45574fb1e0dea2439d56"}},
    {"NamedValues",
     {"ff736a4273522e2c2fe6b91ae9aa6640", "656f8549ec63e78abbacc10979aab8e7"}},
    {"LinkPoses",
     {"223887e6c52763d9ee4b979c122b5d29", "209c8fe1d8181d4acc222f09da8f7de7"}},
    {"PlannedPath",
     {"751b0e8b0f42886a991506e12a33c7ac", "b80bfd842ee914c81c7e11197545f4a3"}},
    {"FollowerState",
     {"a51cfc7ff5b951be24c7bd9ebbe7da58", "7bcf5100dccb5c9b9e1ceb741b6fe20c"}},
    {"MovementAuthority",
     {"784429ad9f7e520fd99854277d24547d", "d1694cadd2984bb8e899faf67b5cdf9f"}},
    {"ReferenceTrajectory",
     {"c558515c23151f2d427e266ed943484c", "5e5819423b63528dd4a7230630ceb8d9"}},
    {"AirReference",
     {"57213c1ac4cde0b61b3abd37c237a781", "559ccb14d912617c1829ec6f5d7fe9ad"}},
    {"AirData",
     {"10cd8074f09f885628856ed2c5929603", "83419f88cf7cd94390eb98323c26eea4"}},
    {"CameraShot",
     {"7d4e4073dd136928ac830871ae6260ac", "61d94e039544e76fbbf768199ee9a058"}},
    {"BatteryState",
     {"aa056599cc33c3bdc99f5dcf65edc1af", "b546930fb166b97c8e799d83af58e79a"}},
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
    EXPECT_EQ(digests.log, kDigests.at(T::kType).log) << T::kType;
  });
}

}  // namespace
}  // namespace vinerow::record::message_bytes_test
