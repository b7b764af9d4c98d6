#pragma once
/// Browser page of a live run: 3D picture, control, plots and driving.

#include <functional>
#include <vector>

#include "engine/api/registry.h"
#include "engine/live/web_server.h"

namespace vinerow {
class Simulation;
}

namespace vinerow::tools {

/// Makes the files of the page: "/" (HTML), its scripts and styles, and the run's world as
/// "/index.json", "/scene.glb" and "/textures.bin". The page connects to the WebSocket beside it.
/// Everything is in memory, a few megabytes; making it takes about a second. The same simulation
/// gives the same bytes. If the program was built without three.js, "/" is a page that gives the
/// reason, and nothing else.
/// @param simulation  built; its vehicles are drawn at their present poses until messages arrive
/// @param registry  that it was built with; outlives the function
/// @returns a function that holds what it needs of the simulation, which may go on in another
///   thread
std::function<std::vector<live::WebFile>()> live_page(const Simulation& simulation,
                                                      const Registry& registry);

}  // namespace vinerow::tools
