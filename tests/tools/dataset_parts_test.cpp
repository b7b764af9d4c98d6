/// Parts of data sets against closed forms: masks, splits, and annotations of things in a picture.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/core/random.h"
#include "tools/dataset/annotate.h"
#include "tools/dataset/mask.h"
#include "tools/dataset/outline.h"
#include "tools/dataset/panoptic.h"
#include "tools/dataset/splits.h"

namespace vinerow::dataset::dataset_parts_test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Pixels of a mask, column by column.
template <class Is>
std::vector<std::uint32_t> pixels_where(int width, int height, Is&& is) {
  std::vector<std::uint32_t> pixels;
  for (int x = 0; x < width; ++x) {
    for (int y = 0; y < height; ++y) {
      if (is(x, y)) pixels.push_back(static_cast<std::uint32_t>(x * height + y));
    }
  }
  return pixels;
}

TEST(Mask, HasRunsDownTheColumns) {
  const auto pixels = pixels_where(5, 4, [](int x, int y) {
    return (x == 1 && y >= 1 && y < 3) || x == 2 || (x == 4 && y == 3);
  });
  const Mask mask = make_mask(pixels, 4);
  EXPECT_EQ(mask.runs, (std::vector<std::uint32_t>{5, 2, 1, 4, 7, 1}));
  EXPECT_EQ(mask.area, 7);
  EXPECT_EQ((std::array{mask.left, mask.top, mask.width, mask.height}), (std::array{1, 0, 4, 4}));
  // By pycocotools 2.0.11.
  EXPECT_EQ(coco_counts(mask, 20), "52126M");
}

TEST(Mask, LongRunsAreWrittenAsPycocotoolsDoes) {
  const auto pixels = pixels_where(640, 480, [](int x, int y) {
    return (x >= 50 && x < 60 && y >= 100 && y < 400) || (x == 300 && y == 10) || x == 639;
  });
  EXPECT_EQ(coco_counts(make_mask(pixels, 480), 640 * 480),
            R"(Tag0\9d500000000000000000V]`3eFkY^1o>)");
}

TEST(Outline, GoesAlongTheEdgesOfPixels) {
  const auto pixels = pixels_where(6, 5, [](int x, int y) { return x >= 2 && x < 5 && y == 3; });
  const std::vector<Eigen::Vector2i> expected = {{2, 3}, {5, 3}, {5, 4}, {2, 4}};
  EXPECT_EQ(outline_of(make_mask(pixels, 5), 5), expected);
}

TEST(Outline, JoinsPiecesByALineThereAndBack) {
  const auto pixels = pixels_where(6, 5, [](int x, int y) { return y == 1 && (x == 1 || x == 4); });
  const std::vector<Eigen::Vector2i> expected = {{1, 1}, {2, 1}, {4, 1}, {5, 1}, {5, 2},
                                                 {4, 2}, {4, 1}, {2, 1}, {2, 2}, {1, 2}};
  EXPECT_EQ(outline_of(make_mask(pixels, 5), 5), expected);
}

/// Whether a place is inside of a polygon by the even-odd rule.
bool is_inside(const std::vector<Eigen::Vector2i>& polygon, double x, double y) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i].cast<double>(),
                          b = polygon[(i + 1) % polygon.size()].cast<double>();
    if ((a.y() > y) == (b.y() > y)) continue;
    if (x < a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

/// Masks of noise have pieces, holes, and pixels that touch by their corners alone.
TEST(Outline, HoldsExactlyThePixelsOfAnyMask) {
  constexpr int kWidth = 17, kHeight = 13;
  RandomStream random(1, "outline", "masks");
  for (int mask = 0; mask < 200; ++mask) {
    const double share = 0.05 + 0.9 * random.uniform();
    const auto pixels =
        pixels_where(kWidth, kHeight, [&](int, int) { return random.uniform() < share; });
    if (pixels.empty()) continue;
    const auto polygon = outline_of(make_mask(pixels, kHeight), kHeight);
    const auto inside = pixels_where(
        kWidth, kHeight, [&](int x, int y) { return is_inside(polygon, x + 0.5, y + 0.5); });
    ASSERT_EQ(inside, pixels) << mask;
    // Holes go round the other way: the area by Gauss is that of the pixels.
    int twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2i &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      twice += a.x() * b.y() - a.y() * b.x();
    }
    ASSERT_EQ(twice, 2 * static_cast<int>(pixels.size())) << mask;
  }
}

