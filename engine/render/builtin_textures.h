#pragma once
/// Procedural textures, generated once per process without inputs.

#include "engine/imaging/pixels.h"

namespace vinerow::render {

/// Layers of the card texture: leaf cards of vines, then of trees. Channels: R brightness (0.5 =
/// leaf's own green), G and B tilt of the leaf surface against the card (0.5 = none), A coverage.
enum LeafLayer : int {
  kLeafSingle = 0,  ///< 2 layers: one leaf
  kLeafSpray = 2,   ///< 3 layers: a dozen leaves
  kLeafClump = 5,   ///< 3 layers: about sixty
  kLeafLayersPerKind = 8,
};
constexpr int kGrassLayer = 2 * kLeafLayersPerKind;  ///< 4 layers: tufts, root at v = 0
constexpr int kGrassLayers = 4;
constexpr int kCardLayers = kGrassLayer + kGrassLayers;

/// Square pictures of equal size, each painted at the first call. Thread safe.
/// @param layer  in [0, kCardLayers)
const imaging::Pixels& card_texture(int layer);

/// Ground tile seen from above. R grass brightness, G grass dryness, B soil brightness, A height
/// (of clods and blades).
const imaging::Pixels& ground_texture();

/// Four smooth noises, tileable. R and G: value noise of 4 and 8 cells; B: soft clouds; A:
/// blotches.
const imaging::Pixels& noise_texture();

/// Wood with grain along v. RGB colour.
const imaging::Pixels& wood_texture();
const imaging::Pixels& bark_texture();

}  // namespace vinerow::render
