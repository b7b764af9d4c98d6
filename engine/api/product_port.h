#pragma once
/// Kinds of what phases of a mission hand to each other, and the keys by which jobs take them.

#include <string>

namespace vinerow {

enum class ProductKind { kPictures, kCloud, kMap, kPlan };

/// "pictures", "cloud", "map", "plan": how files spell it.
const char* to_string(ProductKind kind);

/// A product that a job takes, by the key that names it.
struct ProductPort {
  std::string key;  ///< "cloud" in `cloud: from build_cloud`
  ProductKind kind = ProductKind::kMap;
  bool required = true;
  std::string description;
};

}  // namespace vinerow
