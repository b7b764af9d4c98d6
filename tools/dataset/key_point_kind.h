#pragma once
/// What has key points, in the order of all formats.

#include <string>

namespace vinerow::dataset {

enum class KeyPointKind { kTrunk, kPost, kRow };
inline constexpr const char* kKeyPointKindNames[] = {"trunk", "post", "row"};

/// Of a thing with foot and head. @param name  of its class
inline KeyPointKind kind_of(const std::string& name) {
  return name == "trunk" ? KeyPointKind::kTrunk : KeyPointKind::kPost;
}

}  // namespace vinerow::dataset