/// 3 settings of 10 seeds.
scenario::Study study_of_thirty() {
  scenario::Study study;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) study.seeds.push_back(seed);
  scenario::Factor factor;
  factor.name = "season";
  factor.columns = {"season"};
  factor.levels.resize(3, {{}, {""}});
  study.factors = {factor};
  return study;
}

TEST(Splits, GroupsStayTogether) {
  const scenario::Study study = study_of_thirty();
  const study::Design design(study);
  scenario::DatasetConfig config;
  config.validation_share = 0.2;
  config.test_share = 0.1;
  for (const auto by : {scenario::SplitBy::kCell, scenario::SplitBy::kSeed}) {
    config.split_by = by;
    const std::vector<Split> parts = make_splits(design, config);
    ASSERT_EQ(parts.size(), 30u);
    EXPECT_EQ(std::count(parts.begin(), parts.end(), Split::kValidation), 6);
    EXPECT_EQ(std::count(parts.begin(), parts.end(), Split::kTest), 3);
    if (by == scenario::SplitBy::kCell) continue;
    for (std::size_t cell = 0; cell < 30; ++cell) EXPECT_EQ(parts[cell], parts[cell % 10]);
  }
  config.split_by = scenario::SplitBy::kSetting;
  const std::vector<Split> parts = make_splits(design, config);
  for (std::size_t cell = 0; cell < 30; ++cell) EXPECT_EQ(parts[cell], parts[cell / 10 * 10]);
  // Three settings: one for each part.
  EXPECT_EQ(std::set<Split>(parts.begin(), parts.end()).size(), 3u);
}

TEST(Splits, PlantsAreInOnePartUnlessTheStudySaysOtherwise) {
  const scenario::Study study = study_of_thirty();
  const std::vector<Split> parts = make_splits(study::Design(study), {});
  for (std::size_t cell = 0; cell < 30; ++cell) EXPECT_EQ(parts[cell], parts[cell % 10]);
  EXPECT_EQ(std::count(parts.begin(), parts.end(), Split::kValidation), 6);
}

TEST(Splits, EachPartKeepsOneGroup) {
  scenario::Study study = study_of_thirty();
  study.factors.clear();
  study.seeds = {4, 5, 6};
  scenario::DatasetConfig config;
  for (const auto& [validation, test] :
       {std::pair{0.9, 0.05}, {0.05, 0.9}, {0.45, 0.45}, {0.01, 0.01}}) {
    config.validation_share = validation;
    config.test_share = test;
    const std::vector<Split> parts = make_splits(study::Design(study), config);
    EXPECT_EQ(std::set<Split>(parts.begin(), parts.end()).size(), 3u) << validation << " " << test;
  }
  study.seeds = {4};
  config.validation_share = config.test_share = 0.0;
  EXPECT_EQ(make_splits(study::Design(study), config), std::vector<Split>{Split::kTrain});
}

TEST(Splits, TooFewGroupsAreRefused) {
  scenario::Study study = study_of_thirty();
  study.factors.clear();
  study.seeds = {4, 5};
  study.dataset_mark = {"study.yaml", 7};
  scenario::DatasetConfig config;
  config.split_by = scenario::SplitBy::kSeed;
  config.test_share = 0.1;
  try {
    make_splits(study::Design(study), config);
    FAIL() << "two seeds for three parts";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "study.yaml:7: dataset.validation_share = 0.2 and test_share = 0.1 need at least "
                 "3 seeds, but the study has 2; add some, choose another split_by, or set a share "
                 "to 0");
  }
}

