// gl_shaded MESH.tri FRAMES WxH [PICTURE.ppm]
//
// A mesh in colour through Mesa llvmpipe, for peers.py: the same camera as ../shared/peers/gl_raster.cpp, whose copy this
// is in all that concerns the context, and the lights of a framed mesh file (lab/src/scenes/studio.rs): three from far away,
// an ambient one, Lambert's cosine and a Blinn-Phong highlight in the fragment shader, sRGB bytes in the frame.
//
// A time is that of a frame from the clear to glFinish, with the mesh uploaded before. Normals are those of vertices,
// weighted by angle, as ours are but for creases: so triangles share vertices, which is cheaper for OpenGL.
// Prints "median MS best MS covered PIXELS". Run with LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=llvmpipe LP_NUM_THREADS=N.
#define GL_GLEXT_PROTOTYPES 1
#define EGL_EGLEXT_PROTOTYPES 1
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <GL/glext.h>

#include "common.h"

static void check(bool holds, const char* what) {
  if (holds) return;
  fprintf(stderr, "failed: %s (egl %x gl %x)\n", what, eglGetError(), glGetError());
  exit(1);
}

// Eye, axes and the scale of the viewport are those of the lecture; clip z is constant, so depth is reversed.
static const char* VERTEX = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform vec3 e, u, v, w;
uniform vec3 scale_and_near;
out vec3 from_eye, to_normal;
void main() {
  from_eye = position - e;
  to_normal = normal;
  gl_Position = vec4(scale_and_near.x * dot(u, from_eye), scale_and_near.y * dot(v, from_eye),
                     scale_and_near.z, -dot(w, from_eye));
})";

static const char* FRAGMENT = R"(#version 330 core
in vec3 from_eye, to_normal;
out vec4 color;
const int LIGHTS = 3;
uniform vec3 to_light[LIGHTS];
uniform float intensity[LIGHTS];
uniform float ambient, specular, shininess;
uniform vec3 diffuse_color;
void main() {
  vec3 to_viewer = normalize(-from_eye);
  vec3 normal = normalize(gl_FrontFacing ? to_normal : -to_normal);
  float diffuse = ambient, highlights = 0.0;
  for (int k = 0; k < LIGHTS; k++) {
    float cosine = dot(normal, to_light[k]);
    if (cosine > 0.0) {
      diffuse += intensity[k] * cosine;
      vec3 halfway = normalize(to_light[k] + to_viewer);
      highlights += intensity[k] * pow(max(dot(normal, halfway), 0.0), shininess);
    }
  }
  color = vec4(diffuse_color * diffuse + specular * highlights, 1.0);
})";

static GLuint shader(GLenum kind, const char* text) {
  GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint compiled;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  check(compiled, "compiling a shader");
  return shader;
}

static void open_context() {
  EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  check(display && eglInitialize(display, nullptr, nullptr) && eglBindAPI(EGL_OPENGL_API), "opening EGL");
  EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE}, count = 0;
  EGLConfig config;
  if (!eglChooseConfig(display, wanted, &config, 1, &count) || !count) config = EGL_NO_CONFIG_KHR;
  EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
                      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
  check(context && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context), "making a context");
}

// Of each vertex, the mean of its faces' normals, weighted by their angles there.
static std::vector<float> normals_of(const Mesh& mesh) {
  std::vector<float> normals(mesh.v.size(), 0.0f);
  for (size_t triangle = 0; triangle < mesh.nt(); triangle++) {
    double p[3][3], side[3][3], length[3], face[3];
    for (int k = 0; k < 3; k++)
      for (int a = 0; a < 3; a++) p[k][a] = mesh.v[3 * (size_t)mesh.f[3 * triangle + k] + a];
    for (int k = 0; k < 3; k++) {
      for (int a = 0; a < 3; a++) side[k][a] = p[(k + 1) % 3][a] - p[k][a];
      length[k] = std::sqrt(side[k][0] * side[k][0] + side[k][1] * side[k][1] + side[k][2] * side[k][2]);
    }
    for (int a = 0; a < 3; a++) {
      int b = (a + 1) % 3, c = (a + 2) % 3;
      face[a] = side[0][b] * side[1][c] - side[0][c] * side[1][b];
    }
    double area = std::sqrt(face[0] * face[0] + face[1] * face[1] + face[2] * face[2]);
    if (!(area > 0)) continue;
    for (int k = 0; k < 3; k++) {
      int before = (k + 2) % 3;
      double cosine = 0;
      for (int a = 0; a < 3; a++) cosine -= side[k][a] * side[before][a];
      double angle = std::acos(std::max(-1.0, std::min(1.0, cosine / (length[k] * length[before]))));
      for (int a = 0; a < 3; a++) normals[3 * (size_t)mesh.f[3 * triangle + k] + a] += float(angle * face[a] / area);
    }
  }
  return normals;
}

static void attribute(GLuint place, const std::vector<float>& values) {
  GLuint buffer;
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glBufferData(GL_ARRAY_BUFFER, 4 * values.size(), values.data(), GL_STATIC_DRAW);
  glVertexAttribPointer(place, 3, GL_FLOAT, GL_FALSE, 12, nullptr);
  glEnableVertexAttribArray(place);
}

