// SPDX-License-Identifier: MIT
// OpenGL ES rasteriser: shaders, textures, framebuffers and draw calls.
#include "peers/rasterize_gl.hpp"

#include "support/error.hpp"

#ifdef CLPV_BENCH_GL

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl32.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>

namespace clpv::bench {
namespace {

// y points down, as clpv stores rows from the top.
constexpr const char* kVertexShader = R"(#version 320 es
uniform vec3 eye, right, up, forward;
uniform vec2 half_size;
uniform float near_depth, far_depth;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 colour;
out highp vec3 surface_normal;
out highp vec2 surface_uv;
out highp vec4 surface_colour;
out highp float surface_depth;
void main() {
  vec3 p = position - eye;
  float depth = dot(p, forward);
  vec2 across = vec2(dot(p, right), -dot(p, up)) / half_size;
#ifdef ORTHOGRAPHIC
  gl_Position = vec4(across, 2.0 * depth / far_depth - 1.0, 1.0);
#else
  gl_Position = vec4(across, depth - 2.0 * near_depth, depth);
#endif
  surface_normal = normal;
  surface_uv = uv;
  surface_colour = colour;
  surface_depth = depth;
})";

constexpr const char* kFragmentShader = R"(#version 320 es
precision highp float;
uniform sampler2D base_texture;
uniform vec4 base_colour;
uniform float cutoff;
uniform vec3 light;
uniform float footprint;
in vec3 surface_normal;
in vec2 surface_uv;
in vec4 surface_colour;
in float surface_depth;
#ifdef SURFACE
layout(location = 0) out float depth;
layout(location = 1) out vec4 normal;
layout(location = 2) out vec4 colour;
#endif
void main() {
#ifdef SURFACE
  vec4 albedo = base_colour * surface_colour * texture(base_texture, surface_uv);
  if (albedo.a < cutoff) discard;
  vec3 n = normalize(surface_normal);
  depth = surface_depth;
  normal = vec4(gl_FrontFacing ? n : -n, 0.0);
#ifdef FROM_LIGHT
  colour = vec4(albedo.rgb * light * footprint, 0.0);  // flux of directional light
#else
  colour = vec4(albedo.rgb, 1.0);
#endif
#else
  if (cutoff > 0.0 && (base_colour.a * surface_colour.a * texture(base_texture, surface_uv).a) < cutoff) discard;
#endif
})";

[[noreturn]] void fail(const char* call) {
  throw Error(ExitCode::run_time, "OpenGL ES: {} failed (EGL 0x{:x}, GL 0x{:x})", call,
              eglGetError(), glGetError());
}

EGLDisplay open_display() {
  const auto get = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      eglGetProcAddress("eglGetPlatformDisplayEXT"));
  const EGLDisplay display = get == nullptr
                                 ? EGL_NO_DISPLAY
                                 : get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  EGLint major = 0, minor = 0;
  if (display == EGL_NO_DISPLAY || eglInitialize(display, &major, &minor) == EGL_FALSE)
    return EGL_NO_DISPLAY;
  return display;
}

/// The process's EGL display, shared by the contexts of all passes and never closed.
EGLDisplay display() {
  static const EGLDisplay opened = open_display();
  return opened;
}

GLenum wrapped(std::uint32_t wrap) {
  return wrap == CLPV_WRAP_CLAMP    ? GL_CLAMP_TO_EDGE
         : wrap == CLPV_WRAP_MIRROR ? GL_MIRRORED_REPEAT
                                    : GL_REPEAT;
}

GLuint make_texture(const Texture& texture) {
  GLuint name = 0;
  glGenTextures(1, &name);
  glBindTexture(GL_TEXTURE_2D, name);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, static_cast<GLsizei>(texture.width),
               static_cast<GLsizei>(texture.height), 0, GL_RGBA, GL_UNSIGNED_BYTE,
               texture.rgba.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, static_cast<GLint>(wrapped(texture.wrap_u)));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, static_cast<GLint>(wrapped(texture.wrap_v)));
  return name;
}

GLuint make_shader(GLenum kind, const std::string& text) {
  const GLuint shader = glCreateShader(kind);
  const char* source = text.c_str();
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  std::array<char, 1024> log{};
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  throw Error(ExitCode::run_time, "OpenGL ES: shader does not compile: {}", log.data());
}

std::string with_defines(std::string text, const std::vector<std::string>& names) {
  const std::size_t first_line = text.find('\n') + 1;
  for (const std::string& name : names) text.insert(first_line, "#define " + name + "\n");
  return text;
}

GLuint make_program(Pass pass, bool orthographic) {
  std::vector<std::string> defines;
  if (orthographic) defines.emplace_back("ORTHOGRAPHIC");
  if (pass != Pass::rasterize_shadow) defines.emplace_back("SURFACE");
  if (pass == Pass::rasterize_rsm) defines.emplace_back("FROM_LIGHT");
  const GLuint program = glCreateProgram();
  glAttachShader(program, make_shader(GL_VERTEX_SHADER, with_defines(kVertexShader, defines)));
  glAttachShader(program, make_shader(GL_FRAGMENT_SHADER, with_defines(kFragmentShader, defines)));
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked != GL_TRUE) fail("linking shaders");
  return program;
}