/// 40 x 30 pixels, 20 px per unit, at the origin looking along +x.
class Scene {
 public:
  Scene() : lens_(info()), shapes_(world()) {
    layers_.width = 40;
    layers_.height = 30;
    layers_.thing.assign(1200, 0);
    layers_.depth_mm.assign(1200, 0);
  }

  static CameraPath at_rest() {
    CameraPath camera;
    camera.motion.X_WS.p = Vector3d(0, 0, 1);
    return camera;
  }

  /// Marks pixels as those of a thing at a depth.
  void paint(std::uint32_t thing, int left, int right, int top, int bottom, int mm) {
    for (int y = top; y < bottom; ++y) {
      for (int x = left; x < right; ++x) {
        layers_.thing[static_cast<std::size_t>(40 * y + x)] = thing;
        layers_.depth_mm[static_cast<std::size_t>(40 * y + x)] = static_cast<std::uint16_t>(mm);
      }
    }
  }

  std::vector<Annotation> annotated(std::vector<std::string> classes, int min_pixels = 1,
                                    std::vector<VehicleShape> vehicles = {},
                                    const CameraPath& camera = at_rest()) {
    return annotate(layers_, lens_, camera, shapes_, vehicles, classes, min_pixels);
  }
  /// @param labels  of each pixel
  PanopticPicture panoptic(const std::vector<std::uint8_t>& labels,
                           const std::vector<std::string>& classes, int min_pixels) {
    return make_panoptic(layers_, labels, shapes_, annotated(classes, min_pixels), classes);
  }
  const Layers& layers() const { return layers_; }
  const Lens& lens() const { return lens_; }

 private:
  static CameraInfo info() {
    CameraInfo info;
    info.width = 40;
    info.height = 30;
    info.fx_px = info.fy_px = 20.0;
    info.cx_px = 19.5;
    info.cy_px = 14.5;
    return info;
  }

  /// Two posts 4 m ahead, 0.4 m wide and 2 m high, from the ground at z = 0: number 2 at y = 1,
  /// number 3 at y = -4.1, half outside.
  static const WorldModel& world() {
    static const WorldModel posts_world = [] {
      auto mesh = std::make_shared<TriangleMesh>();
      for (const float y : {1.0f, -4.1f}) {
        const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
        mesh->things.push_back(static_cast<std::uint32_t>(mesh->triangles.size()));
        for (const auto& [side, z] :
             {std::pair{0.2f, 0.f}, {-0.2f, 0.f}, {-0.2f, 2.f}, {0.2f, 2.f}}) {
          mesh->vertices.emplace_back(4.0f, y + side, z);
        }
        mesh->triangles.push_back({first, first + 1, first + 2});
        mesh->triangles.push_back({first, first + 2, first + 3});
      }
      WorldModel model;
      MeshInstance posts;
      posts.name = "posts";
      posts.mesh = mesh;
      posts.surface = SurfaceClass::kPost;
      model.meshes.push_back(posts);
      return model;
    }();
    return posts_world;
  }

  Lens lens_;
  ThingShapes shapes_;
  Layers layers_;
};

// At 4 m a metre has 5 px: the first post is from 19.5 - 6 to 19.5 - 4 px, from 9.5 to 19.5 px.

TEST(Annotate, BoxesEndsAndSharesOfAPost) {
  Scene scene;
  scene.paint(2, 14, 16, 10, 20, 4000);
  const std::vector<Annotation> found = scene.annotated({"trunk", "post"});
  ASSERT_EQ(found.size(), 1u);
  const Annotation& post = found[0];
  EXPECT_EQ(post.thing, 2u);
  EXPECT_EQ(post.class_index, 1);
  EXPECT_EQ((std::array{post.mask.left, post.mask.top, post.mask.width, post.mask.height}),
            (std::array{14, 10, 2, 10}));
  EXPECT_DOUBLE_EQ(post.truncated, 0.0);
  EXPECT_DOUBLE_EQ(post.visible_share, 1.0);
  ASSERT_TRUE(post.ends);
  EXPECT_NEAR((*post.ends)[0].u, 14.5, 1e-6);
  EXPECT_NEAR((*post.ends)[0].v, 19.5, 1e-6);
  EXPECT_NEAR((*post.ends)[1].v, 9.5, 1e-6);
  EXPECT_EQ((*post.ends)[0].seen, Seen::kSeen);
  // The optical frame: y down from the camera's height of 1 m.
  EXPECT_LT((post.box.bottom_C - Vector3d(-1, 1, 4)).norm(), 1e-6);
  EXPECT_NEAR(post.box.height_m, 2.0, 1e-6);
  EXPECT_NEAR(post.box.length_m, 0.4, 1e-6);
  EXPECT_NEAR(post.box.width_m, 0.0, 1e-6);
}

