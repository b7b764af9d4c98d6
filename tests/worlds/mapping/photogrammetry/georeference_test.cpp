/// The error that a block of pictures has in common, against closed forms and Umeyama's fit.

#include "worlds/mapping/photogrammetry/georeference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "engine/core/random.h"

namespace vinerow::mapping::georeference_test {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using Method = GeoreferenceOptions::Method;

/// Five lanes of twelve pictures, 28 m apart, 95 m above a hillside.
std::vector<Vector3d> flown() {
  std::vector<Vector3d> places;
  for (int lane = 0; lane < 5; ++lane) {
    for (int k = 0; k < 12; ++k) {
      places.emplace_back(14.0 * k - 80.0, 28.0 * lane - 56.0, 95.0 + 2.0 * lane);
    }
  }
  return places;
}

std::vector<KnownPlace> under(const Eigen::Affine3d& T, const std::vector<Vector3d>& places) {
  std::vector<KnownPlace> known;
  for (const Vector3d& p : places) known.push_back({p, T * p});
  return known;
}

TEST(Georeference, FindsASmallSimilarity) {
  Eigen::Affine3d T = Eigen::Affine3d::Identity();
  const Vector3d axis = Vector3d(0.4, -0.3, 0.8).normalized();
  T.translate(Vector3d(0.02, -0.03, 0.05));
  T.rotate(Eigen::AngleAxisd(2e-4, axis));
  T.scale(1.0 + 1e-4);
  const auto fit = fit_georeference(under(T, flown()), {0.01, 0.02});
  ASSERT_TRUE(fit);
  EXPECT_NEAR((fit->turn_rad - 2e-4 * axis).norm(), 0.0, 1e-7);
  EXPECT_NEAR(fit->scale, 1e-4, 1e-7);
  // Also far below the pictures, where the ground is; second order of the angle is 2e-6 m there.
  for (const Vector3d& p : {Vector3d(0, 0, 0), Vector3d(70, -30, 12)}) {
    EXPECT_NEAR((fit->error_m(p) - (T * p - p)).norm(), 0.0, 1e-5);
  }
}

TEST(Georeference, AgreesWithUmeyamasFitOfNoisyPlaces) {
  RandomStream random(3, "test", "georeference");
  std::vector<KnownPlace> known;
  Eigen::Matrix3Xd from(3, 60), to(3, 60);
  int i = 0;
  for (const Vector3d& p : flown()) {
    const Vector3d measured =
        p + 0.02 * Vector3d(random.normal(), random.normal(), random.normal());
    known.push_back({p, measured});
    from.col(i) = p;
    to.col(i++) = measured;
  }
  const auto fit = fit_georeference(known, {0.02, 0.02});
  ASSERT_TRUE(fit);
  const Eigen::Matrix4d T = Eigen::umeyama(from, to, true);
  for (const Vector3d& p : {Vector3d(0, 0, 0), Vector3d(60, -30, 10), Vector3d(-80, 56, 0)}) {
    const Vector3d theirs = (T * p.homogeneous()).head<3>() - p;
    EXPECT_NEAR((fit->error_m(p) - theirs).norm(), 0.0, 2e-5);
  }
}

TEST(Georeference, ABlockIsKnownBetterThanItsPictures) {
  // White errors of 2 cm at 60 places: the mean errs by 2 cm / sqrt(60), and the ground 97 m below
  // by what the tilt adds: std / sqrt(sum of squares of the arms) times the way down.
  constexpr int kBlocks = 400;
  double shift2 = 0.0, ground2 = 0.0;
  RandomStream random(4, "test", "georeference");
  const std::vector<Vector3d> places = flown();
  Vector3d centre = Vector3d::Zero();
  for (const Vector3d& p : places) centre += p / 60.0;
  double arms2 = 0.0;
  for (const Vector3d& p : places) arms2 += std::pow(p.y() - centre.y(), 2);
  for (int block = 0; block < kBlocks; ++block) {
    std::vector<KnownPlace> known;
    for (const Vector3d& p : places) {
      known.push_back({p, p + 0.02 * Vector3d(random.normal(), random.normal(), random.normal())});
    }
    const auto fit = fit_georeference(known, {0.02, 0.02});
    ASSERT_TRUE(fit);
    shift2 += std::pow(fit->error_m(centre).y(), 2) / kBlocks;
    ground2 += std::pow(fit->error_m(centre - Vector3d(0, 0, 97)).y(), 2) / kBlocks;
  }
  const double mean_m = 0.02 / std::sqrt(60.0);
  // Only heights determine the tilt about x, with arms along y.
  const double tilt_m = 97.0 * 0.02 / std::sqrt(arms2);
  EXPECT_NEAR(std::sqrt(shift2), mean_m, 0.15 * mean_m);
  EXPECT_NEAR(std::sqrt(ground2), std::hypot(mean_m, tilt_m), 0.15 * std::hypot(mean_m, tilt_m));
}

TEST(Georeference, OneLaneDoesNotTellTheTiltAboutIt) {
  std::vector<Vector3d> lane;
  for (int k = 0; k < 20; ++k) lane.emplace_back(10.0 * k, 0.3 * (k % 2), 95.0);
  const auto fit = fit_georeference(under(Eigen::Affine3d::Identity(), lane), {0.01, 0.02});
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.reason(), HasSubstr("are 0.1 m (rms) off one line, must be at least 3 m"));
  lane.resize(3);
  EXPECT_THAT(fit_georeference(under(Eigen::Affine3d::Identity(), lane), {0.01, 0.02}).reason(),
              HasSubstr("3 positions are known, a block of pictures needs at least 4"));
}

