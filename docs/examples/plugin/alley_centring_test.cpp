#include "alley_centring.h"

#include <gtest/gtest.h>
#include <vinerow/testing.h>

#include <cmath>

namespace {

/// A rover 0.2 m left of the middle of a 20 m alley, with rangers to both sides.
vinerow::testing::SmallWorld alley() {
  return std::move(vinerow::testing::SmallWorld()
                       .vehicle("rover", "diff_drive_rover", "spawn: {alley: 0, offset_m: -2.0}")
                       .sensor("rover", "sonar_left", "ultrasound",
                               "position_m: [0, 0.4, 0.5], rotation_deg: [0, 0, 90]")
                       .sensor("rover", "sonar_right", "ultrasound",
                               "position_m: [0, -0.4, 0.5], rotation_deg: [0, 0, -90]"));
}

TEST(AlleyCentring, KeepsTheMiddleWithoutTouchingAVine) {
  auto run = alley().controller("rover", alley_centring_spec(), make_alley_centring).build();
  const double start_x = run.truth("rover").X_WB.p.x(), start_y = run.truth("rover").X_WB.p.y();
  run.run_for_s(15.0);
  const Eigen::Vector3d p = run.truth("rover").X_WB.p;
  EXPECT_GT(std::hypot(p.x() - start_x, p.y() - start_y), 10.0);
  EXPECT_EQ(run.metric("rover", "contact_count"), 0.0);
  EXPECT_GT(run.metric("rover", "min_clearance_m"), 0.2);
}

TEST(AlleyCentring, SameRunSameBits) {
  const auto digest = [] {
    return alley()
        .controller("rover", alley_centring_spec(), make_alley_centring)
        .build()
        .run_for_s(3.0)
        .digest();
  };
  EXPECT_EQ(digest(), digest());
}

TEST(AlleyCentring, WrongParametersAreRefused) {
  EXPECT_THROW(alley()
                   .controller("rover", alley_centring_spec(), make_alley_centring, "speed_mps: -1")
                   .build(),
               std::runtime_error);
}

}  // namespace
