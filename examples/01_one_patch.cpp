// One bilinear patch, tessellated with a domain shader of its own: prints points and costs.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/graphics_pipeline.h"
#include "shaders_cpp/pass_through.h"

#include <cstdio>

using namespace tessemu;

// S(u,v) = (1-v) ((1-u) p0 + u p1) + v ((1-u) p3 + u p2); p0..p3 counter-clockwise from (0,0).
struct Bilinear {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = 4;
    template <class T> using ControlPoint = ControlVertex<T>;
    template <class T> using PatchConstant = ControlVertex<T>;
    template <class T> using Output = ControlVertex<T>;

    template <class T>
    ControlVertex<T> operator()(DomainInput<T> const& in, auto const& patch, auto const&) const
    {
        T const U = T(1) - in.u, V = T(1) - in.v;
        float3<T> const bottom = U * patch[0].position + in.u * patch[1].position;
        float3<T> const top = U * patch[3].position + in.u * patch[2].position;
        return {V * bottom + in.v * top}; // not lerp: a + t*(b-a) misses b at t = 1
    }
};

int main()
{
    std::vector<float> const corners{0, 0, 0, 1, 0, 0.5f, 1, 1, 0, 0, 1, 0.5f};
    PassThroughHullShader<TessellatorDomain::Quad, 4> const hull{.tess_factor = 3};

    GraphicsPipelineDesc desc;
    desc.vertex_shader = bind_vertex_shader(PassThroughVertexShader{}, {});
    desc.hull_shader = bind_hull_shader(hull, {});
    desc.domain_shader = bind_domain_shader(Bilinear{}, {});
    desc.input_control_points = 4;

    DrawCall call;
    call.set_vertices(corners, 3);
    call.vertex_count = 4;

    auto const print = [](ShadedPatch const& p) {
        for (std::size_t i = 0; i < p.points->patch.points(); ++i)
            std::printf("%g %g %g\n", double(p.outputs[i]), double(p.outputs[p.stride + i]),
                        double(p.outputs[2 * p.stride + i]));
    };
    DrawStatistics const s = draw(GraphicsPipeline(desc), call, nullptr, print, ThreadPool());
    FlopCount const& flops = s.stages.back().flops;
    std::printf("%llu points, %llu multiplications, %llu additions\n",
                static_cast<unsigned long long>(s.pipeline.DSInvocations),
                static_cast<unsigned long long>(flops.mul),
                static_cast<unsigned long long>(flops.add));
}
