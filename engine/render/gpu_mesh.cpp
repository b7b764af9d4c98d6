#include "engine/render/gpu_mesh.h"

#include <cstddef>

namespace vinerow::render {

namespace {

const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

}  // namespace

GpuMesh make_gpu_mesh(const Gl& gl) {
  GpuMesh mesh;
  gl.GenVertexArrays(1, &mesh.vertex_array);
  gl.GenBuffers(1, &mesh.vertex_buffer);
  gl.GenBuffers(1, &mesh.index_buffer);
  gl.BindVertexArray(mesh.vertex_array);
  gl.BindBuffer(GL_ARRAY_BUFFER, mesh.vertex_buffer);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.index_buffer);
  const auto attribute = [&](GLuint place, GLint size, GLenum type, GLboolean unit,
                             std::size_t at) {
    gl.EnableVertexAttribArray(place);
    gl.VertexAttribPointer(place, size, type, unit, sizeof(GpuVertex), offset(at));
  };
  attribute(0, 3, GL_FLOAT, GL_FALSE, offsetof(GpuVertex, position));
  attribute(1, 4, GL_BYTE, GL_TRUE, offsetof(GpuVertex, normal));
  attribute(2, 2, GL_FLOAT, GL_FALSE, offsetof(GpuVertex, uv));
  attribute(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(GpuVertex, colour));
  gl.BindVertexArray(0);
  return mesh;
}

void fill_vertices(const Gl& gl, const GpuMesh& mesh, const std::vector<GpuVertex>& vertices,
                   GLenum usage) {
  gl.BindBuffer(GL_ARRAY_BUFFER, mesh.vertex_buffer);
  gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(GpuVertex)),
                vertices.data(), usage);
}

void fill_indices(const Gl& gl, GpuMesh& mesh, const std::vector<std::uint32_t>& indices,
                  GLenum usage) {
  gl.BindVertexArray(mesh.vertex_array);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.index_buffer);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * 4),
                indices.data(), usage);
  gl.BindVertexArray(0);
  mesh.index_count = static_cast<GLsizei>(indices.size());
}

GpuMesh upload_mesh(const Gl& gl, const PreparedMesh& prepared) {
  GpuMesh mesh = make_gpu_mesh(gl);
  fill_vertices(gl, mesh, prepared.vertices, GL_STATIC_DRAW);
  fill_indices(gl, mesh, prepared.indices, GL_STATIC_DRAW);
  mesh.closed = prepared.closed;
  mesh.bounds_M = prepared.bounds_M;
  return mesh;
}

GLuint upload_texture(const Gl& gl, const std::vector<imaging::Pixels>& levels, bool clamp) {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    gl.TexImage2D(GL_TEXTURE_2D, static_cast<GLint>(i), GL_RGBA8, levels[i].width, levels[i].height,
                  0, GL_RGBA, GL_UNSIGNED_BYTE, levels[i].rgba.data());
  }
  const GLint wrap = clamp ? GL_CLAMP_TO_EDGE : GL_REPEAT;
  const bool mipmapped = levels.size() > 1;
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
                   mipmapped ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, static_cast<GLint>(levels.size()) - 1);
  return texture;
}

GLuint upload_texture_array(const Gl& gl, const std::vector<std::vector<imaging::Pixels>>& layers) {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, texture);
  const auto count = static_cast<GLsizei>(layers.size());
  for (std::size_t level = 0; level < layers[0].size(); ++level) {
    const imaging::Pixels& first = layers[0][level];
    gl.TexImage3D(GL_TEXTURE_2D_ARRAY, static_cast<GLint>(level), GL_RGBA8, first.width,
                  first.height, count, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    for (GLsizei i = 0; i < count; ++i) {
      gl.TexSubImage3D(GL_TEXTURE_2D_ARRAY, static_cast<GLint>(level), 0, 0, i, first.width,
                       first.height, 1, GL_RGBA, GL_UNSIGNED_BYTE, layers[i][level].rgba.data());
    }
  }
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL,
                   static_cast<GLint>(layers[0].size()) - 1);
  return texture;
}

}  // namespace vinerow::render
