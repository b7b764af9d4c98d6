#include "worlds/plants/vine_stage.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "worlds/plants/stage_table.h"

namespace vinerow::worlds {
namespace {

using Point = StagePoint;

/// Leaves that are unfolded: 11 to 19 by definition. Coombe (Aust. J. Grape Wine Res. 1, 1995, 104)
/// puts 53 at Eichhorn and Lorenz's stage 15, whose shoots have eight leaves; 57 at twelve to
/// sixteen. 53 has nine here, since 19 comes before it.
constexpr std::array<Point, 12> kLeaves = {{{11, 1},
                                            {12, 2},
                                            {13, 3},
                                            {14, 4},
                                            {15, 5},
                                            {16, 6},
                                            {17, 7},
                                            {18, 8},
                                            {19, 9},
                                            {53, 9},
                                            {55, 10},
                                            {57, 13}}};

/// Degree days above 10 C since bud burst, chosen within what is published: flowering 313 (STICS,
/// Grenache) to 500 (Ventoux), fruit set 363 to 600, veraison 1014 (Burgundy) to 1400, ripe 1250
/// (Burgundy) to 1800, 1500 to 1600 for late varieties in Chile (Villaseca et al.).
constexpr std::array<Point, 9> kThermalTime = {{{60, 330},
                                                {65, 365},
                                                {69, 420},
                                                {71, 460},
                                                {75, 620},
                                                {79, 870},
                                                {81, 1050},
                                                {89, 1550},
                                                {91, 1650}}};

/// Diameters of 2, 4, 7 mm at fruit set, groat and pea size (Coombe's modified E-L stages) and 11
/// mm when berries touch, for ripe berries of 14 mm; flower buds are smaller.
constexpr std::array<Point, 8> kBerryDiameter = {
    {{53, 0.06}, {60, 0.13}, {71, 0.16}, {73, 0.29}, {75, 0.5}, {79, 0.79}, {81, 0.8}, {89, 1.0}}};
constexpr std::array<Point, 5> kBunchLength = {
    {{53, 0.2}, {57, 0.6}, {61, 0.85}, {71, 0.95}, {79, 1.0}}};
// By the names of the stages: 83 colouring, 85 softening; 92 discolouration begins, 93 leaf fall
// begins, 95 half of the leaves have fallen, 97 all.
constexpr std::array<Point, 3> kRipe = {{{80.5, 0.0}, {83, 0.5}, {85.5, 1.0}}};
constexpr std::array<Point, 4> kDiscoloured = {{{91, 0.0}, {92, 0.1}, {93, 0.5}, {95, 1.0}}};
constexpr std::array<Point, 4> kFallen = {{{92.5, 0.0}, {93, 0.05}, {95, 0.5}, {97, 1.0}}};

constexpr double kLastLeafStage = 19.0, kFirstFlowerStage = 53.0;

double thermal_time_Cd(const VineVariety& variety, double bbch) {
  if (bbch < 9.0) return -1.0;
  const double first_Cd = leaf_time_Cd(variety, 1.0);
  if (bbch < 11.0) return first_Cd * (bbch - 9.0) / 2.0;
  if (bbch <= 57.0) return leaf_time_Cd(variety, interpolate(kLeaves, bbch));
  const double from_Cd = leaf_time_Cd(variety, kLeaves.back().value);
  // One leaf at least unfolds from 57 to 60: varieties whose leaves come slowly are late.
  const double next_Cd = leaf_time_Cd(variety, kLeaves.back().value + 1.0);
  const double late_Cd = std::max(0.0, next_Cd - kThermalTime.front().value);
  if (bbch >= 60.0) return interpolate(kThermalTime, bbch) + late_Cd;
  return from_Cd + (kThermalTime.front().value + late_Cd - from_Cd) * (bbch - 57.0) / 3.0;
}

}  // namespace

const char* find_fault_in_bbch(double bbch) {
  if (!(bbch >= 0.0 && bbch <= 99.0)) return "must be from 0 to 99";
  if (bbch > kLastLeafStage && bbch < kFirstFlowerStage) {
    return "grapevines have no stages between 19 (nine leaves) and 53 (inflorescences)";
  }
  return "";
}

VineStage vine_stage(const VineVariety& variety, double bbch) {
  VineStage stage;
  stage.bbch = bbch;
  stage.thermal_time_Cd = thermal_time_Cd(variety, bbch);
  stage.bunch_length = interpolate(kBunchLength, bbch);
  stage.berry_diameter = interpolate(kBerryDiameter, bbch);
  stage.ripe_share = interpolate(kRipe, bbch);
  stage.discoloured_share = interpolate(kDiscoloured, bbch);
  stage.fallen_share = interpolate(kFallen, bbch);
  stage.has_bunches = bbch >= 53.0 && bbch < 90.0;
  stage.are_shoots_brown = bbch >= 89.0;
  stage.is_pruned = bbch < 10.0;
  return stage;
}

}  // namespace vinerow::worlds
