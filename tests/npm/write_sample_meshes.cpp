// write_sample_meshes FOLDER: row meshes as binary glTF for another reader. meshes.glb: three
// prisms of 8 corners with 5, 6 and 7 sections; large.glb: one with 9000, which needs long indices.
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "engine/io/meshes/mesh_scene_writer.h"

namespace {

vinerow::TriangleMesh make_prism(std::uint32_t sections, float y_m) {
  vinerow::TriangleMesh mesh;
  constexpr std::uint32_t kRing = 8;
  for (std::uint32_t j = 0; j < sections; ++j) {
    for (std::uint32_t k = 0; k < kRing; ++k) {
      const float angle = 0.785398f * static_cast<float>(k);
      mesh.vertices.emplace_back(0.2f * static_cast<float>(j), y_m + 0.3f * std::cos(angle),
                                 1.3f + 0.7f * std::sin(angle));
    }
  }
  for (std::uint32_t first = 0; first + kRing < sections * kRing; first += kRing) {
    for (std::uint32_t k = 0; k < kRing; ++k) {
      const std::uint32_t a = first + k, b = first + (k + 1) % kRing;
      mesh.triangles.push_back({a, b, b + kRing});
      mesh.triangles.push_back({a, b + kRing, a + kRing});
    }
  }
  return mesh;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace vinerow;
  if (argc != 2) return std::fprintf(stderr, "usage: write_sample_meshes FOLDER\n"), 2;
  const std::filesystem::path folder = argv[1];
  const TriangleMesh a = make_prism(5, 0.0f), b = make_prism(6, 2.5f), c = make_prism(7, 5.0f);
  const TriangleMesh large = make_prism(9000, 0.0f);
  using io::NamedMesh;
  const std::vector<NamedMesh> rows{
      {"row_00_hull_00", &a}, {"row_01_hull_00", &b}, {"row_01_hull_01", &c}};
  io::write_glb(rows, folder / "meshes.glb", io::canopy_material());
  io::write_glb(std::vector<NamedMesh>{{"row_02_hull_00", &large}}, folder / "large.glb",
                io::canopy_material());
}