GLuint make_target(GLenum format, const ClpvView& view) {
  GLuint name = 0;
  glGenTextures(1, &name);
  glBindTexture(GL_TEXTURE_2D, name);
  glTexStorage2D(GL_TEXTURE_2D, 1, format, static_cast<GLsizei>(view.width),
                 static_cast<GLsizei>(view.height));
  return name;
}

/// Makes a framebuffer for a view: a depth attachment and, apart from shadow maps, depth, normal
/// and colour.
GLuint make_framebuffer(Pass pass, const ClpvView& view) {
  GLuint frame = 0;
  glGenFramebuffers(1, &frame);
  glBindFramebuffer(GL_FRAMEBUFFER, frame);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D,
                         make_target(GL_DEPTH_COMPONENT32F, view), 0);
  if (pass != Pass::rasterize_shadow) {
    const std::array<GLenum, 3> formats = {GL_R32F, GL_RGBA32F, GL_RGBA32F};
    const std::array<GLenum, 3> buffers = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
                                           GL_COLOR_ATTACHMENT2};
    for (std::size_t i = 0; i < formats.size(); ++i)
      glFramebufferTexture2D(GL_FRAMEBUFFER, buffers[i], GL_TEXTURE_2D,
                             make_target(formats[i], view), 0);
    glDrawBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
  }
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    fail("creating a framebuffer");
  return frame;
}

}  // namespace

struct GlRasterizer::Impl {
  struct Batch {  ///< consecutive triangles of one material
    ClpvMaterial material;
    GLuint texture;
    GLsizei count;
    std::size_t first;  ///< position in the index buffer
  };

  Pass pass;
  std::vector<ClpvView> views;
  ClpvLight light;
  EGLContext context = EGL_NO_CONTEXT;
  std::vector<GLuint> framebuffers;
  GLuint program = 0;
  std::vector<Batch> batches;

