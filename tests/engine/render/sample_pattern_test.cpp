#include "engine/render/sample_pattern.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <vector>

#include "engine/api/world_model.h"
#include "engine/render/cameras.h"
#include "engine/render/shaders.h"
#include "tests/engine/render/test_scenes.h"

namespace vinerow::render {
namespace {

/// Index of the drawn pixel in whose middle a place of the picture lies; -1: in no middle.
/// @param x,y  pixels from the upper left corner
std::ptrdiff_t drawn_at(const SamplePattern& pattern, double x, double y) {
  const Eigen::Vector4d clip(2.0 * x / pattern.width() - 1.0, 1.0 - 2.0 * y / pattern.height(), 0,
                             1);
  const Eigen::Vector4d drawn = pattern.drawn_from_clip() * clip;
  const double column = 0.5 * (drawn.x() + 1.0) * pattern.columns() - 0.5;
  const double row = 0.5 * (drawn.y() + 1.0) * pattern.rows() - 0.5;
  if (std::abs(column - std::round(column)) > 1e-6 || std::abs(row - std::round(row)) > 1e-6) {
    return -1;
  }
  return std::lround(row) * pattern.columns() + std::lround(column);
}

std::ptrdiff_t tap_of(const SamplePattern& pattern, int x, int y, std::size_t tap) {
  return static_cast<std::ptrdiff_t>(pattern.first_of(x, y)) + pattern.taps()[tap].offset;
}

TEST(SamplePattern, StaggeredPixelsAreTheirMiddlesAndCorners) {
  for (const auto& [width, height] : {std::pair{7, 5}, std::pair{4, 9}, std::pair{1, 1}}) {
    const SamplePattern pattern(width, height, 2);
    ASSERT_EQ(pattern.taps().size(), 5u);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        EXPECT_EQ(tap_of(pattern, x, y, 0), drawn_at(pattern, x + 0.5, y + 0.5));
        EXPECT_EQ(tap_of(pattern, x, y, 1), drawn_at(pattern, x, y + 1));
        EXPECT_EQ(tap_of(pattern, x, y, 2), drawn_at(pattern, x + 1, y + 1));
        EXPECT_EQ(tap_of(pattern, x, y, 3), drawn_at(pattern, x, y));
        EXPECT_EQ(tap_of(pattern, x, y, 4), drawn_at(pattern, x + 1, y));
      }
    }
    EXPECT_EQ(pattern.taps()[0].weight * 2, pattern.weight_sum());
    EXPECT_DOUBLE_EQ(pattern.spacing_px(), std::hypot(0.5, 0.5));
  }
}

TEST(SamplePattern, SquarePatternsDivideThePixel) {
  for (const int scale : {1, 2, 3}) {
    const SamplePattern pattern(6, 4, scale * scale);
    ASSERT_EQ(pattern.weight_sum(), scale * scale);
    for (std::size_t tap = 0; tap < pattern.taps().size(); ++tap) {
      const double right = (static_cast<double>(tap % scale) + 0.5) / scale;
      const double up = (static_cast<double>(tap / scale) + 0.5) / scale;
      EXPECT_EQ(tap_of(pattern, 3, 1, tap), drawn_at(pattern, 3 + right, 2 - up));
    }
  }
}

TEST(SamplePattern, UsedColumnsHoldEverySampleAndLittleElse) {
  for (const int samples : {1, 2, 4}) {
    for (const auto& [width, height] : {std::pair{70, 51}, std::pair{40, 90}, std::pair{1, 1}}) {
      const SamplePattern pattern(width, height, samples);
      std::vector<bool> is_used(static_cast<std::size_t>(pattern.columns()) * pattern.rows());
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          for (std::size_t tap = 0; tap < pattern.taps().size(); ++tap) {
            is_used[static_cast<std::size_t>(tap_of(pattern, x, y, tap))] = true;
          }
        }
      }
      for (const int rows : {1, 2, 7}) {
        for (int row = 0; row + rows <= pattern.rows(); ++row) {
          const SamplePattern::Columns columns = pattern.used_columns(row, rows);
          int first = pattern.columns(), last = 0;
          for (int k = 0; k < rows * pattern.columns(); ++k) {
            if (!is_used[static_cast<std::size_t>(row * pattern.columns() + k)]) continue;
            first = std::min(first, k % pattern.columns());
            last = std::max(last, k % pattern.columns());
          }
          EXPECT_LE(columns.begin, first);
          EXPECT_GE(columns.begin, first - 1);
          EXPECT_GT(columns.end, last);
          EXPECT_LE(columns.end, last + 2);
        }
      }
    }
  }
}

TEST(SamplePattern, LargestPicturesHaveFourSamplesInsteadOfTwo) {
  EXPECT_TRUE(SamplePattern(8191, 8191, 2).staggered());
  const SamplePattern largest(8192, 8192, 2);
  EXPECT_FALSE(largest.staggered());
  EXPECT_EQ(largest.weight_sum(), 4);
}

