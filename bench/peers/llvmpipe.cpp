// Peer: Mesa's llvmpipe draws the same Gregory patches through OpenGL tessellation shaders, off
// screen: the same camera, depth test and lighting, nothing culled. Control points are ready; only
// evaluation, assembly, raster and shading are measured.
//
// Prints "frame FACTOR MILLISECONDS" and "geometry FACTOR MILLISECONDS", medians; geometry is with
// the rasterizer discarded. LP_NUM_THREADS sets llvmpipe's raster threads; its geometry side is one
// thread. Usage: peer_llvmpipe [FACTOR ...] [PICTURE.png], a picture of the last factor.
//
// SPDX-License-Identifier: Apache-2.0
#include "bench/scene.h"
#include "io/image_writer.h"
#include "pipeline/schemes/gregory/stencils.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

namespace tessemu {
namespace {

constexpr int kSize = 1024, kPoints = 20;

char const* const kVertex = R"(#version 450 core
layout(location = 0) in vec3 position;
out vec3 p;
void main() { p = position; }
)";
char const* const kControl = R"(#version 450 core
layout(vertices = 20) out;
in vec3 p[];
out vec3 q[];
uniform float level;
void main() {
    q[gl_InvocationID] = p[gl_InvocationID];
    gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = gl_TessLevelOuter[3] = level;
    gl_TessLevelInner[0] = gl_TessLevelInner[1] = level;
}
)";
// shaders_cpp/gregory/gregory_quad.h with frozen face points.
char const* const kEvaluation = R"(#version 450 core
layout(quads, fractional_odd_spacing, ccw) in;
in vec3 q[];
out vec3 normal;
uniform mat4 view_projection;
vec3 face(float a, vec3 X, float b, vec3 Y) {
    float s = a + b;
    float r = 1 / (s == 0 ? 1 : s);
    return a * r * X + b * r * Y;
}
void main() {
    float u = gl_TessCoord.x, v = gl_TessCoord.y, U = 1 - u, V = 1 - v;
    vec3 F0 = face(u, q[12], v, q[16]), F1 = face(U, q[17], v, q[13]);
    vec3 F2 = face(U, q[14], V, q[18]), F3 = face(u, q[19], V, q[15]);
    vec4 b = vec4(U * U * U, 3 * u * U * U, 3 * u * u * U, u * u * u);
    vec4 d = 3 * vec4(-U * U, U * U - 2 * u * U, 2 * u * U - u * u, u * u);
    vec4 c = vec4(V * V * V, 3 * v * V * V, 3 * v * v * V, v * v * v);
    vec4 e = 3 * vec4(-V * V, V * V - 2 * v * V, 2 * v * V - v * v, v * v);
    vec3 r0 = c.x * q[0] + c.y * q[8] + c.z * q[7] + c.w * q[3];
    vec3 r1 = c.x * q[4] + c.y * F0 + c.z * F3 + c.w * q[11];
    vec3 r2 = c.x * q[9] + c.y * F1 + c.z * F2 + c.w * q[6];
    vec3 r3 = c.x * q[1] + c.y * q[5] + c.z * q[10] + c.w * q[2];
    vec3 s0 = e.x * q[0] + e.y * q[8] + e.z * q[7] + e.w * q[3];
    vec3 s1 = e.x * q[4] + e.y * F0 + e.z * F3 + e.w * q[11];
    vec3 s2 = e.x * q[9] + e.y * F1 + e.z * F2 + e.w * q[6];
    vec3 s3 = e.x * q[1] + e.y * q[5] + e.z * q[10] + e.w * q[2];
    vec3 position = b.x * r0 + b.y * r1 + b.z * r2 + b.w * r3;
    normal = normalize(cross(d.x * r0 + d.y * r1 + d.z * r2 + d.w * r3,
                             b.x * s0 + b.y * s1 + b.z * s2 + b.w * s3));
    gl_Position = view_projection * vec4(position, 1);
}
)";
// shaders_cpp/pixel/surface_views.h, the lit view.
char const* const kFragment = R"(#version 450 core
in vec3 normal;
out vec4 color;
uniform vec3 light, half_vector, up;
void main() {
    vec3 n = normalize(normal);
    if (!gl_FrontFacing) n = -n;
    float diffuse = max(dot(n, light), 0), sky = 0.5 + 0.5 * dot(n, up);
    float h = max(dot(n, half_vector), 0);
    float h2 = h * h, h4 = h2 * h2, h8 = h4 * h4, h16 = h8 * h8;
    vec3 ambient = vec3(0.34, 0.30, 0.30) + vec3(0.08, 0.16, 0.26) * sky;
    color = vec4(clamp(vec3(0.86, 0.72, 0.55) * (ambient + 0.62 * diffuse) + 0.22 * h16 * h16, 0, 1), 1);
}
)";

[[noreturn]] void die(std::string const& what)
{
    std::fprintf(stderr, "peer_llvmpipe: %s\n", what.c_str());
    std::exit(1);
}

GLuint compile(GLenum kind, char const* source)
{
    GLuint const s = glCreateShader(kind);
    glShaderSource(s, 1, &source, nullptr);
    glCompileShader(s);
    GLint good = 0;
    glGetShaderiv(s, GL_COMPILE_STATUS, &good);
    if (!good) {
        char log[2048];
        glGetShaderInfoLog(s, sizeof log, nullptr, log);
        die(log);
    }
    return s;
}

void make_context()
{
    EGLDisplay const display =
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (!eglInitialize(display, nullptr, nullptr)) die("no EGL");
    eglBindAPI(EGL_OPENGL_API);
    EGLint const attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
    EGLContext const context =
        eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT) die("no OpenGL 4.5");
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) die("no context");
}

