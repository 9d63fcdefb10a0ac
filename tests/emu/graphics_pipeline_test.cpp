// Limits, statistics and order of whole draws.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/graphics_pipeline.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

template <class T> struct Vertex {
    float4<T> position;
    float3<T> color;
    static constexpr auto signature() { return std::tuple{&Vertex::position, &Vertex::color}; }
};
template <class T> struct Color {
    float3<T> color;
    static constexpr auto signature() { return std::tuple{&Color::color}; }
};
template <class T> struct Register {
    float4<T> value;
    static constexpr auto signature() { return std::tuple{&Register::value}; }
};

struct PassThrough {
    template <class T> using Input = Vertex<T>;
    template <class T> using Output = Vertex<T>;
    template <class T> Vertex<T> operator()(VertexInput<T> const&, Vertex<T> const& v) const
    {
        return v;
    }
};

struct FlatColor {
    template <class T> using Input = Color<T>;
    template <class T> float4<T> operator()(PixelInput<T> const&, Color<T> const& in) const
    {
        return {in.color, T(1)};
    }
};

struct Hull {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    template <class T> using Input = Vertex<T>;
    template <class T> using ControlPoint = Vertex<T>;
    template <class T> using PatchConstant = Register<T>;
    int points = 4, registers = 0;
    float edge = 2;
    int control_points() const { return points; }
    int patch_constants() const { return registers; }
    template <class T>
    Vertex<T> control_point(PatchInput, ControlPoints<Vertex<T>> const& in, int_of<T> id) const
    {
        return in[id];
    }
    template <class T>
    Register<T> patch_constant(PatchInput, ControlPoints<Vertex<T>> const&,
                               ControlPoints<Vertex<T>> const&, int_of<T>) const
    {
        return {};
    }
    template <class T>
    std::array<T, 6> tess_factors(PatchInput in, ControlPoints<Vertex<T>> const&,
                                  ControlPoints<Vertex<T>> const&,
                                  ControlPoints<Register<T>> const&) const
    {
        T const f(in.primitive_id == 1 ? 0.0f : edge); // the second patch is culled
        return {f, f, f, f, T(edge), T(edge)};
    }
};

template <int kPoints> struct Bilinear {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = kPoints;
    template <class T> using ControlPoint = Vertex<T>;
    template <class T> using PatchConstant = Register<T>;
    template <class T> using Output = Vertex<T>;
    template <class T>
    Vertex<T> operator()(DomainInput<T> const& in, ControlPoints<Vertex<T>> const& p,
                         ControlPoints<Register<T>> const&) const
    {
        T const U = T(1) - in.u, V = T(1) - in.v;
        Vertex<T> const a = p[0], b = p[1], c = p[2], d = p[3];
        return {V * (U * a.position + in.u * b.position) +
                    in.v * (U * d.position + in.u * c.position),
                a.color};
    }
};

struct TriDomain : Bilinear<4> {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Tri;
};

GraphicsPipelineDesc patch_desc(Hull const& hull = {})
{
    GraphicsPipelineDesc d;
    d.vertex_shader = bind_vertex_shader(PassThrough{}, {});
    d.hull_shader = bind_hull_shader(hull, {});
    d.domain_shader = bind_domain_shader(Bilinear<4>{}, {});
    d.pixel_shader = bind_pixel_shader(FlatColor{}, {});
    d.partitioning = Partitioning::Integer;
    d.input_control_points = 4;
    return d;
}

void expect_refused(GraphicsPipelineDesc d, char const* word)
{
    try {
        GraphicsPipeline const p(std::move(d));
        FAIL() << word;
    } catch (Error const& e) {
        EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
    }
}

TEST(GraphicsPipeline, R3R49R50R79RefusesWhatD3D11RefusesAndNamesValueAndLimit)
{
    EXPECT_NO_THROW(GraphicsPipeline{patch_desc()});
    auto d = patch_desc();
    d.input_control_points = 33;
    expect_refused(d, "control points per patch is 33, the limit is 32");
    d = patch_desc();
    d.hull_shader = bind_hull_shader(Hull{33}, {});
    d.domain_shader = bind_domain_shader(Bilinear<33>{}, {});
    expect_refused(d, "output control points is 33, the limit is 32");
    // R49: 128 scalars of patch constants, six tess factors included: 30 registers fit, 31 do not.
    EXPECT_NO_THROW(GraphicsPipeline{patch_desc(Hull{4, 30})});
    expect_refused(patch_desc(Hull{4, 31}),
                   "patch constants, tess factors included is 130, the limit is 128");
    d = patch_desc();
    d.domain_shader = nullptr;
    expect_refused(d, "R3");
    d = patch_desc();
    d.domain_shader = bind_domain_shader(Bilinear<5>{}, {});
    expect_refused(d, "number of control points");
    d = patch_desc();
    d.domain_shader = bind_domain_shader(TriDomain{}, {});
    expect_refused(d, "R79");
    d = patch_desc();
    d.output_primitive = OutputPrimitive::Line;
    expect_refused(d, "R75");
    EXPECT_THROW(bind_pixel_shader(FlatColor{}, Machine{5}), Error);
}

