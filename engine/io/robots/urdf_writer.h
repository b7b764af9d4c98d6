#pragma once
/// Writer of URDF robots for viewers, which take the poses of the links from elsewhere.

#include <span>
#include <string>

#include "engine/math/pose.h"

namespace vinerow::io {

/// Link of a robot below its root link R.
struct DrawnLink {
  std::string name;
  Pose X_RL;
  std::string mesh_url;  ///< empty: not drawn
};

/// Text of a URDF in which every link has a joint of its own to the root. The joints are
/// "floating", because nothing is known of how a link moves; their origins are the links' poses.
/// There are no masses. Names are unique in URDF: of links with the same name the first counts, and
/// the mesh of one named as the root is drawn in the root.
std::string urdf_text(const std::string& robot, const std::string& root,
                      std::span<const DrawnLink> links);

}  // namespace vinerow::io