  Impl(const SceneData& scene, Pass drawn_pass, std::vector<ClpvView> drawn_views,
       const ClpvLight& lit_by)
      : pass(drawn_pass), views(std::move(drawn_views)), light(lit_by) {
    open();
    upload(scene);
    program = make_program(pass, views.front().orthographic != 0);
    for (const ClpvView& view : views) framebuffers.push_back(make_framebuffer(pass, view));
    glEnable(GL_DEPTH_TEST);
    glFrontFace(GL_CW);  // y points down
    glClearDepthf(1.0f);
    if (glGetError() != GL_NO_ERROR) fail("setup");
  }
  ~Impl() {
    eglMakeCurrent(display(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display(), context);  // with all its objects
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void make_current() const {
    if (eglMakeCurrent(display(), EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE)
      fail("making a context current");
  }

  void open() {
    eglBindAPI(EGL_OPENGL_ES_API);
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 2,
                                 EGL_NONE};
    context = eglCreateContext(display(), EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT) fail("creating a context of OpenGL ES 3.2");
    make_current();
  }

  void upload(const SceneData& scene) {
    std::array<GLuint, 2> buffers{};
    glGenBuffers(2, buffers.data());
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(scene.vertices.size() * sizeof(Vertex)),
                 scene.vertices.data(), GL_STATIC_DRAW);
    const auto attribute = [](GLuint location, GLint components, std::size_t offset) {
      glEnableVertexAttribArray(location);
      glVertexAttribPointer(
          location, components, GL_FLOAT, GL_FALSE, sizeof(Vertex),
          reinterpret_cast<const void*>(offset));  // NOLINT: OpenGL passes offsets as pointers
    };
    attribute(0, 3, offsetof(Vertex, position));
    attribute(1, 3, offsetof(Vertex, normal));
    attribute(2, 2, offsetof(Vertex, uv));
    attribute(3, 4, offsetof(Vertex, colour));
    std::vector<GLuint> indices;
    make_batches(scene, indices);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(GLuint)),
                 indices.data(), GL_STATIC_DRAW);
  }

  void make_batches(const SceneData& scene, std::vector<GLuint>& indices) {
    std::vector<GLuint> textures;
    for (const Texture& texture : scene.textures) textures.push_back(make_texture(texture));
    Texture white;
    white.width = white.height = 1;
    white.rgba.assign(4, 255);
    textures.push_back(make_texture(white));
    std::map<unsigned, std::vector<GLuint>> material_corners;
    for (const Triangle& triangle : scene.triangles) {
      std::vector<GLuint>& corners = material_corners[triangle.material];
      corners.insert(corners.end(), triangle.vertex, triangle.vertex + 3);
    }
    for (const auto& [number, corners] : material_corners) {
      const ClpvMaterial& material = scene.materials[number];
      const std::size_t texture =
          material.texture == CLPV_NO_TEXTURE ? textures.size() - 1 : std::size_t{material.texture};
      batches.push_back(
          {material, textures[texture], static_cast<GLsizei>(corners.size()), indices.size()});
      indices.insert(indices.end(), corners.begin(), corners.end());
    }
  }

  GLint uniform(const char* name) const { return glGetUniformLocation(program, name); }

  void set_view(const ClpvView& view) const {
    glUniform3fv(uniform("eye"), 1, view.eye);
    glUniform3fv(uniform("right"), 1, view.right);
    glUniform3fv(uniform("up"), 1, view.up);
    glUniform3fv(uniform("forward"), 1, view.forward);
    glUniform2f(uniform("half_size"), view.half_width, view.half_height);
    glUniform1f(uniform("near_depth"), view.near_depth);
    glUniform1f(uniform("far_depth"), view.far_depth);
    glUniform3fv(uniform("light"), 1, light.intensity);
    const float pixels = static_cast<float>(view.width) * static_cast<float>(view.height);
    glUniform1f(uniform("footprint"), 4 * view.half_width * view.half_height / pixels);
  }

  void draw_batches() const {
    const GLint colour = uniform("base_colour"), cutoff = uniform("cutoff");
    const bool cull = pass == Pass::rasterize_camera;
    for (const Batch& batch : batches) {
      const bool masked = (batch.material.flags & CLPV_MATERIAL_MASKED) != 0;
      const bool both = !cull || (batch.material.flags & CLPV_MATERIAL_DOUBLE_SIDED) != 0;
      (both ? glDisable : glEnable)(GL_CULL_FACE);
      glUniform4fv(colour, 1, batch.material.base_colour);
      glUniform1f(cutoff, masked ? batch.material.alpha_cutoff : 0.0f);
      glBindTexture(GL_TEXTURE_2D, batch.texture);
      glDrawElements(
          GL_TRIANGLES, batch.count, GL_UNSIGNED_INT,
          reinterpret_cast<const void*>(
              batch.first * sizeof(GLuint)));  // NOLINT: OpenGL passes offsets as pointers
    }
  }

  void draw() const {
    make_current();
    glUseProgram(program);
    for (std::size_t v = 0; v < views.size(); ++v) {
      glBindFramebuffer(GL_FRAMEBUFFER, framebuffers[v]);
      glViewport(0, 0, static_cast<GLsizei>(views[v].width), static_cast<GLsizei>(views[v].height));
      glClear(GL_DEPTH_BUFFER_BIT | GL_COLOR_BUFFER_BIT);
      set_view(views[v]);
      draw_batches();
    }
    glFinish();
    if (glGetError() != GL_NO_ERROR) fail("drawing");
  }

  std::vector<float> depth_of(std::size_t v) const {
    const ClpvView& view = views[v];
    const std::size_t pixels = std::size_t{view.width} * view.height;
    std::vector<float> depth(pixels), read(4 * pixels);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffers[v]);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, static_cast<GLsizei>(view.width), static_cast<GLsizei>(view.height), GL_RGBA,
                 GL_FLOAT, read.data());
    for (std::size_t i = 0; i < pixels; ++i) depth[i] = read[4 * i];
    return depth;
  }
};

std::string gl_missing() {
  return display() == EGL_NO_DISPLAY
             ? "no OpenGL ES without a window: EGL lacks the surfaceless platform that Mesa has"
             : "";
}

GlRasterizer::GlRasterizer(const SceneData& scene, Pass pass, std::vector<ClpvView> views,
                           const ClpvLight& light) {
  if (const std::string missing = gl_missing(); !missing.empty())
    throw Error(ExitCode::device, "{}", missing);
  impl_ = std::make_unique<Impl>(scene, pass, std::move(views), light);
}
GlRasterizer::~GlRasterizer() = default;

void GlRasterizer::draw() {
  impl_->draw();
}

std::vector<std::vector<float>> GlRasterizer::depths() {
  std::vector<std::vector<float>> depths;
  if (impl_->pass == Pass::rasterize_shadow) return depths;
  impl_->make_current();
  for (std::size_t v = 0; v < impl_->views.size(); ++v) depths.push_back(impl_->depth_of(v));
  return depths;
}

}  // namespace clpv::bench

#else  // built without EGL and OpenGL ES

namespace clpv::bench {

struct GlRasterizer::Impl {};

std::string gl_missing() {
  return "built without EGL and OpenGL ES (CLPV_BENCH_GL; Debian: libegl-dev libgles-dev "
         "libgl1-mesa-dri)";
}

GlRasterizer::GlRasterizer(const SceneData&, Pass, std::vector<ClpvView>, const ClpvLight&) {
  throw Error(ExitCode::device, "{}", gl_missing());
}
GlRasterizer::~GlRasterizer() = default;
void GlRasterizer::draw() {}
std::vector<std::vector<float>> GlRasterizer::depths() {
  return {};
}

}  // namespace clpv::bench

#endif
