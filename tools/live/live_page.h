#pragma once
/// Browser page of a live run: 3D picture, control, plots and driving.

#include <vector>

#include "engine/api/registry.h"
#include "engine/live/web_server.h"

namespace vinerow {
class Simulation;
}

namespace vinerow::tools {

/// Files of the page: "/" (HTML), its scripts and styles, and the run's world as "/index.json",
/// "/scene.glb" and "/textures.bin". The page connects to the WebSocket beside it. Everything is in
/// memory, a few megabytes; making it takes about a second. The same simulation gives the same
/// bytes. If the program was built without three.js, "/" is a page that gives the reason, and
/// nothing else.
/// @param simulation  built; its vehicles are drawn at their present poses until messages arrive
/// @param registry  that it was built with
std::vector<live::WebFile> live_page_files(const Simulation& simulation, const Registry& registry);

}  // namespace vinerow::tools