std::vector<float> quad_vertices(float depth = 0.5f)
{
    std::vector<float> v;
    for (auto [x, y] : {std::pair{-0.5f, -0.5f}, {0.5f, -0.5f}, {0.5f, 0.5f}, {-0.5f, 0.5f}})
        v.insert(v.end(), {x, y, depth, 1, 1, 0, 0});
    return v;
}

// A target of one sample, cleared to black and depth 1.
struct Target {
    ColorTarget color;
    DepthTarget depth;
    explicit Target(int size) : color(size, size, Format::R32G32B32A32_FLOAT), depth(size, size)
    {
        color.clear({}, ThreadPool(1));
        depth.clear(1, 0, ThreadPool(1));
    }
    RasterTarget raster(bool counter_clockwise)
    {
        float const size = float(color.width());
        RasterTarget r{{&color}, &depth, {{0, 0, size, size, 0, 1}}};
        r.rasterizer.cull = CullMode::None;
        r.rasterizer.front_counter_clockwise = counter_clockwise;
        return r;
    }
};

DrawStatistics draw_patches(std::size_t patches, VertexCacheModel cache, Target& target)
{
    std::vector<float> const vertices = quad_vertices();
    std::vector<std::uint32_t> indices;
    for (std::size_t i = 0; i < patches; ++i) indices.insert(indices.end(), {0, 1, 2, 3});
    DrawCall call;
    call.set_vertices(vertices, 7);
    call.indices = std::span<std::uint32_t const>(indices);
    RasterTarget const raster = target.raster(true);
    DrawOptions options;
    options.vertex_cache = cache;
    return draw(GraphicsPipeline(patch_desc()), call, &raster, {}, ThreadPool(2), options);
}

TEST(PipelineStatistics, R42R43R156R157R158R159R160R161R162R163I2I16CountATessellatedDraw)
{
    for (auto kind : {VertexCacheModel::Kind::None, VertexCacheModel::Kind::Fifo,
                      VertexCacheModel::Kind::Infinite}) {
        Target target(64);
        PipelineStatistics const p = draw_patches(3, {kind, 16}, target).pipeline;
        EXPECT_EQ(p.IAVertices, 12u);
        EXPECT_EQ(p.IAPrimitives, 3u);
        EXPECT_EQ(p.VSInvocations, kind == VertexCacheModel::Kind::None ? 12u : 4u);
        EXPECT_EQ(p.HSInvocations, 3u); // the culled one too
        EXPECT_EQ(p.HSControlPointInvocations, 12u);
        EXPECT_EQ(p.HSPatchConstantInvocations, 3u);
        EXPECT_EQ(p.DSInvocations, 2u * 9);
        EXPECT_EQ(p.CInvocations, 2u * 8);
        EXPECT_EQ(p.CPrimitives, 2u * 8);
        EXPECT_EQ(p.PSInvocations, 32u * 32); // the second patch fails LESS everywhere
    }
}

// Doubles its vertex, and where `bent` those with an x above 0 twice.
struct Doubling : PassThrough {
    bool bent = false;
    template <class T> Vertex<T> operator()(VertexInput<T> const&, Vertex<T> v) const
    {
        v.position = v.position + v.position;
        if (bent)
            v.color = when(
                v.position.x > T(0), [&]() -> float3<T> { return v.color + v.color; }, v.color);
        return v;
    }
};

// Runs after a miss are counted, whether or not they take place.
TEST(PipelineStatistics, R42RunsAfterAMissCostWhatTheFirstDid)
{
    std::vector<float> const vertices = quad_vertices();
    std::vector<std::uint32_t> indices;
    for (int i = 0; i < 3; ++i) indices.insert(indices.end(), {0, 1, 2, 3});
    for (bool bent : {false, true}) {
        DrawCall call;
        call.set_vertices(vertices, 7);
        call.indices = std::span<std::uint32_t const>(indices);
        GraphicsPipelineDesc d = patch_desc();
        d.vertex_shader = bind_vertex_shader(Doubling{{}, bent}, {});
        DrawOptions options;
        options.vertex_cache = {VertexCacheModel::Kind::None, 0};
        DrawStatistics const s =
            draw(GraphicsPipeline(d), call, nullptr, {}, ThreadPool(1), options);
        EXPECT_EQ(s.pipeline.VSInvocations, 12u);
        auto const vs = std::find_if(s.stages.begin(), s.stages.end(), [](auto const& stage) {
            return stage.stage == "vertex_shader";
        });
        ASSERT_NE(vs, s.stages.end());
        // Of four vertices two lie right of the middle.
        EXPECT_EQ(vs->flops.add, bent ? 12u * 4 + 6u * 3 : 12u * 4);
        EXPECT_EQ(vs->flops.compare, bent ? 12u : 0u);
        ASSERT_FALSE(vs->fetches.empty());
        EXPECT_EQ(vs->fetches[0].count, 12u);
        EXPECT_EQ(vs->fetches[0].unique_bytes, 4u * 28);
    }
}

