#pragma once
/// Vine rows of a world: hulls, leaves, trunks, posts and wires, cut into chunks for display.
///
/// Names: "canopy_hull/row_03/run_0" (collides, not drawn), "canopy/row_03/chunk_07#lod0" to
/// "#lod2" (drawn, one of them by distance), "trunk/row_03/chunk_07#lod0" (collides) and "#lod1",
/// "post/row_03", "end_post/row_03", "wire/row_03"; of a pergola also "roof_wire/row_03" and
/// "roof_beam/row_03". Weeds: weeds.h.
///
/// Leaves are cards with the picture of a leaf, or organs of VineGrowth: then also
/// "shoots/row_03/chunk_07#lod0" and "bunches/...", each with its levels, and light meets the
/// organs instead of the hull. The hull has the extent of the leaves at that stage; without leaves
/// there is none.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/parameter_table_fwd.h"
#include "worlds/parts/canopy.h"
#include "worlds/parts/mesh_store.h"
#include "worlds/parts/trellis.h"
#include "worlds/plants/vine_organs.h"
#include "worlds/plants/weeds.h"

namespace vinerow::worlds {

/// Row to plant.
struct VineRow {
  mapping::RowCurve curve;
  std::vector<double> vine_s_m;  ///< ascending arc lengths of the stems; gaps are missing vines
  double vine_spacing_m;  ///< regular distance; neighbours farther apart than 1.6 times are a gap
  std::vector<double>
      post_s_m;  ///< ascending, first and last are end posts; empty: no posts, no wires
};

struct VinePlanting {
  std::optional<double> canopy_width_m;  ///< of `canopy`, set by settle_growth(); absent: default
  CanopyParams canopy;
  TrellisParams trellis;
  double leaf_cards_per_m = 260.0;  ///< near level
  double chunk_m = 7.2;  ///< approximate length of a chunk; less where growing vines bend
  int variants = 6;      ///< of chunks that are reused
  std::uint64_t seed = 1;
  std::optional<VineGrowth> growth;  ///< absent: cards of leaves
  std::optional<WeedParams> weeds;   ///< absent: a bare strip
  VineSpace space;                   ///< of growing vines; set by settle_growth()
  bool has_leaves = true;            ///< likewise
};

bool is_pergola(const VinePlanting& planting);

/// Given or default, before settle_growth().
double canopy_width_m(const VinePlanting& planting);

/// Roofs of pergolas must not overlap: fault of the width, before or after settle_growth(), or "".
/// @param pitch_m  smallest distance between two rows
/// @param pitch  what it is called in the sentence: "pitch_m"
std::string find_fault_in_pitch(const VinePlanting& planting, double pitch_m,
                                const std::string& pitch);
/// The same for rows that are given: the narrowest alley counts.
/// @throws ConfigError
void check_pitch(const VinePlanting& planting, const RowMap& rows);

/// Sets what the user has not given. With growing vines, the space for them is that of `canopy`,
/// which becomes the extent of their leaves: 0.1 m wide from arms to posts without leaves. Call it
/// before the rows are mapped.
VinePlanting settle_growth(VinePlanting planting);

/// `canopy_width_m`, canopy_table(), trellis_table(), `leaf_cards_per_m`, `plant_variants`,
/// `plant_seed`, `vines`, `weeds`.
const ParameterTable<VinePlanting>& planting_table();

/// Distance by which the map extends a row beyond its ends: half the canopy's width if end posts
/// lean outward, which is their reach at 1.4 m above ground with the usual 0.2 rad; else 0.
double row_end_margin_m(const VinePlanting& planting);

/// Regular stems: the first half a spacing inside the row.
/// @param missing_share  independent probability of each vine to be missing
std::vector<double> regular_vines(double length_m, double spacing_m, double missing_share,
                                  RandomStream random);

/// Appends the rows' meshes to the world.
void plant_vine_rows(WorldModel& world, const std::vector<VineRow>& rows,
                     const mapping::GroundHeight& ground, const VinePlanting& planting,
                     MeshStore& store);

}  // namespace vinerow::worlds
