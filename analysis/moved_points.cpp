// SPDX-License-Identifier: Apache-2.0
#include "analysis/moved_points.h"

#include "shaders_cpp/displacement.h"

namespace tessemu {

namespace {

/// From a vertex in object space to the same in clip space, moved.
///
/// \tparam Vertex  ShadedVertex or DisplacedVertex
template <template <class> class Vertex> struct MoveShader {
    template <class T> using Input = Vertex<T>;
    template <class T> using Output = Vertex<T>;

    PointMoves moves;
    Matrix4 view_projection = kIdentity;

    template <class T> Vertex<T> operator()(DomainInput<T> const&, Vertex<T> const& in) const
    {
        float3<T> const p(in.position.x, in.position.y, in.position.z);
        Vertex<T> out = in;
        out.position = rounded<T>(transform(view_projection, apart<T>(p, in.normal)));
        return out;
    }

private:
    template <class T> float3<T> apart(float3<T> const& p, float3<T> const& normal) const
    {
        using Int = int_of<T>;
        if (moves.parity == 0) return p;
        Int const bits = asuint(p.x) + asuint(p.y) + asuint(p.z);
        T const by = select((bits & Int(1)) != Int(0), T(moves.parity), T(-moves.parity));
        return p + by * normal;
    }
    template <class T> float4<T> rounded(float4<T> const& clip) const
    {
        if (moves.lattice == 0) return clip;
        T const inverse = T(1) / clip.w;
        auto const to_lattice = [&](T const& x) -> T {
            T const scaled = T(moves.lattice) * T(x * inverse);
            return T(1 / moves.lattice) * floor(T(scaled + T(0.5)));
        };
        return {to_lattice(clip.x), to_lattice(clip.y), T(clip.z * inverse), T(1)};
    }
};

// One epilog after another, of the same record.
class EpilogAndMove final : public DomainEpilogProgram {
public:
    EpilogAndMove(DomainEpilog epilog, DomainEpilog move)
        : epilog_(std::move(epilog)),
          move_(std::move(move))
    {
    }
    int input_floats() const override { return epilog_->input_floats(); }
    OutputLayout output() const override { return epilog_->output(); }
    std::vector<ResourceInfo> resources(ShaderBinding const&) const override
    {
        return epilog_.resources();
    }
    void run(ShaderBinding const&, DomainBatch const& batch, std::size_t first,
             std::size_t count) const override
    {
        epilog_.run(batch, first, count);
        move_.run(batch, first, count);
    }

private:
    DomainEpilog epilog_, move_;
};

// A vertex shader that gives points of the surface, and the move behind it.
class VertexAndMove final : public VertexProgram {
public:
    VertexAndMove(VertexShader vertex, DomainEpilog move)
        : vertex_(std::move(vertex)),
          move_(std::move(move))
    {
    }
    int input_floats() const override { return vertex_->input_floats(); }
    OutputLayout output() const override { return vertex_->output(); }
    std::vector<ResourceInfo> resources(ShaderBinding const&) const override
    {
        return vertex_.resources();
    }
    void run(ShaderBinding const&, VertexBatch const& batch, float* outputs,
             StageCounters& counters, StageBuffers const& buffers) const override
    {
        vertex_.run(batch, outputs, counters, buffers);
        if (!outputs) return;
        // An epilog has its points component by component, in whole groups of at most 16 lanes.
        std::size_t const n = batch.ids.size(), stride = (n + 15) / 16 * 16;
        auto const floats = std::size_t(output().floats);
        std::vector<float> points(stride * floats), nowhere(stride);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t k = 0; k < floats; ++k)
                points[k * stride + i] = outputs[batch.ids[i] * floats + k];
        {
            StageScope const scope(counters, buffers, vertex_.sites());
            move_.run(DomainBatch{nullptr, 0, nullptr, 0, 0, nowhere.data(), nowhere.data(), n,
                                  points.data(), stride},
                      std::size_t(0), n);
        }
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t k = 0; k < floats; ++k)
                outputs[batch.ids[i] * floats + k] = points[k * stride + i];
    }

private:
    VertexShader vertex_;
    DomainEpilog move_;
};

DomainEpilog move_of(Draw const& d, PointMoves const& moves, SurfaceSettings const& settings)
{
    // The checking form follows whatever contraction the draw has.
    Machine machine = settings.machine;
    machine.checking = true;
    GraphicsPipelineDesc const& p = d.pipeline;
    OutputLayout const record = p.domain_shader ? p.domain_output() : p.vertex_shader->output();
    if (record.holds<DisplacedVertex<float>>())
        return bind_domain_epilog(MoveShader<DisplacedVertex>{moves, settings.view_projection},
                                  machine);
    if (record.holds<ShadedVertex<float>>())
        return bind_domain_epilog(MoveShader<ShadedVertex>{moves, settings.view_projection},
                                  machine);
    throw Error("the draw '" + d.name + "' writes vertices that are no surface's");
}

} // namespace

CommandList MovedPoints::commands(SurfaceSettings const& settings) const
{
    if (moves_.parity == 0 && moves_.lattice == 0) return patches_.commands(settings);
    SurfaceSettings object_space = settings;
    object_space.view_projection = kIdentity;
    CommandList list = patches_.commands(object_space);
    list.for_each_surface_draw([&](Draw& d) {
        DomainEpilog const move = move_of(d, moves_, settings);
        GraphicsPipelineDesc& p = d.pipeline;
        if (!p.domain_shader)
            p.vertex_shader = {std::make_shared<VertexAndMove>(p.vertex_shader, move),
                               p.vertex_shader.binding()};
        else if (p.domain_epilog)
            p.domain_epilog = {std::make_shared<EpilogAndMove>(p.domain_epilog, move),
                               p.domain_epilog.binding()};
        else
            p.domain_epilog = move;
    });
    return list;
}

} // namespace tessemu
