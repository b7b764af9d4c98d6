#pragma once
/// Kinds of products that phases of a mission pass to each other, and the keys of a job's inputs.

#include <string>

namespace vinerow {

enum class ProductKind { kPictures, kCloud, kMap, kPlan };

/// "pictures", "cloud", "map", "plan": spelling in files.
const char* to_string(ProductKind kind);

/// An input product of a job, by its key.
struct ProductPort {
  std::string key;  ///< "cloud" in `cloud: from build_cloud`
  ProductKind kind = ProductKind::kMap;
  bool required = true;
  std::string description;
};

}  // namespace vinerow