// Rows are read from the first to the last in 0.2 s: row v at (v / 29 - 1/2) 0.2 s after the stamp.

TEST(Annotate, PointsAreWhereTheirRowIsExposed) {
  Scene scene;
  scene.paint(2, 0, 40, 0, 30, 4000);
  CameraPath camera = Scene::at_rest();
  camera.readout_s = 0.2;
  // To the left, past the post: its place to the side changes with the time, its rows do not.
  camera.motion.v_W = {0, 3, 0};
  const auto ends = *scene.annotated({"post"}, 1, {}, camera).at(0).ends;
  for (const auto& [end, v_px] : {std::pair{0, 19.5}, {1, 9.5}}) {
    const double later_s = (v_px / 29.0 - 0.5) * 0.2;
    EXPECT_NEAR(ends[static_cast<std::size_t>(end)].v, v_px, 1e-6);
    EXPECT_NEAR(ends[static_cast<std::size_t>(end)].u, 14.5 + 5.0 * 3.0 * later_s, 1e-6);
  }
  // Up: v = 14.5 + 5 (1 + 2 t - z) with t = (v / 29 - 1/2) 0.2, for the foot z = 0, the head z = 2.
  camera.motion.v_W = {0, 0, 2};
  const auto lifted = *scene.annotated({"post"}, 1, {}, camera).at(0).ends;
  const double of_row = 5.0 * 2.0 * 0.2 / 29.0;
  EXPECT_NEAR(lifted[0].v, (19.5 - 5.0 * 2.0 * 0.1) / (1.0 - of_row), 1e-5);
  EXPECT_NEAR(lifted[1].v, (9.5 - 5.0 * 2.0 * 0.1) / (1.0 - of_row), 1e-5);
  EXPECT_NEAR(lifted[0].u, 14.5, 1e-6);
  // The box is that of the stamp.
  EXPECT_LT((scene.annotated({"post"}, 1, {}, camera)[0].box.bottom_C - Vector3d(-1, 1, 4)).norm(),
            1e-6);
}

TEST(Annotate, PointsOfATurningCameraAreWhereTheirRowIsExposed) {
  Scene scene;
  scene.paint(2, 0, 40, 0, 30, 4000);
  CameraPath camera = Scene::at_rest();
  camera.readout_s = 0.2;
  camera.motion.w_WS_S = {0, 0, 0.8};  // to the left
  const auto ends = *scene.annotated({"post"}, 1, {}, camera).at(0).ends;
  // The post is at the azimuth atan(1 / 4); of what the camera sees it loses what has been turned.
  // Its range along the axis is then sqrt(17) cos(angle), and with it its row.
  for (const auto& [end, down_m] : {std::pair{0, 1.0}, {1, -1.0}}) {
    double v_px = 14.5, u_px = 0.0;
    for (int k = 0; k < 100; ++k) {
      const double angle = std::atan(0.25) - 0.8 * (v_px / 29.0 - 0.5) * 0.2;
      u_px = 19.5 - 20.0 * std::tan(angle);
      v_px = 14.5 + 20.0 * down_m / (std::sqrt(17.0) * std::cos(angle));
    }
    EXPECT_NEAR(ends[static_cast<std::size_t>(end)].u, u_px, 1e-5);
    EXPECT_NEAR(ends[static_cast<std::size_t>(end)].v, v_px, 1e-5);
  }
}

