/// Ground and rows of parcels known in closed form: how many rows, where, how far apart.

#include <gtest/gtest.h>

#include "engine/math/angles.h"
#include "tests/worlds/mapping/photogrammetry/synthetic_parcel.h"
#include "worlds/mapping/rows/canopy_raster.h"
#include "worlds/mapping/rows/cloud_terrain.h"
#include "worlds/mapping/rows/row_direction.h"
#include "worlds/mapping/rows/row_lines.h"
#include "worlds/mapping/rows/row_points.h"
#include "worlds/mapping/rows/row_tracking.h"

namespace vinerow::mapping::row_detection_test {
namespace {

using Eigen::Vector2d;
using test::SyntheticParcel;

/// The stages in a row, as make_cloud_map() calls them.
struct Found {
  ParcelCloud cloud;
  CloudTerrain terrain;
  double spacing_m = 0.0;
  std::vector<RowCurve> lines;

  explicit Found(ParcelCloud points) : cloud(std::move(points)), terrain(fit_terrain(cloud, 1.0)) {
    const HeightAbove above(terrain.field, cloud.origin_W);
    const CanopyRaster raster =
        make_canopy_raster(cloud, above, 0.1, body_height_m(cloud, above, 0.55, 6.0), 6.0);
    const auto patches = consistent_windows(find_row_patches(coarsen(raster, 2), {}), {});
    if (patches.empty()) return;
    spacing_m = median_spacing_m(patches);
    RowTrackingOptions tracking;
    tracking.spacing_m = spacing_m;
    RowLineOptions line_options;
    line_options.spacing_m = spacing_m;
    lines = fit_row_lines(raster, track_rows(raster, patches, tracking), line_options);
  }
  Vector2d point_W(std::size_t row, double share) const {
    return lines[row].point_W(share * lines[row].length_m()) + cloud.origin_W.head<2>();
  }
};

Found find(const SyntheticParcel& parcel) {
  return Found(test::make_synthetic_cloud(parcel).cloud);
}

struct Ends {
  Vector2d first, last;
};

/// The true row that a found one lies on, by its middle; -1 where there is none within half a
/// spacing.
int true_row(const SyntheticParcel& parcel, const Vector2d& middle_W) {
  for (int k = 0; k < parcel.rows; ++k) {
    for (double s_m = 0.0; s_m <= parcel.length_m; s_m += 0.5) {
      if ((parcel.place_W(k, s_m, 0.0) - middle_W).norm() < 0.5 * parcel.spacing_m) return k;
    }
  }
  return -1;
}

struct Errors {
  std::vector<int> rows;     // true ones, in the order found
  double end_m = 0.0;        // worst
  double direction_deg = 0;  // worst, of the chord
  double spacing_m = 0.0;    // of the mean distance between neighbours, at mid length
  double across_m = 0.0;     // worst distance of the line from the true middle
};

Errors errors_of(const SyntheticParcel& parcel, const Found& found) {
  Errors errors;
  double apart_m = 0.0;
  const double end_m = std::floor(parcel.length_m / parcel.vine_m) * parcel.vine_m;
  for (std::size_t r = 0; r < found.lines.size(); ++r) {
    const int k = true_row(parcel, found.point_W(r, 0.5));
    errors.rows.push_back(k);
    if (k < 0) continue;
    Ends truth{parcel.place_W(k, 0.0, 0.0), parcel.place_W(k, end_m, 0.0)};
    const Ends seen{found.point_W(r, 0.0), found.point_W(r, 1.0)};
    if ((seen.last - seen.first).dot(truth.last - truth.first) < 0.0) {
      std::swap(truth.first, truth.last);
    }
    errors.end_m = std::max(
        {errors.end_m, (seen.first - truth.first).norm(), (seen.last - truth.last).norm()});
    const Vector2d a = seen.last - seen.first, b = truth.last - truth.first;
    errors.direction_deg =
        std::max(errors.direction_deg,
                 deg_from_rad(std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)))));
    for (double share = 0.02; share < 0.99; share += 0.04) {
      double nearest_m = 1e9;
      for (double s_m = 0.0; s_m <= end_m; s_m += 0.05) {
        nearest_m =
            std::min(nearest_m, (parcel.place_W(k, s_m, 0.0) - found.point_W(r, share)).norm());
      }
      errors.across_m = std::max(errors.across_m, nearest_m);
    }
    if (r > 0) {
      double d = 0.0;
      found.lines[r - 1].nearest_s_m(found.lines[r].point_W(0.5 * found.lines[r].length_m()), &d);
      apart_m += d;
    }
  }
  const double pairs = static_cast<double>(found.lines.size()) - 1.0;
  errors.spacing_m = apart_m / pairs - parcel.spacing_m;
  return errors;
}

