#pragma once
/// glTF scene of the world and the vehicles' links. The extras of a node give its role:
///   ground   "part": "terrain" | "surroundings"
///   world    "part": "world", "surface": "canopy" | "post" | ..., and for levels of detail
///            "group" (the same for all levels of a thing) and "level" (0: nearest; the finest may
///            be left out)
///   leaves   additionally "cards": "leaf" | "spray" | "clump", the picture that suits their size
///   vehicles "part": "link", "vehicle": index, "link": index; their poses are in the tracks

#include <string>
#include <vector>

#include "tools/replay/replay.h"

namespace vinerow::tools {

struct ReplayScene {
  std::string glb;
  std::vector<std::string> notes;  ///< one sentence for each simplification of the world
};

/// @pre world, vehicles and trace are not null
ReplayScene make_replay_scene(const ReplayInput& input, const ReplayLimits& limits);

}  // namespace vinerow::tools
