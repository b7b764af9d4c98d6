#pragma once
/// Files of a replay that the build embeds in the program. Lists are in loading order.

#include <vector>

#include "tools/replay/embedded_file.h"

namespace vinerow::tools {

/// three.js and the examples of it that a picture uses; empty if the build did not find them.
std::vector<EmbeddedFile> three_scripts();
/// Its licence.
std::string_view three_notice();

std::string_view replay_style();
std::string_view replay_markup();
/// Scripts of the picture: scene, camera, its controls. A live run has them too.
std::vector<EmbeddedFile> picture_scripts();
/// Scripts of a recorded run's time, after those of the picture.
std::vector<EmbeddedFile> player_scripts();

}  // namespace vinerow::tools
