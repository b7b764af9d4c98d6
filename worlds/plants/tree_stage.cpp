#include "worlds/plants/tree_stage.h"

#include <array>

#include "worlds/plants/stage_table.h"

namespace vinerow::worlds {
namespace {

using Point = StagePoint;

constexpr std::array<Point, 9> kAppleLeaves = {{{7, 0.0},
                                                {10, 0.02},
                                                {57, 0.06},
                                                {65, 0.10},
                                                {69, 0.23},
                                                {71, 0.5},
                                                {72, 0.8},
                                                {74, 0.9},
                                                {77, 1.0}}};
/// Chosen: each spring adds a third.
constexpr std::array<Point, 4> kOliveLeaves = {{{7, 0.75}, {19, 0.85}, {69, 0.95}, {75, 1.0}}};

// 92 leaves begin to discolour, 93 to fall, 95 half of them are discoloured, 97 all have fallen.
constexpr std::array<Point, 3> kAppleDiscoloured = {{{91.5, 0.0}, {95, 0.5}, {97, 1.0}}};
constexpr std::array<Point, 3> kAppleFallen = {{{92.5, 0.0}, {95, 0.3}, {97, 1.0}}};

// 60 first flowers, 65 at least half open and the first petals fall, 67 most have fallen, 69 all.
constexpr std::array<Point, 5> kOpenFlowers = {
    {{59, 0.0}, {61, 0.1}, {65, 1.0}, {67, 0.4}, {69, 0.0}}};

// Apples of 70 mm: 10 mm at 71, 20 mm at 72, then shares of the final size.
constexpr std::array<Point, 5> kAppleFruit = {
    {{69, 0.1}, {71, 0.14}, {72, 0.29}, {79, 0.9}, {87, 1.0}}};
// 71 a tenth of the final size, 75 half, 79 nine tenths.
constexpr std::array<Point, 4> kOliveFruit = {{{71, 0.1}, {75, 0.5}, {79, 0.9}, {85, 1.0}}};

constexpr std::array<Point, 2> kFruitRipe = {{{80, 0.0}, {89, 1.0}}};

}  // namespace

const char* find_fault_in_tree_bbch(double bbch) {
  if (!(bbch >= 0.0 && bbch <= 99.0)) return "must be from 0 to 99";
  if (bbch >= 20.0 && bbch < 51.0) {
    return "stages 20 to 50 run beside leaves and flowers: give 0 to 19 or 51 to 99";
  }
  return "";
}

TreeStage tree_stage(Crop crop, double bbch) {
  TreeStage stage;
  stage.ripe_share = interpolate(kFruitRipe, bbch);
  if (crop == Crop::kOlive) {
    stage.leaf_area = interpolate(kOliveLeaves, bbch);
    stage.fruit_diameter = interpolate(kOliveFruit, bbch);
    stage.has_fruit = bbch > 69.0 && bbch < 93.0;
    return stage;
  }
  stage.leaf_area = interpolate(kAppleLeaves, bbch);
  stage.discoloured_share = interpolate(kAppleDiscoloured, bbch);
  stage.fallen_share = interpolate(kAppleFallen, bbch);
  stage.open_flowers = interpolate(kOpenFlowers, bbch);
  stage.fruit_diameter = interpolate(kAppleFruit, bbch);
  stage.has_fruit = bbch > 69.0 && bbch < 91.0;
  return stage;
}

}  // namespace vinerow::worlds
