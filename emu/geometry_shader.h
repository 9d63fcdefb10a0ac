// Geometry shader stage: one invocation per primitive and instance, lanes across primitives
// (rules R83 to R86).
//
// A geometry shader is
//
//     struct S {
//         static constexpr PrimitiveTopology kInput;      // PointList, LineList, LineListAdj,
//                                                         // TriangleList, TriangleListAdj or
//                                                         // PatchList
//         static constexpr int kControlPoints = ...;      // with PatchList only
//         static constexpr GeometryOutput kOutput;
//         static constexpr int kMaxVertices;              // that one invocation may append
//         static constexpr int kInstances = ...;          // optional, 1 to 32
//         template <class T> using Input = ...;           // record of the stage before
//         template <class T> using Output = ...;          // record; where it is rasterized its
//                                                         // first member is float4<T> position
//         template <class T> void operator()(GeometryInput<T> const&, std::span<Input<T> const>,
//                                            VertexStream<Output<T>>&) const;
//     };
//
// Appending honours the active lanes: emit conditionally inside when<T>(mask, ...).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/bound_shader.h"
#include "emu/input_assembler.h"
#include "emu/statistics.h"

#include <cassert>

namespace tessemu {

enum class GeometryOutput : std::uint8_t { PointList, LineStrip, TriangleStrip };

inline constexpr int kMaxGeometryScalars = 1024, kMaxGeometryInstances = 32, kMaxStreams = 4;

template <class T> struct GeometryInput {
    int_of<T> primitive_id;       ///< SV_PrimitiveID
    std::int32_t instance_id = 0; ///< SV_GSInstanceID
};

/// System values of a vertex; a primitive takes its leading vertex's (R85).
template <class T> struct GeometryVertex {
    int_of<T> primitive_id = int_of<T>(0);   ///< what the pixel shader sees (R7)
    int_of<T> viewport_index = int_of<T>(0); ///< SV_ViewportArrayIndex (R99)
};

/// Where invocations append their vertices.
template <class V> class VertexStream {
    using T = scalar_of<V>;
    static constexpr int N = lanes_of<T>;

public:
    static constexpr std::size_t kScalars = scalar_count<V>();

    VertexStream(int max_vertices, int instances)
        : max_vertices_(max_vertices),
          capacity_(std::size_t(max_vertices * instances)),
          floats_(std::size_t(N) * capacity_ * kScalars),
          marks_(std::size_t(N) * capacity_)
    {
    }

    /// Appends a vertex in the active lanes; nothing past kMaxVertices (R84).
    void append(V const& vertex, GeometryVertex<T> const& values = {}, int stream = 0)
    {
        float scalars[kScalars][N];
        std::size_t k = 0;
        for_each_scalar(vertex, [&](auto const& s) { lanes_value(s).store(scalars[k++]); });
        for (std::uint32_t bits = execution.active_bits; bits; bits &= bits - 1) {
            int const l = std::countr_zero(bits);
            if (emitted_[l] == max_vertices_) continue;
            ++emitted_[l];
            std::size_t const at = std::size_t(l) * capacity_ + std::size_t(count_[l]++);
            for (k = 0; k < kScalars; ++k) floats_[at * kScalars + k] = scalars[k][l];
            marks_[at] = {values.primitive_id.raw[l], values.viewport_index.raw[l],
                          std::uint8_t(stream), bool(cut_[l] >> stream & 1)};
            cut_[l] &= std::uint8_t(~(1u << stream));
        }
    }
    /// Ends the strip of a stream in the active lanes.
    void restart_strip(int stream = 0)
    {
        for (std::uint32_t bits = execution.active_bits; bits; bits &= bits - 1)
            cut_[std::countr_zero(bits)] |= std::uint8_t(1u << stream);
    }

    struct Mark {
        std::int32_t primitive_id, viewport_index;
        std::uint8_t stream;
        bool cut; ///< a strip starts here
    };

    // For the stage.
    void begin_group()
    {
        for (int l = 0; l < N; ++l) count_[l] = 0;
        begin_instance();
    }
    void begin_instance() // an implicit cut (R83)
    {
        for (int l = 0; l < N; ++l) emitted_[l] = 0, cut_[l] = 0xf;
    }
    int count(int lane) const { return count_[lane]; }
    float const* vertex(int lane, int i) const
    {
        return floats_.data() + (std::size_t(lane) * capacity_ + std::size_t(i)) * kScalars;
    }
    Mark const& mark(int lane, int i) const
    {
        return marks_[std::size_t(lane) * capacity_ + std::size_t(i)];
    }

private:
    int max_vertices_;
    std::size_t capacity_;
    std::vector<float> floats_;
    std::vector<Mark> marks_;
    int count_[N], emitted_[N];
    std::uint8_t cut_[N];
};

/// Primitives to run: vertex k of primitive p is column index[p * vertices + k] of `inputs`.
struct GeometryBatch {
    float const* inputs; ///< component c of vertex i at [c * stride + i]
    std::size_t stride;
    std::span<std::uint32_t const> index;
    std::span<std::int32_t const> primitive_ids;
};

/// What came out, in order: strips expanded to whole primitives, stream by stream.
struct GeometryResult {
    struct Primitive {
        std::int32_t primitive_id, viewport_index;
        std::uint8_t stream;
    };
    std::vector<float> vertices; ///< primitive after primitive, whole vertices
    std::vector<Primitive> primitives;
};

class GeometryProgram : public ShaderProgram {
public:
    virtual PrimitiveTopology input_topology() const = 0;
    virtual int input_vertices() const = 0; ///< of one primitive
    virtual GeometryOutput output_topology() const = 0;
    virtual int max_vertices() const = 0;
    virtual int instances() const = 0;
    virtual int input_floats() const = 0;
    virtual int input_fetch_floats() const { return input_floats(); } ///< of one fetch
    virtual OutputLayout output() const = 0;
    virtual void run(ShaderBinding const& binding, GeometryBatch const& batch,
                     GeometryResult& result, StageCounters& counters,
                     StageBuffers const& buffers) const = 0;
    int vertices_per_output() const { return 1 + int(output_topology()); }
};

template <class Shader, class T>
class GeometryProgramOn final : public CompiledProgram<GeometryProgram, Shader> {
    static constexpr int N = lanes_of<T>;
    using Input = typename Shader::template Input<T>;
    using Output = typename Shader::template Output<T>;