TEST(Annotate, WhatCarriesTheCameraKeepsItsPlaceBeforeIt) {
  Scene scene;
  scene.paint(4, 18, 22, 12, 18, 5000);  // where the vehicle is at the stamp
  VehicleShape shape;
  for (const double y : {-0.5, 0.5}) {
    for (const double z : {0.5, 1.5}) shape.vertices_W.emplace_back(5.0, y, z);
  }
  CameraPath camera = Scene::at_rest();
  camera.readout_s = 0.2;
  camera.motion.v_W = {0, 60, 0};  // 4 px a row
  shape.carries_camera = true;
  EXPECT_EQ(scene.annotated({"vehicle"}, 1, {shape}, camera).at(0).visible_share, 1.0);
  shape.carries_camera = false;
  EXPECT_LT(scene.annotated({"vehicle"}, 1, {shape}, camera).at(0).visible_share, 1.0);
}

TEST(Annotate, WhatHidesAThingTakesItsVertices) {
  Scene scene;
  scene.paint(2, 14, 16, 10, 20, 4000);
  scene.paint(1, 10, 20, 14, 25, 2000);  // the ground, in front of the lower half
  const std::vector<Annotation> found = scene.annotated({"post"});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_DOUBLE_EQ(found[0].visible_share, 0.5);
  EXPECT_EQ((*found[0].ends)[0].seen, Seen::kHidden);
  EXPECT_EQ((*found[0].ends)[1].seen, Seen::kSeen);
}

TEST(Annotate, AThingAtTheEdgeIsTruncated) {
  Scene scene;
  scene.paint(3, 38, 40, 10, 20, 4000);  // from 39 to 41 px
  const std::vector<Annotation> found = scene.annotated({"post"});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_DOUBLE_EQ(found[0].truncated, 0.5);
  EXPECT_DOUBLE_EQ(found[0].visible_share, 1.0);
  // Its middle line is at 40 px; the picture ends at 39.5.
  EXPECT_EQ((*found[0].ends)[0].seen, Seen::kOutside);
}

TEST(Annotate, SmallThingsAndOtherClassesAreLeftOut) {
  Scene scene;
  scene.paint(2, 14, 16, 10, 20, 4000);
  EXPECT_EQ(scene.annotated({"post"}, 20).size(), 1u);
  EXPECT_TRUE(scene.annotated({"post"}, 21).empty());
  EXPECT_TRUE(scene.annotated({"bunch"}).empty());
}