/// All rows, each once, side by side.
void expect_all_rows(const SyntheticParcel& parcel, const Errors& errors) {
  ASSERT_EQ(errors.rows.size(), static_cast<std::size_t>(parcel.rows));
  const bool is_rising = errors.rows.front() == 0;
  for (int k = 0; k < parcel.rows; ++k) {
    EXPECT_EQ(errors.rows[static_cast<std::size_t>(k)], is_rising ? k : parcel.rows - 1 - k);
  }
}

TEST(RowDetection, ParcelFOnASlope) {
  SyntheticParcel parcel;
  parcel.rows = 16;
  parcel.length_m = 118.0;
  parcel.missing = 0.024;
  parcel.slope_x = 0.1, parcel.slope_y = 0.2, parcel.wave_m = 0.5;
  parcel.density_per_m2 = 120.0;
  const Found found = find(parcel);
  const Errors errors = errors_of(parcel, found);
  expect_all_rows(parcel, errors);
  EXPECT_LT(errors.end_m, 0.3);
  EXPECT_LT(errors.direction_deg, 0.1);
  EXPECT_LT(std::abs(errors.spacing_m), 0.01);
  EXPECT_LT(errors.across_m, 0.05);
  RecordProperty("end_m", std::to_string(errors.end_m));
}

TEST(RowDetection, CurvedThinNoisyAmongWeeds) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    SyntheticParcel parcel;
    parcel.seed = seed;
    parcel.rows = 10;
    parcel.length_m = 70.0;
    parcel.radius_m = 60.0;
    parcel.missing = 0.25;
    parcel.weeds_m = 0.5;
    parcel.noise_m = 0.05;
    parcel.slope_x = 0.2;
    const Errors errors = errors_of(parcel, find(parcel));
    expect_all_rows(parcel, errors);
    EXPECT_LT(errors.end_m, 0.3) << "seed " << seed;
    EXPECT_LT(errors.across_m, 0.12) << "seed " << seed;
    EXPECT_LT(std::abs(errors.spacing_m), 0.02) << "seed " << seed;
  }
}

TEST(RowDetection, EveryDirectionAndSpacing) {
  for (int k = 0; k < 9; ++k) {
    SyntheticParcel parcel;
    parcel.rows = 5 + k % 3;
    parcel.length_m = 40.0;
    parcel.angle_deg = 20.0 * k - 0.5;
    parcel.spacing_m = 1.5 + 0.3 * k;
    parcel.density_per_m2 = 100.0;
    const Errors errors = errors_of(parcel, find(parcel));
    SCOPED_TRACE(::testing::Message() << parcel.angle_deg << " deg, " << parcel.spacing_m << " m");
    expect_all_rows(parcel, errors);
    EXPECT_LT(errors.end_m, 0.3);
    EXPECT_LT(errors.direction_deg, 0.1);
    EXPECT_LT(std::abs(errors.spacing_m), 0.01);
  }
}