// 20 control points a quad, by the project's own stencils.
std::vector<float> control_points(BenchScene const& scene)
{
    std::vector<float> out;
    ControlMesh const& mesh = scene.mesh();
    Neighbourhood n;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        if (mesh.face(f).size() != 4) continue;
        find_neighbourhood(scene.scheme.mesh->topology(), f, n);
        PatchStencils const s = make_gregory_stencils(n, false, {});
        for (int r = 0; r < kPoints; ++r) {
            glm::dvec3 p(0);
            for (std::size_t i = 0; i < n.inputs.size(); ++i)
                p += s.rows[std::size_t(r)][i] * glm::dvec3(mesh.positions[n.inputs[i]]);
            out.insert(out.end(), {float(p.x), float(p.y), float(p.z)});
        }
    }
    return out;
}

void set_vector(GLuint program, char const* name, glm::vec3 v)
{
    glUniform3f(glGetUniformLocation(program, name), v.x, v.y, v.z);
}

double median_ms(std::function<void()> const& work)
{
    using Clock = std::chrono::steady_clock;
    for (int i = 0; i < 3; ++i) work();
    std::vector<double> times;
    auto const start = Clock::now();
    while (times.size() < 15 &&
           (times.size() < 5 || Clock::now() - start < std::chrono::seconds(8))) {
        auto const before = Clock::now();
        work();
        times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - before).count());
    }
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
}

void run(std::vector<int> const& factors, char const* picture)
{
    BenchScene const scene;
    std::vector<float> const points = control_points(scene);
    auto const patches = GLsizei(points.size() / (3 * kPoints));
    make_context();
    std::string const renderer = reinterpret_cast<char const*>(glGetString(GL_RENDERER));
    if (renderer.find("llvmpipe") == std::string::npos) die(renderer + " is not llvmpipe");

    GLuint array, buffer, frame, targets[2];
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(points.size() * 4), points.data(), GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 12, nullptr);
    glPatchParameteri(GL_PATCH_VERTICES, kPoints);
    GLuint const program = glCreateProgram();
    for (auto [kind, source] : {std::pair{GL_VERTEX_SHADER, kVertex},
                                {GL_TESS_CONTROL_SHADER, kControl},
                                {GL_TESS_EVALUATION_SHADER, kEvaluation},
                                {GL_FRAGMENT_SHADER, kFragment}})
        glAttachShader(program, compile(GLenum(kind), source));
    glLinkProgram(program);
    glUseProgram(program);

    Camera const& camera = scene.settings.camera;
    Matrix4 const m = view_projection(camera, 1);
    float columns[16];
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) columns[4 * j + i] = m[i][j];
    glUniformMatrix4fv(glGetUniformLocation(program, "view_projection"), 1, GL_FALSE, columns);
    glm::vec3 const light = glm::normalize(-0.5f * camera.right() + 0.62f * camera.true_up() +
                                           0.6f * camera.backward());
    set_vector(program, "light", light);
    set_vector(program, "half_vector", glm::normalize(light + camera.backward()));
    set_vector(program, "up", camera.true_up());

    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glGenRenderbuffers(2, targets);
    for (auto [i, format, attachment] : {std::tuple{0, GL_RGBA8, GL_COLOR_ATTACHMENT0},
                                         {1, GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT}}) {
        glBindRenderbuffer(GL_RENDERBUFFER, targets[i]);
        glRenderbufferStorage(GL_RENDERBUFFER, GLenum(format), kSize, kSize);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GLenum(attachment), GL_RENDERBUFFER, targets[i]);
    }
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) die("no target");
    glViewport(0, 0, kSize, kSize);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE); // Direct3D's depth
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glClearColor(0.93f, 0.94f, 0.96f, 1);

    for (int factor : factors) {
        glUniform1f(glGetUniformLocation(program, "level"), float(factor));
        // One call must not tessellate past 65,535 vertices: its indices have 16 bits.
        int const segments = std::min(63, factor | 1);
        int const per_call = 65535 / ((segments + 1) * (segments + 1));
        auto const draw = [&] {
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            for (GLsizei first = 0; first < patches; first += per_call)
                glDrawArrays(GL_PATCHES, first * kPoints,
                             std::min(per_call, patches - first) * kPoints);
            glFinish();
        };
        std::printf("frame %d %.4f\n", factor, median_ms(draw));
        if (picture && factor == factors.back()) {
            ColorTarget image(kSize, kSize);
            std::vector<std::byte> pixels(std::size_t(kSize) * kSize * 4);
            glReadPixels(0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
            for (int y = 0; y < kSize; ++y)
                std::copy_n(pixels.begin() + std::ptrdiff_t(kSize - 1 - y) * kSize * 4, kSize * 4,
                            image.texel(0, y));
            OutputFile out(picture);
            write_image(image, out);
            out.commit();
        }
        glEnable(GL_RASTERIZER_DISCARD);
        std::printf("geometry %d %.4f\n", factor, median_ms(draw));
        glDisable(GL_RASTERIZER_DISCARD);
        std::fflush(stdout);
    }
    if (glGetError() != GL_NO_ERROR) die("OpenGL reports an error");
}

} // namespace
} // namespace tessemu

int main(int argc, char** argv)
{
    std::vector<int> factors;
    char const* picture = nullptr;
    for (int i = 1; i < argc; ++i)
        if (int const factor = std::atoi(argv[i]))
            factors.push_back(factor);
        else
            picture = argv[i];
    if (factors.empty()) factors = {3, 10, 17, 25, 64};
    tessemu::run(factors, picture);
}