TEST(Annotate, VehiclesAreTurnedAsKittiTurnsThem) {
  Scene scene;
  scene.paint(4, 18, 22, 12, 18, 5000);  // the first number beyond the two posts
  VehicleShape shape;
  for (const double x : {4.0, 6.0}) {
    for (const double y : {-0.5, 0.5}) {
      for (const double z : {0.0, 1.0}) shape.vertices_W.emplace_back(x, y, z);
    }
  }
  const auto box = [&](const Vector3d& forward_W) {
    shape.forward_W = forward_W;
    return scene.annotated({"vehicle"}, 1, {shape}).at(0).box;
  };
  // Towards the camera; to the picture's right.
  EXPECT_NEAR(box({-1, 0, 0}).turn_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(box({-1, 0, 0}).length_m, 2.0, 1e-12);
  EXPECT_NEAR(box({0, -1, 0}).turn_rad, 0.0, 1e-12);
  EXPECT_NEAR(box({0, -1, 0}).length_m, 1.0, 1e-12);
  EXPECT_NEAR(box({0, -1, 0}).width_m, 2.0, 1e-12);
  EXPECT_LT((box({-1, 0, 0}).bottom_C - Vector3d(0, 1, 5)).norm(), 1e-12);
}

TEST(Panoptic, SmallThingsOfAClassBelongToNoSegment) {
  // Sky over ground; a post of 20 pixels, and one of 4.
  Scene scene;
  scene.paint(2, 14, 16, 10, 20, 4000);
  scene.paint(3, 38, 40, 10, 12, 4000);
  std::vector<std::uint8_t> labels(1200, static_cast<std::uint8_t>(Label::kSky));
  std::fill(labels.begin() + 40 * 20, labels.end(), static_cast<std::uint8_t>(Label::kGround));
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (scene.layers().thing[i] > 1) labels[i] = static_cast<std::uint8_t>(Label::kPost);
  }
  const auto id_at = [](const PanopticPicture& picture, int x, int y) {
    const std::uint8_t* rgb = &picture.ids.data[static_cast<std::size_t>(3 * (40 * y + x))];
    return rgb[0] + 256u * rgb[1] + 65536u * rgb[2];
  };
  const auto facts = [](const Segment& s) {
    return std::array<int, 8>{static_cast<int>(s.id),
                              s.category,
                              static_cast<int>(s.thing),
                              s.area,
                              s.left,
                              s.top,
                              s.width,
                              s.height};
  };
  // Things are category 1, then come the 12 labels.
  const PanopticPicture things = scene.panoptic(labels, {"post"}, 5);
  ASSERT_EQ(things.segments.size(), 3u);
  EXPECT_EQ(facts(things.segments[0]), (std::array{1, 2, 0, 776, 0, 0, 40, 20}));
  EXPECT_EQ(facts(things.segments[1]), (std::array{2, 3, 0, 400, 0, 20, 40, 10}));
  EXPECT_EQ(facts(things.segments[2]), (std::array{3, 1, 2, 20, 14, 10, 2, 10}));
  EXPECT_EQ(id_at(things, 15, 19), 3u);
  EXPECT_EQ(id_at(things, 15, 20), 2u);
  EXPECT_EQ(id_at(things, 39, 11), 0u);
  // Both are stuff if posts are no class.
  const PanopticPicture stuff = scene.panoptic(labels, {"bunch"}, 5);
  ASSERT_EQ(stuff.segments.size(), 3u);
  EXPECT_EQ(facts(stuff.segments[2]), (std::array{3, 8, 0, 24, 14, 10, 26, 10}));
  EXPECT_EQ(id_at(stuff, 15, 19), 3u);
  EXPECT_EQ(id_at(stuff, 39, 11), 3u);
}

TEST(Annotate, EndsOfRowsAreHiddenByWhatIsNearer) {
  Scene scene;
  PlantRow row;
  row.id = 7;
  row.line_W = {{-5, 1, 0}, {8, 1, 0}};  // begins behind the camera
  row.canopy_top_m = 1.0;
  const auto rows = [&] {
    return annotate_rows(scene.layers(), scene.lens(), Scene::at_rest(), {row});
  };
  ASSERT_EQ(rows().size(), 1u);
  const RowAnnotation open = rows()[0];
  EXPECT_EQ(open.row, 7);
  EXPECT_EQ(open.ends[0].seen, Seen::kOutside);
  EXPECT_EQ(open.ends[1].seen, Seen::kSeen);
  // 8 m ahead: 2.5 px to the metre.
  EXPECT_NEAR(open.ends[1].u, 17.0, 1e-9);
  EXPECT_NEAR(open.ends[1].v, 17.0, 1e-9);
  // From where the ground leaves the picture below to the horizon, which is the canopy's top here
  // and leaves it on the left.
  EXPECT_NEAR(open.top, 15.0, 1e-9);
  EXPECT_NEAR(open.top + open.height, 30.0, 1e-6);
  EXPECT_NEAR(open.left, 0.0, 1e-6);
  EXPECT_NEAR(open.left + open.width, 17.5, 1e-9);
  scene.paint(2, 0, 40, 0, 30, 3000);
  EXPECT_EQ(rows()[0].ends[1].seen, Seen::kHidden);
  scene.paint(1, 0, 40, 0, 30, 7950);
  EXPECT_EQ(rows()[0].ends[1].seen, Seen::kSeen);
  row.line_W[1] = {-1, 1, 0};
  EXPECT_TRUE(rows().empty());
}

}  // namespace
}  // namespace vinerow::dataset::dataset_parts_test