TEST(RowDetection, TwoRowsAreRows) {
  SyntheticParcel parcel;
  parcel.rows = 2;
  parcel.length_m = 25.0;
  const Errors errors = errors_of(parcel, find(parcel));
  expect_all_rows(parcel, errors);
}

TEST(RowDetection, RowsRunFromSouthToNorthAndFromLeftToRight) {
  for (const double angle_deg : {10.0, 170.0, 200.0, 350.0}) {
    SyntheticParcel parcel;
    parcel.rows = 4;
    parcel.length_m = 30.0;
    parcel.angle_deg = angle_deg;
    const Found found = find(parcel);
    ASSERT_EQ(found.lines.size(), 4u);
    for (std::size_t r = 0; r < 4; ++r) {
      EXPECT_GT((found.point_W(r, 1.0) - found.point_W(r, 0.0)).y(), 0.0) << angle_deg;
    }
    const Vector2d d = found.point_W(0, 1.0) - found.point_W(0, 0.0);
    const Vector2d across = found.point_W(3, 0.5) - found.point_W(0, 0.5);
    EXPECT_GT(across.dot(Vector2d(d.y(), -d.x())), 0.0) << "the last row lies on the right";
  }
}

TEST(RowDetection, LongGapOfOneRowIsAGapAndATrackThroughAllRowsIsNone) {
  SyntheticParcel parcel;
  parcel.rows = 5;
  parcel.length_m = 60.0;
  const auto whole = test::make_synthetic_cloud(parcel).cloud;
  const auto without = [&](bool (*is_cut)(double s_m, double y_m)) {
    ParcelCloud cut = whole;
    cut.points.clear();
    const double c = std::cos(rad_from_deg(parcel.angle_deg)),
                 s = std::sin(rad_from_deg(parcel.angle_deg));
    for (const Eigen::Vector3f& p : whole.points) {
      const Vector2d local(c * p.x() + s * p.y(), -s * p.x() + c * p.y());
      if (!(p.z() > 0.3f && is_cut(local.x(), local.y()))) cut.points.push_back(p);
    }
    return cut;
  };
  // 14 m of the middle row.
  const Found one(
      without([](double s_m, double y_m) { return std::abs(s_m) < 7.0 && std::abs(y_m) < 1.0; }));
  EXPECT_EQ(one.lines.size(), 5u);
  // A track of 14 m across all rows: two blocks of five.
  const Found all(without([](double s_m, double) { return std::abs(s_m) < 7.0; }));
  EXPECT_EQ(all.lines.size(), 10u);
}

TEST(RowDetection, HedgeAndTreesAreNoRows) {
  SyntheticParcel parcel;
  parcel.rows = 5;
  parcel.length_m = 50.0;
  parcel.margin_m = 14.0;
  ParcelCloud cloud = test::make_synthetic_cloud(parcel).cloud;
  RandomStream random(7, "", "hedge");
  const auto add = [&](const Vector2d& p_W, double height_m) {
    cloud.points.push_back(
        (Eigen::Vector3d(p_W.x(), p_W.y(), parcel.ground_m(p_W.x(), p_W.y()) + height_m) -
         cloud.origin_W)
            .cast<float>());
  };
  for (int n = 0; n < 40'000; ++n) {
    // A hedge 8 m beside the last row, and a tree crown behind the rows' ends.
    add(parcel.place_W(4, random.uniform(0.0, 50.0), 8.0 + random.uniform(-0.5, 0.5)),
        random.uniform(0.5, 2.0));
    const double turn = random.uniform(0.0, 2.0 * M_PI),
                 r = 3.0 * std::sqrt(random.uniform(0.0, 1.0));
    add(parcel.place_W(2, 60.0 + r * std::cos(turn), r * std::sin(turn)), random.uniform(2.0, 5.0));
  }
  const Found found(std::move(cloud));
  EXPECT_EQ(found.lines.size(), 5u);
}

