#pragma once
/// Surroundings of a world for pictures alone: neighbouring fields, tracks, trees. They do not
/// collide, and rays, maps, metrics and logs do not contain them.

#include <Eigen/Core>
#include <vector>

namespace vinerow {

/// A field between tracks: vines in straight rows, or none (meadow, stubble).
struct SceneryField {
  std::vector<Eigen::Vector2d> corners_W;              ///< convex, counter-clockwise
  std::vector<Eigen::Vector2d> planted_W;              ///< likewise, inside: area with rows
  Eigen::Vector2d along_W = Eigen::Vector2d::UnitX();  ///< unit, direction of rows or furrows
  double pitch_m = 0.0;                                ///< between rows; 0: no rows
  double row_width_m = 0.55;
  double row_base_m = 0.55;  ///< lowest leaves above the ground
  double row_top_m = 2.0;
  double dryness = 0.5;  ///< of its grass: 0 lush, 1 dry
  double tilled = 0.0;   ///< 0: grass between the rows, 0.5: in every other alley, 1: bare alleys
  double stubble = 0.0;  ///< 0 meadow, 1 stubble
  double brightness = 1.0;  ///< of leaves or grass
};

struct SceneryTrack {
  Eigen::Vector2d from_W = {0, 0};
  Eigen::Vector2d to_W = {0, 0};
};

struct SceneryTree {
  Eigen::Vector2d p_W = {0, 0};
  int kind = 0;  ///< of kSceneryTrees
};

/// Sizes of trees: m.
struct SceneryTreeSize {
  double height_m;
  double crown_width_m;
};
constexpr SceneryTreeSize kSceneryTrees[] = {{6.5, 6.0}, {8.5, 7.5}, {9.0, 3.2}, {3.0, 3.4}};
constexpr int kSceneryTreeKinds = 4;

struct Scenery {
  std::vector<SceneryField> fields;  ///< at most 250
  std::vector<SceneryTrack> tracks;
  std::vector<SceneryTree> trees;
  bool empty() const { return fields.empty() && tracks.empty() && trees.empty(); }
};

}  // namespace vinerow