    static constexpr int patch_points()
    {
        if constexpr (requires { Shader::kControlPoints; }) return Shader::kControlPoints;
        return 1;
    }
    static constexpr int instance_count()
    {
        if constexpr (requires { Shader::kInstances; }) return Shader::kInstances;
        return 1;
    }

public:
    PrimitiveTopology input_topology() const override { return Shader::kInput; }
    int input_vertices() const override
    {
        return vertices_per_primitive(Shader::kInput, patch_points());
    }
    GeometryOutput output_topology() const override { return Shader::kOutput; }
    int max_vertices() const override { return Shader::kMaxVertices; }
    int instances() const override { return instance_count(); }
    int input_floats() const override { return scalar_count<Input>(); }
    OutputLayout output() const override
    {
        return output_layout<typename Shader::template Output<float>>();
    }

    void run(ShaderBinding const& binding, GeometryBatch const& b, GeometryResult& result,
             StageCounters& counters, StageBuffers const& buffers) const override
    {
        Shader const& shader = binding.as<Shader>();
        StageScope const scope(counters, buffers, binding.sites());
        auto const n = std::size_t(input_vertices());
        std::size_t const primitives = b.primitive_ids.size();
        std::vector<Input> in(n);
        VertexStream<Output> stream(Shader::kMaxVertices, instance_count());
        for (std::size_t first = 0; first < primitives; first += N) {
            int const active = int(std::min<std::size_t>(N, primitives - first));
            GeometryInput<T> input{IntLanes<N>(0), 0};
            for (int l = 0; l < active; ++l)
                input.primitive_id.raw[l] = b.primitive_ids[first + std::size_t(l)];
            for (std::size_t k = 0; k < n; ++k) {
                std::size_t c = 0;
                for_each_scalar(in[k], [&](auto& s) {
                    Lanes<N> v(0.0f);
                    for (int l = 0; l < active; ++l)
                        v.raw[l] =
                            b.inputs[c * b.stride + b.index[(first + std::size_t(l)) * n + k]];
                    s = T(v);
                    ++c;
                });
            }
            stream.begin_group();
            for (int i = 0; i < instance_count(); ++i) {
                input.instance_id = i;
                begin_group<T>((1u << active) - 1);
                stream.begin_instance();
                shader(input, std::span<Input const>(in), stream);
            }
            for (int l = 0; l < active; ++l) collect(stream, l, result);
        }
        counters.invocations += primitives * std::uint64_t(instance_count());
        counters.input_fetches += primitives * std::uint64_t(instance_count()) * n;
        counters.input_touched += primitives * n;
    }

private:
    // Whole primitives of the lane's strips; what is left of a strip vanishes (R85).
    static void collect(VertexStream<Output> const& stream, int lane, GeometryResult& out)
    {
        constexpr int kSize = 1 + int(Shader::kOutput);
        int in_strip[kMaxStreams] = {}, recent[kMaxStreams][2] = {};
        for (int i = 0; i < stream.count(lane); ++i) {
            auto const& m = stream.mark(lane, i);
            int& n = in_strip[m.stream];
            int* const r = recent[m.stream];
            if (m.cut) n = 0;
            ++n;
            if (n >= kSize) {
                int corner[3] = {i, i, i};
                if constexpr (kSize == 2) corner[0] = r[1];
                if constexpr (kSize == 3) {
                    bool const odd = n % 2 == 0;
                    corner[0] = r[0];
                    corner[1] = odd ? i : r[1];
                    corner[2] = odd ? r[1] : i;
                }
                for (int k = 0; k < kSize; ++k) {
                    float const* const v = stream.vertex(lane, corner[k]);
                    out.vertices.insert(out.vertices.end(), v, v + VertexStream<Output>::kScalars);
                }
                auto const& lead = stream.mark(lane, corner[0]);
                out.primitives.push_back({lead.primitive_id, lead.viewport_index, m.stream});
            }
            r[0] = r[1];
            r[1] = i;
        }
    }
};

using GeometryShader = BoundShader<GeometryProgram>;

template <class Shader>
GeometryShader bind_geometry_shader(Shader const& shader, Machine const& machine)
{
    return bind_shader<GeometryProgramOn, GeometryProgram>(shader, machine);
}

} // namespace tessemu
