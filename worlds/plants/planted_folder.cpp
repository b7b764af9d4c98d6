#include "worlds/plants/planted_folder.h"

#include "engine/api/height_field.h"
#include "engine/api/parameter_table.h"

namespace vinerow::worlds {
namespace {

/// Raised when the same parameters give other meshes, so that older files are not read.
constexpr int kGeneratorVersion = 10;

template <class T>
void add_list(Hasher& hasher, const std::vector<T>& list) {
  hasher.add(static_cast<std::uint64_t>(list.size()));
  hasher.add_bytes(list.data(), list.size() * sizeof(T));
}

}  // namespace

std::filesystem::path planted_folder(const std::filesystem::path& parent, const std::string& kind,
                                     const ParameterSet& parameters,
                                     const std::vector<VineRow>& rows, const HeightField& terrain) {
  Hasher hasher;
  hasher.add(kGeneratorVersion);
  add_parameters(hasher, parameters, planting_table().specs());
  for (const VineRow& row : rows) {
    add_list(hasher, row.curve.points_W());
    add_list(hasher, row.vine_s_m);
    add_list(hasher, row.post_s_m);
    hasher.add(row.vine_spacing_m);
  }
  add_list(hasher, terrain.heights_m);
  hasher.add(terrain.columns);
  hasher.add(terrain.cell_m);
  hasher.add(terrain.corner_W.x());
  hasher.add(terrain.corner_W.y());
  return (parent.empty() ? find_cache_folder() : parent) /
         (kind + "-" + hasher.hex().substr(0, 16));
}

}  // namespace vinerow::worlds
