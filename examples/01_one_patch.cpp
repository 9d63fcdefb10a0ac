// One bilinear patch, tessellated with a domain shader of its own: prints points and costs.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/graphics_pipeline.h"
#include "shaders_cpp/gregory/vertex_shader.h"

#include <cstdio>

using namespace tessemu;

struct Corners { // hull shader: four corners pass through, all tess factors are 3
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    template <class T> using Input = ControlVertex<T>;
    template <class T> using ControlPoint = ControlVertex<T>;
    template <class T> using PatchConstant = ControlVertex<T>;
    int control_points() const { return 4; }
    int patch_constants() const { return 0; }
    template <class T>
    ControlVertex<T> control_point(PatchInput, auto const& in, int_of<T> id) const
    {
        return in[id];
    }
    template <class T>
    ControlVertex<T> patch_constant(PatchInput, auto const&, auto const&, int_of<T>) const
    {
        return {};
    }
    template <class T>
    std::array<T, 6> tess_factors(PatchInput, auto const&, auto const&, auto const&) const
    {
        return {T(3), T(3), T(3), T(3), T(3), T(3)};
    }
};

struct Bilinear { // S(u,v) = (1-v) ((1-u) p0 + u p1) + v ((1-u) p3 + u p2)
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
        return {V * bottom + in.v * top};
    }
};

int main()
{
    std::vector<float> const corners{0, 0, 0, 1, 0, 0.5f, 1, 1, 0, 0, 1, 0.5f};
    GraphicsPipelineDesc desc;
    desc.vertex_shader = make_vertex_program(StencilVertexShader{}, {});
    desc.hull_shader = make_hull_program(Corners{}, {});
    desc.domain_shader = make_domain_program(Bilinear{}, {});
    desc.input_control_points = 4;
    DrawCall call;
    call.vertices = corners;
    call.vertex_count = 4;
    auto const print = [](ShadedPatch const& p) {
        for (std::size_t i = 0; i < p.points->patch.points(); ++i)
            std::printf("%g %g %g\n", p.outputs[i], p.outputs[p.stride + i],
                        p.outputs[2 * p.stride + i]);
    };
    DrawStatistics const s = draw(GraphicsPipeline(desc), call, nullptr, print, ThreadPool());
    std::printf("%llu domain points, %llu multiplications\n",
                (unsigned long long)s.pipeline.DSInvocations,
                (unsigned long long)s.stages.back().flops.mul);
}
