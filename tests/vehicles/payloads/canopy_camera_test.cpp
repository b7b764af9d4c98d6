/// Ground sampling distance in closed form, what hides behind a row, how often it is seen.

#include "vehicles/payloads/canopy_camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/vehicles/payloads/payload_rig.h"

namespace vinerow::vehicles::canopy_camera_test {
namespace {

using namespace test;

/// A single camera to the left with pixels of 1/1000 at depth 1.
PayloadValues one_camera(const PayloadValues& more = {}) {
  PayloadValues values = {{"yaws_deg", std::vector<double>{90.0}},
                          {"fov_horizontal_deg", 2.0 * deg_from_rad(std::atan(0.5))},
                          {"fov_vertical_deg", 2.0 * deg_from_rad(std::atan(0.4))},
                          {"image_columns", std::int64_t{1000}},
                          {"image_rows", std::int64_t{800}},
                          {"wanted_gsd_mm", 100.0},
                          {"range_m", 50.0}};
  values.insert(values.end(), more.begin(), more.end());
  return values;
}

double seen_area(const PayloadRig& rig, int row, double views = 1.0) {
  double area_m2 = 0.0;
  for (const CanopyPatch& patch : rig.patches()) {
    if (patch.row == row && patch.amount >= views) area_m2 += patch.area_m2;
  }
  return area_m2;
}

TEST(CanopyCamera, OnAWallAcrossTheAxisTheGsdIsDepthTimesPixel) {
  // Face 2.25 m to the left.
  PayloadRig rig("canopy_camera", make_box_rows({{.y_m = 2.5, .base_m = -1.0, .top_m = 6.0}}),
                 one_camera());
  rig.z_m = 1.25;
  rig.tick(10.0, 0.0, 0.0, 1.0);
  // Everywhere in the picture, off the axis too.
  EXPECT_NEAR(rig.result("gsd_mean_mm"), 2.25, 1e-6);
  EXPECT_NEAR(rig.signal_value("gsd_mm"), 2.25, 1e-6);
  EXPECT_EQ(rig.result("pictures"), 1.0);
}

TEST(CanopyCamera, AslantTheGsdGrowsByTheRootOfTheCosine) {
  const PayloadValues one_ray = {{"ray_columns", std::int64_t{1}}, {"ray_rows", std::int64_t{1}}};
  for (const double angle_deg : {0.0, 30.0, 60.0}) {
    PayloadRig rig("canopy_camera", make_box_rows({{.y_m = 2.5}}), one_camera(one_ray));
    rig.z_m = 1.25;
    rig.tick(10.0, 0.0, rad_from_deg(angle_deg), 1.0);
    const double cosine = std::cos(rad_from_deg(angle_deg));
    EXPECT_NEAR(rig.signal_value("gsd_mm"), 2.25 / cosine / std::sqrt(cosine), 1e-6);
  }
}

TEST(CanopyCamera, WhatIsTooCoarseTooSlantOrTooFarIsNotSeen) {
  const auto seen = [](const PayloadValues& more, double yaw_deg = 0.0) {
    PayloadRig rig("canopy_camera", make_box_rows({{.y_m = 2.5}}), one_camera(more));
    rig.z_m = 1.25;
    rig.tick(10.0, 0.0, rad_from_deg(yaw_deg), 1.0);
    return rig.result("seen_share") > 0.0;
  };
  EXPECT_TRUE(seen({{"wanted_gsd_mm", 2.26}}));
  EXPECT_FALSE(seen({{"wanted_gsd_mm", 2.24}}));
  EXPECT_TRUE(seen({{"range_m", 2.3}}));
  EXPECT_FALSE(seen({{"range_m", 2.2}}));
  // The axis at 60 degrees; the picture's near edge is atan(0.5) = 27 degrees off it.
  EXPECT_TRUE(seen({{"max_incidence_deg", 36.0}}, 60.0));
  EXPECT_FALSE(seen({{"max_incidence_deg", 33.0}}, 60.0));
}

TEST(CanopyCamera, SeesThePatchesWithinItsFootprint) {
  // From 2.25 m: 2.25 m wide, 1.8 m high. The wall fills it; dense rays miss no patch.
  PayloadRig rig("canopy_camera", make_box_rows({{.y_m = 2.5, .base_m = -1.0, .top_m = 6.0}}),
                 one_camera({{"ray_columns", std::int64_t{200}}, {"ray_rows", std::int64_t{160}}}));
  rig.z_m = 1.25;
  rig.tick(10.0, 0.0, 0.0, 1.0);
  for (const CanopyPatch& patch : rig.patches()) {
    if (patch.band == 0) continue;  // with what is below the ground
    const double left = 0.25 * patch.along, low = 0.25 * patch.band;
    const bool within = patch.side == -1 && left + 0.25 > 10.0 - 1.125 && left < 10.0 + 1.125 &&
                        low + 0.25 > 1.25 - 0.9 && low < 1.25 + 0.9;
    // A patch of which the footprint shows less than a ray's width may be missed.
    const bool barely = within && (left + 0.25 < 10.0 - 1.1 || left > 10.0 + 1.1 ||
                                   low + 0.25 < 1.25 - 0.88 || low > 1.25 + 0.88);
    if (!barely) {
      EXPECT_EQ(patch.amount, within ? 1.0 : 0.0) << patch.along << ", " << patch.band;
    }
  }
}

TEST(CanopyCamera, DoesNotSeeThroughARow) {
  const std::vector<BoxRow> rows = {{.y_m = 2.5}, {.y_m = 5.0}};
  PayloadRig rig("canopy_camera", make_box_rows(rows), one_camera());
  rig.z_m = 1.25;
  rig.pass(2.0, 18.0, 0.0, 1.0);
  EXPECT_GT(seen_area(rig, 10), 10.0);
  EXPECT_EQ(seen_area(rig, 11), 0.0);
  // From above it looks over it: the top of the second row.
  PayloadRig above("canopy_camera", make_box_rows(rows), one_camera({{"pitch_deg", 30.0}}));
  above.z_m = 4.0;
  above.pass(2.0, 18.0, 0.0, 1.0);
  EXPECT_GT(seen_area(above, 11), 2.0);
  // Never the far sides.
  for (const CanopyPatch& patch : above.patches()) {
    if (patch.side == 1 && patch.band < 7) {
      EXPECT_EQ(patch.amount, 0.0);
    }
  }
}

TEST(CanopyCamera, PostsHideWhatIsBehindThem) {
  WorldModel world = make_box_rows({{.y_m = 2.5}});
  world.meshes.push_back(make_box("wall", {20.0f, 0.05f, 3.0f}, {10, 1, 1.0}, SurfaceClass::kPost));
  PayloadRig rig("canopy_camera", std::move(world), one_camera());
  rig.z_m = 1.25;
  rig.tick(10.0, 0.0, 0.0, 1.0);
  EXPECT_EQ(rig.result("seen_share"), 0.0);
  EXPECT_EQ(rig.result("canopy_pictures"), 0.0);
  EXPECT_TRUE(std::isnan(rig.result("gsd_mean_mm")));
}

TEST(CanopyCamera, CountsThePicturesThatShowAPatch) {
  PayloadRig rig("canopy_camera", make_box_rows({{.y_m = 2.5}}),
                 one_camera({{"wanted_views", std::int64_t{3}}}));
  rig.z_m = 1.25;
  rig.tick(5.0, 0.0, 0.0, 1.0);
  const double once = rig.result("seen_share");
  EXPECT_GT(once, 0.0);
  EXPECT_EQ(rig.result("seen_twice_share"), 0.0);
  rig.tick(5.0, 0.0, 0.0, 1.0);
  EXPECT_EQ(rig.result("seen_share"), once);
  EXPECT_EQ(rig.result("seen_twice_share"), once);
  rig.tick(15.0, 0.0, 0.0, 1.0);
  EXPECT_NEAR(rig.result("seen_share"), 2.0 * once, 0.2 * once);
  EXPECT_EQ(rig.result("seen_twice_share"), once);
  EXPECT_EQ(rig.payload->coverage()->wanted, 3.0);
}

TEST(CanopyCamera, TwoCamerasSeeBothRows) {
  PayloadRig rig("canopy_camera", make_box_rows({{.y_m = 1.25}, {.y_m = -1.25}}));
  rig.z_m = 1.5;
  rig.pass(-1.0, 21.0, 0.0, 1.0);
  EXPECT_GT(seen_area(rig, 10), 25.0);
  EXPECT_NEAR(seen_area(rig, 10), seen_area(rig, 11), 1.0);
  EXPECT_EQ(rig.result("pictures"), 2.0 * 45.0);
  // 1 m to the face: 3.45 um / 6 mm.
  EXPECT_NEAR(rig.result("gsd_mean_mm"), 0.58, 0.1);
}

TEST(CanopyCamera, AGimbalTakesRollOutOfThePictures) {
  const auto seen = [](bool stabilised) {
    PayloadRig rig("canopy_camera", make_box_rows({{.y_m = 2.5}}),
                   one_camera({{"stabilised", stabilised}}));
    Odometry odometry;
    odometry.X_WB.p = {10.0, 0.0, 1.25};
    odometry.X_WB.q = quaternion_from_rpy({rad_from_deg(-60.0), 0.0, 0.0});  // left side down
    rig.truth.write(rig.now, odometry);
    rig.payload->step(rig.now);
    return rig.result("seen_share");
  };
  EXPECT_GT(seen(true), 0.0);
  EXPECT_EQ(seen(false), 0.0);
}

TEST(CanopyCamera, OnLegsItTakesPicturesThereAlone) {
  PayloadRig rig("canopy_camera", make_box_rows({{.y_m = 2.5}}),
                 one_camera({{"on", std::string("legs")}}));
  rig.tick(5.0, 0.0, 0.0, 1.0);
  EXPECT_EQ(rig.result("pictures"), 0.0);
  PlannedPath plan;
  plan.points.resize(3);
  plan.points[1].p_W = {10, 0, 0};
  plan.points[1].kind = PathKind::kTurn;
  plan.points[2].p_W = {20, 0, 0};
  rig.plan.write(rig.now, plan);
  rig.tick(5.0, 0.0, 0.0, 1.0);
  EXPECT_EQ(rig.result("pictures"), 1.0);
  rig.tick(15.0, 0.0, 0.0, 1.0);
  EXPECT_EQ(rig.result("pictures"), 1.0);
}

TEST(CanopyCamera, BadParametersAreToldInASentence) {
  const auto error = [](const PayloadValues& values) {
    return config_error_of(
        [&] { PayloadRig("canopy_camera", make_box_rows({{.y_m = 1.0}}), values); });
  };
  EXPECT_EQ(error({{"yaws_deg", std::vector<double>{}}}),
            "rover.p: yaws_deg = [], must name at least one camera");
  EXPECT_NE(error({{"fov_horizontal_deg", 180.0}}).find("fov_horizontal_deg = 180"),
            std::string::npos);
  EXPECT_NE(error({{"ray_columns", std::int64_t{0}}}).find("ray_columns = 0"), std::string::npos);
}

}  // namespace
}  // namespace vinerow::vehicles::canopy_camera_test