TEST(PipelineStatistics, R42I3NonIndexedVerticesNeverHitTheCache)
{
    std::vector<float> vertices = quad_vertices();
    vertices.insert(vertices.end(), vertices.begin(), vertices.begin() + 14);
    DrawCall call;
    call.topology = PrimitiveTopology::TriangleList;
    call.set_vertices(vertices, 7);
    call.vertex_count = 6;
    GraphicsPipelineDesc d;
    d.vertex_shader = bind_vertex_shader(PassThrough{}, {});
    d.pixel_shader = bind_pixel_shader(FlatColor{}, {});
    Target target(16);
    RasterTarget const raster = target.raster(false);
    DrawOptions options;
    options.vertex_cache = {VertexCacheModel::Kind::Infinite, 0};
    PipelineStatistics const p =
        draw(GraphicsPipeline(d), call, &raster, {}, ThreadPool(1), options).pipeline;
    EXPECT_EQ(p.VSInvocations, 6u);
    EXPECT_EQ(p.CInvocations, 2u);
}

TEST(Draw, R5WithoutATargetRasterizationIsOff)
{
    std::vector<float> const vertices = quad_vertices();
    DrawCall call;
    call.set_vertices(vertices, 7);
    call.vertex_count = 4;
    std::size_t visited = 0;
    PipelineStatistics const p =
        draw(
            GraphicsPipeline(patch_desc()), call, nullptr,
            [&](ShadedPatch const& s) { visited += s.points->patch.points(); }, ThreadPool(1))
            .pipeline;
    EXPECT_EQ(p.CInvocations, 0u);
    EXPECT_EQ(p.CPrimitives, 0u);
    EXPECT_EQ(p.PSInvocations, 0u);
    EXPECT_EQ(visited, 9u);
}

TEST(Draw, R35ReadsZeroPastTheVertexBuffer)
{
    std::vector<float> const vertices = quad_vertices();
    std::vector<std::uint32_t> const indices{0, 1, 2, 77};
    DrawCall call;
    call.set_vertices(vertices, 7);
    call.indices = std::span<std::uint32_t const>(indices);
    float last = -1;
    draw(
        GraphicsPipeline(patch_desc()), call, nullptr,
        [&](ShadedPatch const& s) {
            for (std::size_t i = 0; i < s.points->patch.points(); ++i)
                if (s.points->u[i] == 0 && s.points->v[i] == 1)
                    last = s.outputs[3 * s.stride + i]; // w of vertex 77
        },
        ThreadPool(1));
    EXPECT_EQ(last, 0.0f);
}

TEST(Draw, RefusesACallThatDoesNotFitThePipeline)
{
    std::vector<float> const vertices = quad_vertices();
    DrawCall call;
    call.set_vertices(vertices, 7);
    call.control_points = 5;
    EXPECT_THROW(draw(GraphicsPipeline(patch_desc()), call, nullptr, {}, ThreadPool(1)), Error);
    call.control_points = 4;
    call.set_vertices(vertices, 3);
    EXPECT_THROW(draw(GraphicsPipeline(patch_desc()), call, nullptr, {}, ThreadPool(1)), Error);
    call.set_vertices(vertices, 7);
    call.topology = PrimitiveTopology::TriangleList;
    EXPECT_THROW(draw(GraphicsPipeline(patch_desc()), call, nullptr, {}, ThreadPool(1)), Error);
}

// The shader's arithmetic flushes denormals in every worker (R9).
TEST(Draw, R9ShadersFlushDenormalsInEveryWorker)
{
    std::vector<float> vertices = quad_vertices();
    for (std::size_t i = 0; i < 4; ++i) vertices[7 * i] = 1e-40f;
    std::vector<std::uint32_t> indices;
    for (int i = 0; i < 200; ++i) indices.insert(indices.end(), {0, 1, 2, 3});
    DrawCall call;
    call.set_vertices(vertices, 7);
    call.indices = std::span<std::uint32_t const>(indices);
    std::size_t not_flushed = 0;
    draw(
        GraphicsPipeline(patch_desc()), call, nullptr,
        [&](ShadedPatch const& s) {
            for (std::size_t i = 0; i < s.points->patch.points(); ++i)
                not_flushed += (std::bit_cast<std::uint32_t>(s.outputs[i]) & 0x7fffffffu) != 0;
        },
        ThreadPool(3));
    EXPECT_EQ(not_flushed, 0u);
}

} // namespace
} // namespace tessemu
