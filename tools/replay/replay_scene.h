#pragma once
/// The world and the vehicles' links as one glTF scene. Nodes tell in their extras what they are:
///   ground   "part": "terrain" | "surroundings"
///   world    "part": "world", "surface": "canopy" | "post" | ..., and of alternatives by distance
///            "group" (the same for all of one thing) and "level" (0: nearest; the finest may be
///            left out)
///   leaves   beside these "cards": "leaf" | "spray" | "clump", the picture that suits their size
///   vehicles "part": "link", "vehicle": index, "link": index; their poses come with the tracks

#include <string>
#include <vector>

#include "tools/replay/replay.h"

namespace vinerow::tools {

struct ReplayScene {
  std::string glb;
  std::vector<std::string> notes;  ///< what is coarser than in the world, a sentence each
};

/// @pre world, vehicles and trace are there
ReplayScene make_replay_scene(const ReplayInput& input, const ReplayLimits& limits);

}  // namespace vinerow::tools
