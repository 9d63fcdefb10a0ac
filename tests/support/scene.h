// A small scene for tests of rules: vertices with one attribute, any state, one target.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graphics_pipeline.h"

#include <cmath>

namespace tessemu::test {

/// Clip-space position and a float4, which pixel shaders get as their input.
template <class T> struct SceneVertex {
    float4<T> position, value;
    static constexpr auto signature()
    {
        return std::tuple{&SceneVertex::position, &SceneVertex::value};
    }
};
template <class T> struct SceneValue {
    float4<T> value;
    static constexpr auto signature() { return std::tuple{&SceneValue::value}; }
};
struct SceneVertexShader {
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = SceneVertex<T>;
    template <class T>
    SceneVertex<T> operator()(VertexInput<T> const&, SceneVertex<T> const& v) const
    {
        return v;
    }
};
/// The attribute as the colour.
struct ShowValue {
    template <class T> using Input = SceneValue<T>;
    template <class T> float4<T> operator()(PixelInput<T> const&, SceneValue<T> const& in) const
    {
        return in.value;
    }
};

struct Scene {
    int width, height;
    ColorTarget color;
    DepthTarget depth;
    RasterTarget target;
    GraphicsPipelineDesc desc;
    DrawCall call;
    std::vector<float> vertices; ///< eight floats each
    std::vector<std::uint32_t> indices;
    DrawOptions options;
    int threads = 2;
    DrawStatistics statistics;

    explicit Scene(int w = 16, int h = 16, int samples = 1,
                   Format format = Format::R32G32B32A32_FLOAT,
                   Format depth_format = Format::D32_FLOAT)
        : width(w),
          height(h),
          color(w, h, format, samples),
          depth(w, h, depth_format, samples)
    {
        target.color = {&color};
        target.depth = &depth;
        target.viewports = {{0, 0, float(w), float(h), 0, 1}};
        target.rasterizer.cull = CullMode::None;
        desc.vertex_shader = bind_vertex_shader(SceneVertexShader{}, {});
        desc.pixel_shader = bind_pixel_shader(ShowValue{}, {});
        call.topology = PrimitiveTopology::TriangleList;
        clear();
    }
    Scene(Scene const&) = delete;

    void clear(std::array<float, 4> c = {0, 0, 0, 0}, float z = 1, std::uint8_t stencil = 0)
    {
        color.clear(c, ThreadPool(1));
        depth.clear(z, stencil, ThreadPool(1));
    }
    /// A vertex at a place in pixels.
    Scene& add(float x, float y, float z = 0.5f, float w = 1,
               std::array<float, 4> value = {1, 1, 1, 1})
    {
        vertices.insert(vertices.end(), {(x / (float(width) / 2) - 1) * w,
                                         (1 - y / (float(height) / 2)) * w, z * w, w});
        vertices.insert(vertices.end(), value.begin(), value.end());
        return *this;
    }
    /// A triangle that covers the whole target.
    Scene& add_full(float z = 0.5f, std::array<float, 4> value = {1, 1, 1, 1})
    {
        float const s = 2 * float(std::max(width, height));
        return add(0, 0, z, 1, value).add(s, 0, z, 1, value).add(0, s, z, 1, value);
    }
    DrawStatistics const& draw()
    {
        call.set_vertices(vertices, 8);
        call.vertex_count = std::uint32_t(vertices.size() / 8);
        if (!indices.empty()) call.indices = std::span<std::uint32_t const>(indices);
        statistics =
            tessemu::draw(GraphicsPipeline(desc), call, &target, {}, ThreadPool(threads), options);
        return statistics;
    }
    template <class Shader> void use(Shader const& shader)
    {
        desc.pixel_shader = bind_pixel_shader(shader, {});
    }
    float at(int x, int y, std::size_t k = 0, int s = 0) const { return color.load(x, y, s)[k]; }
    /// Samples whose first component is not 0.
    int covered() const
    {
        int n = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (int s = 0; s < color.samples(); ++s) n += at(x, y, 0, s) != 0;
        return n;
    }
};

} // namespace tessemu::test