TEST(RowDetection, MeadowBareGroundAndOneHedgeHaveNoRows) {
  SyntheticParcel parcel;
  parcel.rows = 2;
  parcel.length_m = 60.0;
  parcel.margin_m = 20.0;
  ParcelCloud bare = test::make_synthetic_cloud(parcel).cloud;
  std::erase_if(bare.points, [](const Eigen::Vector3f& p) { return p.z() > 0.3f; });
  EXPECT_TRUE(Found(bare).lines.empty());
  // Tall grass and bushes anywhere.
  ParcelCloud meadow = bare;
  RandomStream random(3, "", "meadow");
  for (int bush = 0; bush < 150; ++bush) {
    const double x = random.uniform(-40.0, 40.0), y = random.uniform(-20.0, 20.0);
    for (int n = 0; n < 200; ++n) {
      meadow.points.emplace_back(static_cast<float>(x + 0.5 * random.normal()),
                                 static_cast<float>(y + 0.5 * random.normal()),
                                 static_cast<float>(random.uniform(0.3, 1.5)));
    }
  }
  EXPECT_TRUE(Found(meadow).lines.empty());
  ParcelCloud hedge = bare;
  for (int n = 0; n < 20'000; ++n) {
    hedge.points.emplace_back(static_cast<float>(random.uniform(-30.0, 30.0)),
                              static_cast<float>(random.uniform(-0.4, 0.4)),
                              static_cast<float>(random.uniform(0.3, 1.8)));
  }
  EXPECT_TRUE(Found(hedge).lines.empty());
}

TEST(CloudTerrain, FollowsTheGroundBelowCanopyAndWeeds) {
  SyntheticParcel parcel;
  parcel.rows = 8;
  parcel.length_m = 60.0;
  parcel.slope_x = 0.3, parcel.slope_y = -0.2, parcel.wave_m = 0.6;
  parcel.outliers = 0.01;
  for (const double weeds_m : {0.0, 0.5}) {
    parcel.weeds_m = weeds_m;
    const ParcelCloud cloud = test::make_synthetic_cloud(parcel).cloud;
    const CloudTerrain terrain = fit_terrain(cloud, 1.0);
    double squares = 0.0, mean = 0.0, worst = 0.0;
    int count = 0;
    for (int k = 0; k < parcel.rows; ++k) {
      for (double s_m = 0.0; s_m <= parcel.length_m; s_m += 0.7) {
        for (const double y_m : {-1.2, -0.6, 0.0, 0.6}) {
          const Vector2d p = parcel.place_W(k, s_m, y_m);
          const double error = terrain.field.height_m(p.x(), p.y()) - parcel.ground_m(p.x(), p.y());
          squares += error * error, mean += error, worst = std::max(worst, std::abs(error));
          ++count;
        }
      }
    }
    // Tufts of half a metre cover most of the ground, and it is taken for their lowest third.
    EXPECT_LT(std::sqrt(squares / count), weeds_m > 0.0 ? 0.06 : 0.02);
    EXPECT_LT(std::abs(mean / count), weeds_m > 0.0 ? 0.05 : 0.005);
    EXPECT_LT(worst, weeds_m > 0.0 ? 0.12 : 0.08);
    if (weeds_m == 0.0) {
      EXPECT_NEAR(terrain.noise_m, parcel.noise_m, 0.02);
    }
  }
}

TEST(CloudTerrain, GivesTheSameBitsTwice) {
  const ParcelCloud cloud = test::make_synthetic_cloud({}).cloud;
  EXPECT_EQ(fit_terrain(cloud, 1.0).field.heights_m, fit_terrain(cloud, 1.0).field.heights_m);
}

