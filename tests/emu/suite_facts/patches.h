// Patches for tests of whole tessellated draws: factors by patch, and shaders that show their
// system values.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/scene.h"

#include <cstring>

namespace tessemu::test {

template <class T> struct Constant {
    float4<T> value;
    static constexpr auto signature() { return std::tuple{&Constant::value}; }
};

inline TessFactors uniform(float f)
{
    return {f, f, f, f, f, f};
}

/// Hands its control points on. The factors of patch i are number i of the list, from its start
/// again at its end; the patch constant is (SV_PrimitiveID, 0, 0, 0).
template <TessellatorDomain D> struct PatchHull {
    static constexpr TessellatorDomain kDomain = D;
    template <class T> using Input = SceneVertex<T>;
    template <class T> using ControlPoint = SceneVertex<T>;
    template <class T> using PatchConstant = Constant<T>;
    int points = 1;
    std::vector<TessFactors> factors{{1, 1, 1, 1, 1, 1}};
    int control_points() const { return points; }
    int patch_constants() const { return 1; }
    template <class T>
    SceneVertex<T> control_point(PatchInput, ControlPoints<SceneVertex<T>> const& in,
                                 int_of<T> id) const
    {
        return in[id];
    }
    template <class T>
    Constant<T> patch_constant(PatchInput patch, ControlPoints<SceneVertex<T>> const&,
                               ControlPoints<SceneVertex<T>> const&, int_of<T>) const
    {
        return {{T(float(patch.primitive_id)), T(0), T(0), T(0)}};
    }
    template <class T>
    std::array<T, 6> tess_factors(PatchInput patch, ControlPoints<SceneVertex<T>> const&,
                                  ControlPoints<SceneVertex<T>> const&,
                                  ControlPoints<Constant<T>> const&) const
    {
        TessFactors const& f = factors[std::size_t(patch.primitive_id) % factors.size()];
        return {T(f[0]), T(f[1]), T(f[2]), T(f[3]), T(f[4]), T(f[5])};
    }
};

/// Spreads the domain from the last control point on: `size` wide in clip space. The value is
/// (SV_PrimitiveID, the hull shader's SV_PrimitiveID, x of the last control point's value, w of
/// it).
template <TessellatorDomain D> struct PatchDomain {
    static constexpr TessellatorDomain kDomain = D;
    template <class T> using ControlPoint = SceneVertex<T>;
    template <class T> using PatchConstant = Constant<T>;
    template <class T> using Output = SceneVertex<T>;
    float size = 0;
    template <class T>
    SceneVertex<T> operator()(DomainInput<T> const& in, ControlPoints<SceneVertex<T>> const& points,
                              ControlPoints<Constant<T>> const& constants) const
    {
        SceneVertex<T> const last = points[points.size() - 1];
        float4<T> const at = last.position;
        return {{at.x + T(size) * in.u, at.y + T(size) * in.v, at.z, at.w},
                {T(float(in.primitive_id)), constants[0].value.x, last.value.x, last.value.w}};
    }
};

/// SV_PrimitiveID + 1 as the first component.
struct ShowPrimitiveId {
    template <class T> using Input = SceneValue<T>;
    template <class T> float4<T> operator()(PixelInput<T> const& p, SceneValue<T> const&) const
    {
        return {T(p.primitive_id) + T(1), T(1), T(1), T(1)};
    }
};

/// A scene of patches, none of which is drawn yet, that can stream out.
struct PatchScene : Scene {
    using Scene::Scene;

    template <TessellatorDomain D>
    PatchScene& use_patches(PatchHull<D> const& hull, PatchDomain<D> const& domain = {})
    {
        desc.hull_shader = bind_hull_shader(hull, {});
        desc.domain_shader = bind_domain_shader(domain, {});
        desc.partitioning = Partitioning::Integer;
        desc.output_primitive =
            D == TessellatorDomain::Isoline ? OutputPrimitive::Line : OutputPrimitive::TriangleCw;
        desc.input_control_points = call.control_points = hull.points;
        call.topology = PrimitiveTopology::PatchList;
        return *this;
    }
    /// Streams `count` scalars from `first` on; by default positions and values.
    void stream_out(std::int16_t first = 0, std::uint8_t count = 8, std::size_t bytes = 1 << 16)
    {
        desc.stream_output = StreamOutputDesc{{{0, first, count, 0}}, {}, -1};
        streamed_floats = count;
        streamed_bytes.resize(bytes);
        buffer = {streamed_bytes, 0};
        options.stream_output = {&buffer, 1};
    }
    /// What lies in the buffer, vertex after vertex.
    std::vector<std::vector<float>> streamed() const
    {
        std::vector<std::vector<float>> all(buffer.filled / 4 / streamed_floats,
                                            std::vector<float>(streamed_floats));
        for (std::size_t i = 0; i < all.size(); ++i)
            std::memcpy(all[i].data(), streamed_bytes.data() + i * streamed_floats * 4,
                        streamed_floats * 4);
        return all;
    }

    std::size_t streamed_floats = 0;
    std::vector<std::byte> streamed_bytes;
    StreamOutputBuffer buffer;
};

} // namespace tessemu::test
