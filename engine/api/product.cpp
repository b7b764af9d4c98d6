#include "engine/api/product.h"

namespace vinerow {

const char* to_string(ProductKind kind) {
  switch (kind) {
    case ProductKind::kPictures:
      return "pictures";
    case ProductKind::kCloud:
      return "cloud";
    case ProductKind::kMap:
      return "map";
    case ProductKind::kPlan:
      return "plan";
  }
  return "?";
}

}  // namespace vinerow
