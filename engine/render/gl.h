#pragma once
/// OpenGL 3.3 core functions, loaded at run time, so that no GL library is linked.

#include <GL/glcorearb.h>

#include <functional>
#include <string>

namespace vinerow::render {

// clang-format off
#define VINEROW_GL_FUNCTIONS(X) \
  X(ACTIVETEXTURE, ActiveTexture) X(ATTACHSHADER, AttachShader) X(BINDBUFFER, BindBuffer) \
  X(BINDBUFFERBASE, BindBufferBase) X(BINDFRAMEBUFFER, BindFramebuffer) \
  X(BINDRENDERBUFFER, BindRenderbuffer) X(BINDTEXTURE, BindTexture) \
  X(BINDVERTEXARRAY, BindVertexArray) X(BLENDFUNC, BlendFunc) \
  X(BLITFRAMEBUFFER, BlitFramebuffer) X(BUFFERDATA, BufferData) X(BUFFERSUBDATA, BufferSubData) \
  X(CHECKFRAMEBUFFERSTATUS, CheckFramebufferStatus) X(CLEAR, Clear) X(CLEARCOLOR, ClearColor) \
  X(COLORMASK, ColorMask) X(COMPILESHADER, CompileShader) X(CREATEPROGRAM, CreateProgram) \
  X(CREATESHADER, CreateShader) X(CULLFACE, CullFace) X(DELETEBUFFERS, DeleteBuffers) \
  X(DELETEFRAMEBUFFERS, DeleteFramebuffers) X(DELETERENDERBUFFERS, DeleteRenderbuffers) \
  X(DELETESHADER, DeleteShader) X(DELETETEXTURES, DeleteTextures) X(DEPTHFUNC, DepthFunc) X(DEPTHMASK, DepthMask) \
  X(DISABLE, Disable) X(DRAWARRAYS, DrawArrays) X(DRAWBUFFER, DrawBuffer) \
  X(DRAWBUFFERS, DrawBuffers) \
  X(DRAWELEMENTS, DrawElements) X(ENABLE, Enable) \
  X(ENABLEVERTEXATTRIBARRAY, EnableVertexAttribArray) \
  X(FRAMEBUFFERRENDERBUFFER, FramebufferRenderbuffer) \
  X(FRAMEBUFFERTEXTURE2D, FramebufferTexture2D) \
  X(FRAMEBUFFERTEXTURELAYER, FramebufferTextureLayer) X(FRONTFACE, FrontFace) \
  X(GENBUFFERS, GenBuffers) X(GENFRAMEBUFFERS, GenFramebuffers) \
  X(GENRENDERBUFFERS, GenRenderbuffers) X(GENTEXTURES, GenTextures) \
  X(GENVERTEXARRAYS, GenVertexArrays) X(GETERROR, GetError) \
  X(GETPROGRAMINFOLOG, GetProgramInfoLog) X(GETPROGRAMIV, GetProgramiv) \
  X(GETSHADERINFOLOG, GetShaderInfoLog) X(GETSHADERIV, GetShaderiv) \
  X(GETUNIFORMBLOCKINDEX, GetUniformBlockIndex) X(GETUNIFORMLOCATION, GetUniformLocation) \
  X(LINKPROGRAM, LinkProgram) X(PIXELSTOREI, PixelStorei) X(POLYGONOFFSET, PolygonOffset) \
  X(READBUFFER, ReadBuffer) X(READPIXELS, ReadPixels) \
  X(RENDERBUFFERSTORAGEMULTISAMPLE, RenderbufferStorageMultisample) X(SHADERSOURCE, ShaderSource) \
  X(STENCILFUNC, StencilFunc) X(STENCILOP, StencilOp) X(TEXIMAGE2D, TexImage2D) \
  X(TEXIMAGE3D, TexImage3D) X(TEXPARAMETERI, TexParameteri) X(TEXSUBIMAGE3D, TexSubImage3D) \
  X(UNIFORM1F, Uniform1f) X(UNIFORM1I, Uniform1i) X(UNIFORM4F, Uniform4f) \
  X(UNIFORMBLOCKBINDING, UniformBlockBinding) X(UNIFORMMATRIX4FV, UniformMatrix4fv) \
  X(USEPROGRAM, UseProgram) X(VERTEXATTRIB4F, VertexAttrib4f) \
  X(VERTEXATTRIBPOINTER, VertexAttribPointer) X(VIEWPORT, Viewport)
// clang-format on

/// Functions of one context; `gl.Clear(...)` is glClear.
struct Gl {
#define VINEROW_GL_MEMBER(UPPER, name) PFNGL##UPPER##PROC name = nullptr;
  VINEROW_GL_FUNCTIONS(VINEROW_GL_MEMBER)
#undef VINEROW_GL_MEMBER
};

using GlLookup = std::function<void*(const char* name)>;

/// @throws std::runtime_error naming the first missing function
Gl load_gl(const GlLookup& lookup);

/// Compiles and links a program; binds the uniform block "FrameBlock" to 0 and each sampler of
/// kSamplerUnits to its unit. @throws std::runtime_error with the compiler's text
GLuint build_program(const Gl& gl, const std::string& name, const std::string& vertex_source,
                     const std::string& fragment_source);

/// @throws std::runtime_error "OpenGL error 0x502 while <doing>"
void check_gl(const Gl& gl, const std::string& doing);

}  // namespace vinerow::render
