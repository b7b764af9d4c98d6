// Judgement of a foot's contact: limits of speed and tilt, and what was met.

#include "vehicles/quadrotor/crash_watch.h"

#include <gtest/gtest.h>

namespace vinerow::vehicles::crash_watch_test {
namespace {

/// On level ground, tilted about a horizontal axis.
physics::BodyState landing(double speed_mps, double tilt_deg) {
  physics::BodyState body;
  body.X_WB.q = Eigen::AngleAxisd(rad_from_deg(tilt_deg), Eigen::Vector3d(0.6, 0.8, 0.0));
  body.v_WB_W = speed_mps * Eigen::Vector3d(0.48, 0.64, -0.6);
  body.w_WB_W.setZero();
  return body;
}

std::string on(SurfaceClass surface, double speed_mps, double tilt_deg) {
  QuadrotorParams params;
  params.landing_speed_limit_mps = 1.5;
  params.landing_tilt_limit_rad = rad_from_deg(20.0);
  FootContact contact;
  contact.surface = surface;
  return find_crash_at_foot(contact, landing(speed_mps, tilt_deg), params);
}

TEST(CrashWatch, AFootMayTouchTheGroundWithinBothLimits) {
  EXPECT_EQ(on(SurfaceClass::kTerrain, 0.0, 0.0), "");
  EXPECT_EQ(on(SurfaceClass::kTerrain, 1.49, 19.9), "");
}

TEST(CrashWatch, TheSpeedCountsInAllDirections) {
  EXPECT_EQ(on(SurfaceClass::kTerrain, 1.51, 0.0), "hit the ground at 1.5 m/s");
}

TEST(CrashWatch, TheTiltCountsAboutAnyAxis) {
  EXPECT_EQ(on(SurfaceClass::kTerrain, 0.1, 20.6), "touched the ground tilted by 21 deg");
  EXPECT_EQ(on(SurfaceClass::kTerrain, 0.1, 180.0), "touched the ground tilted by 180 deg");
}

TEST(CrashWatch, TheSpeedIsReportedBeforeTheTilt) {
  EXPECT_EQ(on(SurfaceClass::kTerrain, 4.0, 60.0), "hit the ground at 4.0 m/s");
}

TEST(CrashWatch, AnythingButGroundWrecksAtAnySpeed) {
  EXPECT_EQ(on(SurfaceClass::kPost, 0.1, 0.0), "hit post with its landing gear at 0.1 m/s");
  EXPECT_EQ(on(SurfaceClass::kObstacle, 0.1, 0.0), "hit obstacle with its landing gear at 0.1 m/s");
}

}  // namespace
}  // namespace vinerow::vehicles::crash_watch_test