TEST(HeightAbove, IsTheFieldsOwnSurface) {
  SyntheticParcel parcel;
  parcel.wave_m = 2.0;
  const ParcelCloud cloud = test::make_synthetic_cloud(parcel).cloud;
  const HeightField field = fit_terrain(cloud, 1.0).field;
  const HeightAbove above(field, cloud.origin_W);
  for (std::size_t k = 0; k < cloud.points.size(); k += 97) {
    const Eigen::Vector3d p = cloud.point_W(k);
    EXPECT_NEAR(above(cloud.points[k]), p.z() - field.height_m(p.x(), p.y()), 2e-4);
  }
}

TEST(RowPoints, TellsGroundWeedsAndCanopyApart) {
  SyntheticParcel parcel;
  parcel.rows = 4;
  parcel.length_m = 40.0;
  parcel.slope_y = 0.15;
  Found found = find(parcel);
  ASSERT_EQ(found.lines.size(), 4u);
  RowPointOptions options;
  options.spacing_m = found.spacing_m;
  const auto canopies = gather_row_canopies(found.cloud, found.terrain.field, found.lines, options);
  ASSERT_EQ(canopies.size(), 4u);
  ASSERT_EQ(found.cloud.classes.size(), found.cloud.points.size());
  std::size_t gathered = 0;
  for (const RowCanopy& canopy : canopies) gathered += canopy.points.size();
  std::size_t canopy = 0, wrong = 0;
  for (std::size_t k = 0; k < found.cloud.points.size(); ++k) {
    const Eigen::Vector3d p = found.cloud.point_W(k);
    const double height_m = p.z() - parcel.ground_m(p.x(), p.y());
    const bool is_canopy = found.cloud.classes[k] == PointClass::kCanopy;
    canopy += is_canopy ? 1 : 0;
    wrong += is_canopy != (height_m > 0.4) ? 1 : 0;
  }
  EXPECT_EQ(canopy, gathered);
  EXPECT_LT(static_cast<double>(wrong), 0.005 * static_cast<double>(canopy));
  // In the row's frame the canopy is the ellipse that it was made of.
  for (const RowCanopy& row : canopies) {
    double off = 0.0;
    for (const Eigen::Vector3f& p : row.points) {
      off += std::hypot(p.y() / 0.3, (p.z() - 1.25) / 0.75) - 1.0;
    }
    EXPECT_NEAR(off / static_cast<double>(row.points.size()), 0.0, 0.02);
  }
}

TEST(RowPoints, TallWeedsBesideARowAreNotItsCanopy) {
  SyntheticParcel parcel;
  parcel.rows = 4;
  parcel.length_m = 40.0;
  parcel.angle_deg = 0.0;
  parcel.weeds_m = 0.75;
  parcel.noise_m = 0.01;
  Found found = find(parcel);
  ASSERT_EQ(found.lines.size(), 4u);
  RowPointOptions options;
  options.spacing_m = found.spacing_m;
  options.body_cut_m =
      body_height_m(found.cloud, HeightAbove(found.terrain.field, found.cloud.origin_W), 0.55, 6.0);
  EXPECT_GT(options.body_cut_m, 0.7);
  gather_row_canopies(found.cloud, found.terrain.field, found.lines, options);
  std::size_t weeds = 0, misclassified = 0;
  for (std::size_t k = 0; k < found.cloud.points.size(); ++k) {
    const Eigen::Vector3d p = found.cloud.point_W(k);
    const double across = (p.y() - parcel.middle_W.y()) / parcel.spacing_m + 1.5;
    const double off_m = std::abs(across - std::round(across)) * parcel.spacing_m;
    const double height_m = p.z() - parcel.ground_m(p.x(), p.y());
    if (off_m < 0.6 || across < -0.4 || across > 3.4 || height_m < 0.6) continue;
    ++weeds;
    misclassified += found.cloud.classes[k] == PointClass::kCanopy ? 1 : 0;
  }
  EXPECT_GT(weeds, 1000u);
  EXPECT_LT(misclassified, weeds / 100);
}

}  // namespace
}  // namespace vinerow::mapping::row_detection_test