TEST(Shaders, RootsGiveTheGammaOfDisplays) {
  double largest = 0.0;
  for (int i = 0; i <= 100'000; ++i) {
    const double x = 1e-5 * i;
    const double sum = shaders::kGammaRoots[0] * std::sqrt(x) +
                       shaders::kGammaRoots[1] * std::pow(x, 0.25) +
                       shaders::kGammaRoots[2] * std::pow(x, 0.125);
    largest = std::max(largest, std::abs(sum - std::pow(x, 1.0 / 2.2)));
  }
  std::printf("gamma by roots: %.3f of 255 levels at most\n", 255.0 * largest);
  EXPECT_LT(255.0 * largest, 0.66);
}

double rms(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    sum += std::pow(double{1} * a.rgb[i] - b.rgb[i], 2);
  }
  return std::sqrt(sum / static_cast<double>(a.rgb.size()));
}

/// Errors of a picture of posts and boards at many angles, by its number of samples, against the
/// mean of 3 x 3 pixels of a picture three times as large that has 9 samples itself.
std::map<int, double> errors_of_boards(bool on_ground) {
  WorldModel world;
  if (on_ground) world.terrain = test::make_level_ground(30.0);
  for (int i = 0; i < 40; ++i) {
    world.meshes.push_back(test::make_instance(
        "post", test::make_box({0.02f + 0.002f * static_cast<float>(i), 0.03f, 0.6f}),
        {0.4 * i - 8.0, 3.0 * std::sin(0.7 * i), 0.5}, {0.8f, 0.8f, 0.7f}));
    world.meshes.back().X_WM.q =
        Eigen::AngleAxisd(0.2 * i, Eigen::Vector3d(0.3, 1, 0).normalized());
  }
  std::map<int, double> error;
  const auto renderer = test::renderer_of(world, {.grass_tufts = false, .distant_hills = false});
  if (!renderer) return error;
  Frame frame;
  frame.camera = look_at({-9, -9, 3}, {0, 0, 0.3});
  frame.width = 3 * 320;
  frame.height = 3 * 240;
  frame.samples = 9;
  const Image large = renderer->draw(frame);
  Image best{320, 240, std::vector<std::uint8_t>(320 * 240 * 3)};
  for (std::size_t y = 0; y < 240; ++y) {
    for (std::size_t i = 0; i < 320 * 3; ++i) {
      double sum = 0.0;
      for (std::size_t k = 0; k < 9; ++k) {
        const std::size_t row = 3 * y + k / 3, column = 3 * (i / 3) + k % 3;
        sum += std::pow(large.rgb[(row * 960 + column) * 3 + i % 3], 2);
      }
      best.rgb[y * 960 + i] = static_cast<std::uint8_t>(std::lround(std::sqrt(sum / 9.0)));
    }
  }
  frame.width = 320;
  frame.height = 240;
  for (const int samples : {1, 2, 4}) {
    frame.samples = samples;
    error[samples] = rms(renderer->draw(frame), best);
    std::printf("%s, %d samples: rms %.2f levels\n", on_ground ? "on the ground" : "in the air",
                samples, error[samples]);
  }
  return error;
}

TEST(SamplePattern, TwoStaggeredSamplesAreAlmostAsGoodAsFour) {
  // The ground, which has one sample a pixel, adds no more to the error than the pattern does.
  for (const bool on_ground : {false, true}) {
    std::map<int, double> error = errors_of_boards(on_ground);
    ASSERT_EQ(error.size(), 3u);
    EXPECT_LT(error[2], 1.4 * error[4]);
    EXPECT_LT(error[2], 0.6 * error[1]);
  }
}

/// Mean of a picture's red, green and blue.
Eigen::Array3d mean_of(const Image& image) {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (std::size_t i = 0; i < image.rgb.size(); ++i) sum[i % 3] += image.rgb[i];
  return 3.0 * sum / static_cast<double>(image.rgb.size());
}

TEST(SamplePattern, GroundInGapsBetweenPixelsMiddlesHasItsColour) {
  // A fence of black boards from above, a pixel apart and 0.8 pixels wide. Where a gap lies on the
  // pixels' corners no middle shows the ground beside it.
  WorldModel world;
  world.terrain = test::make_level_ground(30.0);
  constexpr double kPixel_m = 0.05;
  for (int i = -100; i <= 100; ++i) {
    world.meshes.push_back(test::make_instance(
        "board", test::make_box({0.4f * static_cast<float>(kPixel_m), 4.0f, 0.01f}),
        {kPixel_m * i + 0.5 * kPixel_m, 0.0, 0.3}, {0.0f, 0.0f, 0.0f}));
  }
  const auto renderer =
      test::renderer_of(world, {.shadows = false, .grass_tufts = false, .distant_hills = false});
  ASSERT_TRUE(renderer);
  Frame frame;
  frame.camera = look_at({0, 0, 10}, {0, 0.001, 0});
  frame.camera.orthographic = true;
  frame.width = 160;
  frame.height = 120;
  frame.camera.ortho_height_m = frame.height * kPixel_m;
  frame.samples = 2;
  const Eigen::Array3d seen = mean_of(renderer->draw(frame));
  frame.samples = 9;
  const Eigen::Array3d best = mean_of(renderer->draw(frame));
  std::printf("mean %.1f %.1f %.1f, with 9 samples %.1f %.1f %.1f\n", seen[0], seen[1], seen[2],
              best[0], best[1], best[2]);
  EXPECT_TRUE(((seen - best).abs() < 3.0).all());
}

}  // namespace
}  // namespace vinerow::render
