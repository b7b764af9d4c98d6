#pragma once
/// Vertex and index buffers on the GPU, valid as long as the context.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "engine/imaging/pixels.h"
#include "engine/render/gl.h"
#include "engine/render/mesh_preparation.h"

namespace vinerow::render {

struct GpuMesh {
  GLuint vertex_array = 0;
  GLuint vertex_buffer = 0;
  GLuint index_buffer = 0;
  GLsizei index_count = 0;
  bool closed = false;
  Eigen::AlignedBox3d bounds_M;
};

/// Attributes 0 position, 1 normal, 2 uv, 3 colour as in GpuVertex; buffers may be filled later.
GpuMesh make_gpu_mesh(const Gl& gl);
void fill_vertices(const Gl& gl, const GpuMesh& mesh, const std::vector<GpuVertex>& vertices,
                   GLenum usage);
void fill_indices(const Gl& gl, GpuMesh& mesh, const std::vector<std::uint32_t>& indices,
                  GLenum usage);
GpuMesh upload_mesh(const Gl& gl, const PreparedMesh& prepared);

/// Uploads a mipmapped texture and binds it to the active unit. It repeats unless `clamp`.
GLuint upload_texture(const Gl& gl, const std::vector<imaging::Pixels>& levels, bool clamp);
/// Uploads layers of equal size, each with a full mipmap chain.
GLuint upload_texture_array(const Gl& gl, const std::vector<std::vector<imaging::Pixels>>& layers);

}  // namespace vinerow::render