GeoreferenceRequest request(std::uint64_t seed) {
  GeoreferenceRequest r;
  r.cameras_W = flown();
  r.seed = seed;
  for (const Eigen::Vector2d& p :
       control_places(Eigen::AlignedBox2d(Eigen::Vector2d(-60, -20), Eigen::Vector2d(60, 20)), 5)) {
    r.marks_W.emplace_back(p.x(), p.y(), 0.0);
  }
  return r;
}

TEST(Georeference, MarksStandInTheCornersAndInTheMiddle) {
  const std::vector<Vector3d> marks = request(1).marks_W;
  ASSERT_EQ(marks.size(), 5u);
  EXPECT_EQ(marks[0], Vector3d(0, 0, 0));
  EXPECT_EQ(marks[1], Vector3d(-60, -20, 0));
  EXPECT_EQ(marks[2], Vector3d(60, -20, 0));
  EXPECT_EQ(marks[3], Vector3d(60, 20, 0));
  EXPECT_EQ(marks[4], Vector3d(-60, 20, 0));
}

TEST(Georeference, EachMeansIsAsGoodAsItsFiguresSay) {
  // Rms over seeds of the error in the middle of the ground: marks err by std / sqrt(5); PPK by its
  // common part, two thirds of the variance, and what the tilt of its white part adds.
  constexpr int kSeeds = 300;
  for (const Method method : {Method::kControlPoints, Method::kPpk}) {
    GeoreferenceOptions options;
    options.method = method;
    options.principal_distance_std = 0.0;
    double east2 = 0.0, up2 = 0.0;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      const auto found = georeference(request(static_cast<std::uint64_t>(seed)), options);
      ASSERT_TRUE(found);
      const Vector3d error = found->error_m({0, 0, 0});
      east2 += error.x() * error.x() / kSeeds;
      up2 += error.z() * error.z() / kSeeds;
    }
    std::printf("%s: %.4f m east, %.4f m up\n", name_of(method), std::sqrt(east2), std::sqrt(up2));
    if (method == Method::kControlPoints) {
      EXPECT_NEAR(std::sqrt(east2), 0.008 / std::sqrt(5.0), 0.15 * 0.008 / std::sqrt(5.0));
      EXPECT_NEAR(std::sqrt(up2), 0.015 / std::sqrt(5.0), 0.15 * 0.015 / std::sqrt(5.0));
    } else {
      EXPECT_NEAR(std::sqrt(up2), 0.015 * std::sqrt(2.0 / 3.0), 0.002);
      EXPECT_GT(std::sqrt(east2), 0.010 * std::sqrt(2.0 / 3.0) * 0.85);
      EXPECT_LT(std::sqrt(east2), 0.012);
    }
  }
}

TEST(Georeference, TheLensPutsHeightsWrongUnlessMarksTellIt) {
  GeoreferenceOptions options;
  options.method = Method::kPpk;
  options.ppk_std_m = {0.0, 0.0};
  options.principal_distance_std = 2e-4;
  double up2 = 0.0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    up2 += std::pow(georeference(request(seed), options)->error_m({0, 0, 0}).z(), 2) / 300;
  }
  EXPECT_NEAR(std::sqrt(up2), 2e-4 * 99.0, 0.15 * 2e-4 * 99.0);  // the cameras' mean height
  options.method = Method::kControlPoints;
  EXPECT_EQ(georeference(request(1), options)->height_scale, 0.0);
}

TEST(Georeference, DirectTakesWhatTheVehicleTold) {
  GeoreferenceRequest r = request(1);
  GeoreferenceOptions options;
  options.principal_distance_std = 0.0;
  EXPECT_EQ(georeference(r, options)->error_m({5, 6, 7}), Vector3d(0, 0, 0));  // no estimates
  for (const Vector3d& p : r.cameras_W) r.estimated_W.push_back(p + Vector3d(0.03, -0.01, 0.04));
  EXPECT_NEAR((georeference(r, options)->error_m({5, 6, 7}) - Vector3d(0.03, -0.01, 0.04)).norm(),
              0.0, 1e-9);
  options.method = Method::kTruth;
  EXPECT_EQ(georeference(r, options)->error_m({5, 6, 7}), Vector3d(0, 0, 0));
}

}  // namespace
}  // namespace vinerow::mapping::georeference_test
