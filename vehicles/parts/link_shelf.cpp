#include "vehicles/parts/link_shelf.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <variant>

#include "engine/api/registry.h"

namespace vinerow::vehicles {
namespace {

/// All values, with their names.
void append_values(const ParameterSet& parameters, std::string& out) {
  for (const ParameterSpec& spec : parameters.specs()) {
    const ParameterSet::Value* value = parameters.find(spec.name);
    if (!value) continue;
    out += fmt::format("{}=", spec.name);
    std::visit(
        [&out]<class T>(const T& v) {
          if constexpr (std::is_same_v<T, std::vector<ParameterSet>>) {
            for (const ParameterSet& group : v) {
              out += '{';
              append_values(group, out);
              out += '}';
            }
          } else if constexpr (std::is_same_v<T, std::string>) {
            out += fmt::format("{}:{}", v.size(), v);
          } else {
            out += fmt::format("{}", v);
          }
        },
        *value);
    out += ';';
  }
}

}  // namespace

LinkShelf::LinkShelf(const ParameterSet& parameters, const VehicleContext& context)
    : shelf_(context.shelf), key_(parameters.owner() + " ") {
  if (shelf_) append_values(parameters, key_);
}

}  // namespace vinerow::vehicles
