#include "engine/render/gl.h"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

#include "engine/render/texture_units.h"

namespace vinerow::render {

Gl load_gl(const GlLookup& lookup) {
  Gl gl;
  const auto find = [&](const char* name) {
    void* function = lookup(name);
    if (function == nullptr) {
      throw std::runtime_error(fmt::format("the OpenGL library has no function {}", name));
    }
    return function;
  };
#define VINEROW_GL_FIND(UPPER, name) \
  gl.name = reinterpret_cast<PFNGL##UPPER##PROC>(find("gl" #name));
  VINEROW_GL_FUNCTIONS(VINEROW_GL_FIND)
#undef VINEROW_GL_FIND
  return gl;
}

namespace {

GLuint compile(const Gl& gl, GLenum kind, const std::string& name, const std::string& source) {
  const GLuint shader = gl.CreateShader(kind);
  const char* text = source.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint ok = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (!ok) {
    std::vector<char> log(4096);
    gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error(fmt::format("shader '{}' does not compile: {}", name, log.data()));
  }
  return shader;
}

}  // namespace

GLuint build_program(const Gl& gl, const std::string& name, const std::string& vertex_source,
                     const std::string& fragment_source) {
  const GLuint program = gl.CreateProgram();
  const GLuint vertex = compile(gl, GL_VERTEX_SHADER, name + ".vert", vertex_source);
  const GLuint fragment = compile(gl, GL_FRAGMENT_SHADER, name + ".frag", fragment_source);
  gl.AttachShader(program, vertex);
  gl.AttachShader(program, fragment);
  gl.LinkProgram(program);
  GLint ok = 0;
  gl.GetProgramiv(program, GL_LINK_STATUS, &ok);
  if (!ok) {
    std::vector<char> log(4096);
    gl.GetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error(fmt::format("shader '{}' does not link: {}", name, log.data()));
  }
  gl.DeleteShader(vertex);
  gl.DeleteShader(fragment);
  gl.UseProgram(program);
  const GLuint block = gl.GetUniformBlockIndex(program, "FrameBlock");
  if (block != GL_INVALID_INDEX) gl.UniformBlockBinding(program, block, 0);
  for (const SamplerUnit& sampler : kSamplerUnits) {
    const GLint location = gl.GetUniformLocation(program, sampler.name);
    if (location >= 0) gl.Uniform1i(location, sampler.unit);
  }
  return program;
}

void check_gl(const Gl& gl, const std::string& doing) {
  const GLenum error = gl.GetError();
  if (error != GL_NO_ERROR) {
    throw std::runtime_error(fmt::format("OpenGL error 0x{:x} while {}", error, doing));
  }
}

}  // namespace vinerow::render