static void upload(const Mesh& mesh) {
  GLuint array, indices;
  glGenVertexArrays(1, &array);
  glBindVertexArray(array);
  attribute(0, mesh.v);
  attribute(1, normals_of(mesh));
  glGenBuffers(1, &indices);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, 4 * mesh.f.size(), mesh.f.data(), GL_STATIC_DRAW);
}

static void open_frame(int width, int height) {
  GLuint frame, textures[2];
  glGenFramebuffers(1, &frame);
  glBindFramebuffer(GL_FRAMEBUFFER, frame);
  glGenTextures(2, textures);
  GLenum formats[2] = {GL_SRGB8_ALPHA8, GL_DEPTH_COMPONENT32F}, places[2] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
  for (int k = 0; k < 2; k++) {
    glBindTexture(GL_TEXTURE_2D, textures[k]);
    glTexStorage2D(GL_TEXTURE_2D, 1, formats[k], width, height);
    glFramebufferTexture2D(GL_FRAMEBUFFER, places[k], GL_TEXTURE_2D, textures[k], 0);
  }
  check(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE, "making a frame");
  glViewport(0, 0, width, height);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glDisable(GL_CULL_FACE);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDepthFunc(GL_GREATER);
}

static float linear(int byte) {
  float encoded = byte / 255.0f;
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

static void set_uniforms(GLuint program, const Camera& camera, const Mesh& mesh, int width, int height) {
  auto place = [&](const char* name) { return glGetUniformLocation(program, name); };
  double square = 0;
  for (int a = 0; a < 3; a++) {
    double way = camera.e[a] - mesh.v[3 * (size_t)mesh.f[0] + a];
    square += way * way;
  }
  float vw = camera.vh * (float)width / (float)height, near = 1e-3f * (float)std::sqrt(square);
  glUniform3fv(place("e"), 1, camera.e);
  glUniform3fv(place("u"), 1, camera.u);
  glUniform3fv(place("v"), 1, camera.v);
  glUniform3fv(place("w"), 1, camera.w);
  glUniform3f(place("scale_and_near"), 2 * camera.d / vw, 2 * camera.d / camera.vh, near);
  // The light and the plaster of lab/src/scenes/studio.rs.
  float directions[3][3] = {{0.3f, -1.15f, -0.8f}, {-1, -0.3f, 0.1f}, {0.2f, -0.4f, 1}}, intensity[3] = {0.78f, 0.2f, 0.15f};
  for (auto& d : directions) {
    float length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (float& coordinate : d) coordinate /= -length;
  }
  glUniform3fv(place("to_light"), 3, directions[0]);
  glUniform1fv(place("intensity"), 3, intensity);
  glUniform1f(place("ambient"), 0.14f);
  glUniform1f(place("specular"), 0.12f);
  glUniform1f(place("shininess"), 25);
  glUniform3f(place("diffuse_color"), linear(0xe6), linear(0xc9), linear(0xa5));
}

static void write_ppm(const char* path, const std::vector<unsigned char>& rgba, int width, int height) {
  FILE* file = fopen(path, "wb");
  check(file, path);
  fprintf(file, "P6\n%d %d\n255\n", width, height);
  for (int i = height - 1; i >= 0; i--)
    for (int j = 0; j < width; j++) fwrite(&rgba[4 * ((size_t)i * width + j)], 1, 3, file);
  fclose(file);
}

int main(int count, char** words) {
  int width, height, frames;
  if (count < 4 || (frames = atoi(words[2])) < 1 || sscanf(words[3], "%dx%d", &width, &height) != 2) {
    fprintf(stderr, "usage: gl_shaded MESH.tri FRAMES WxH [PICTURE.ppm]\n");
    return 2;
  }
  Camera camera;
  Mesh mesh = load_mesh(words[1], camera);
  open_context();
  GLuint program = glCreateProgram();
  glAttachShader(program, shader(GL_VERTEX_SHADER, VERTEX));
  glAttachShader(program, shader(GL_FRAGMENT_SHADER, FRAGMENT));
  glLinkProgram(program);
  GLint linked;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  check(linked, "linking the program");
  glUseProgram(program);
  upload(mesh);
  open_frame(width, height);
  set_uniforms(program, camera, mesh, width, height);

  float background[4] = {linear(0x36), linear(0x42), linear(0x4b), 0}, farthest = 0;
  std::vector<double> times;
  for (int frame = 0; frame <= frames; frame++) {
    glFinish();
    double start = now_ms();
    glClearBufferfv(GL_COLOR, 0, background);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    glDrawElements(GL_TRIANGLES, (GLsizei)mesh.f.size(), GL_UNSIGNED_INT, nullptr);
    glFinish();
    // The first frame warms up.
    if (frame) times.push_back(now_ms() - start);
  }
  std::vector<unsigned char> rgba(4 * (size_t)width * height);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  check(glGetError() == 0, "drawing");
  size_t covered = 0;
  for (size_t pixel = 0; pixel < rgba.size(); pixel += 4) covered += rgba[pixel + 3] != 0;
  printf("median %.3f best %.3f covered %zu\n", median(times), best(times), covered);
  if (count > 4) write_ppm(words[4], rgba, width, height);
}
