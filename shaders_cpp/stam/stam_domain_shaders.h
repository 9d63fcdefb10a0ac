// Domain shaders of Stam's evaluation (stam_quad.h): as in the paper, the same formula everywhere;
// and with edges that have equal bits from both sides (docs/stam.md).
//
//     e_1 --outer-- f_0
//      |             |        v
//    spoke         outer      |     Corner 0 is the extraordinary vertex EV; edges 0 and 3 are
//      |             |        +-u   spokes, edges 1 and 2 outer edges.
//      EV --spoke-- e_0
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/cubic_edges.h"
#include "shaders_cpp/plain_patch.h"
#include "shaders_cpp/stam/stam_quad.h"

namespace tessemu {

/// The net in eigen space as control points.
struct StamPointsInside {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = 0; // 2n + 8
    template <class T> using ControlPoint = ControlVertex<T>;

    StamTables<> tables;

    std::vector<ResourceInfo> resources() const
    {
        std::vector<ResourceInfo> out;
        tables.add_to(out);
        return out;
    }
    template <class T>
    constexpr TangentFrame<T> evaluate(ControlPoints<ControlVertex<T>> const& patch,
                                       DomainInput<T> const& in, bool) const
    {
        return stam_quad<T>(
            tables, [&](int i) { return patch[i].position; }, in.u, in.v);
    }
    template <class T>
    constexpr SecondOrderFrame<T> second_order(ControlPoints<ControlVertex<T>> const& patch,
                                               DomainInput<T> const& in) const
    {
        return stam_second_order<T>(
            tables, [&](int i) { return patch[i].position; }, in.u, in.v);
    }
};

/// The net in eigen space from a buffer, which StamProjectionShader filled.
struct StamBufferInside {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = 0; // any: none is read
    template <class T> using ControlPoint = ControlVertex<T>;

    StamTables<> tables;
    Buffer<float> projected; ///< [patch][function][3]

    std::vector<ResourceInfo> resources() const
    {
        std::vector<ResourceInfo> out;
        tables.add_to(out);
        out.push_back(projected.info());
        return out;
    }
    /// Of any patch of the draw.
    template <class T> constexpr TangentFrame<T> of_patch(std::int32_t patch, T u, T v) const
    {
        return stam_quad<T>(tables, net_of<T>(patch), u, v);
    }
    template <class T>
    constexpr TangentFrame<T> evaluate(ControlPoints<ControlVertex<T>> const&,
                                       DomainInput<T> const& in, bool) const
    {
        return of_patch<T>(in.primitive_id, in.u, in.v);
    }
    template <class T>
    constexpr SecondOrderFrame<T> second_order(ControlPoints<ControlVertex<T>> const&,
                                               DomainInput<T> const& in) const
    {
        return stam_second_order<T>(tables, net_of<T>(in.primitive_id), in.u, in.v);
    }

private:
    template <class T> constexpr auto net_of(std::int32_t patch) const
    {
        return [this, first = patch * tables.functions](int i) -> float3<T> {
            std::int32_t const at = 3 * (first + i);
            return {load<T>(projected, at), load<T>(projected, at + 1), load<T>(projected, at + 2)};
        };
    }
};

using StamPointsDomainShader = PlainPatch<StamPointsInside>;
using StamBufferDomainShader = PlainPatch<StamBufferInside>;

/// With edges of equal bits from both sides. Outer edges and corners come from vertex data, as in
/// all patches of the stencil form: the cubic (p, e+, e-, p) and its normal field, which are the
/// limit surface's there, and the limit normals. A spoke is no cubic: both of its patches evaluate
/// the net of one of them, of which it is edge 0, by the same routine.
struct StamSharedInside : CubicEdges<4> {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = 12; // p, e+, e-, corner by corner
    static constexpr std::uint32_t kNoOwner = 0x7fffffffu;

    StamBufferInside nets;
    Buffer<std::uint32_t> owners; ///< [patch]: that of the draw for which edge 3 is edge 0

    std::vector<ResourceInfo> resources() const
    {
        std::vector<ResourceInfo> out = nets.resources();
        out.push_back(owners.info());
        return out;
    }
    template <class T>
    constexpr TangentFrame<T> evaluate(ControlPoints<ControlVertex<T>> const& patch,
                                       DomainInput<T> const& in, bool) const
    {
        return nets.template evaluate<T>(patch, in, false);
    }
    template <class T>
    constexpr SecondOrderFrame<T> second_order(ControlPoints<ControlVertex<T>> const& patch,
                                               DomainInput<T> const& in) const
    {
        return nets.template second_order<T>(patch, in);
    }
    static constexpr bool has_own_edge(int k) { return k == 0 || k == 3; }
    template <class T>
    constexpr SurfacePoint<T> own_edge(ControlPoints<ControlVertex<T>> const&,
                                       DomainInput<T> const& in, int k, T) const
    {
        std::int32_t const owner =
            k == 0 ? in.primitive_id : std::int32_t(load<T>(owners, in.primitive_id));
        bool const owned = k == 0 || owner == std::int32_t(kNoOwner);
        Routine<T> const here("stam_spoke");
        TangentFrame<T> const s = owned ? nets.template of_patch<T>(in.primitive_id, in.u, in.v)
                                        : nets.template of_patch<T>(owner, in.v, in.u);
        return {s.position, cross(s.du, s.dv)};
    }
};
using StamSharedDomainShader = WatertightPatch<StamSharedInside>;

} // namespace tessemu
