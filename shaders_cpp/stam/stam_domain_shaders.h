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

/// What StamSharedDomainShader knows of a patch, a word each.
struct StamPatchWords {
    static constexpr int kOwner = 0; ///< patch of the draw for which edge 3 is edge 0; or kNone
    static constexpr int kEdges = 1; ///< bit 0, 1: edge 0, 3 is collapsed, both ends one pole
    static constexpr int kCount = 2;
    static constexpr std::uint32_t kNone = 0x7fffffffu;
};

/// With edges of equal bits from both sides. Outer edges and corners come from vertex data, as in
/// all patches of the stencil form: the cubic (p, e+, e-, p) and its normal field, which are the
/// limit surface's there, and the limit normals. A spoke is no cubic: both of its patches evaluate
/// the net of one of them, of which it is edge 0, by the same routine.
struct StamSharedDomainShader {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = 12; // p, e+, e-, corner by corner
    template <class T> using ControlPoint = ControlVertex<T>;
    template <class T> using PatchConstant = EdgeRegister<T>;
    template <class T> using Output = SurfacePoint<T>;

    StamBufferInside inside;
    Buffer<std::uint32_t> words; ///< [patch][StamPatchWords]

    std::vector<ResourceInfo> resources() const
    {
        std::vector<ResourceInfo> out = inside.resources();
        out.push_back(words.info());
        return out;
    }
    template <class T>
    SurfacePoint<T> operator()(DomainInput<T> const& in,
                               ControlPoints<ControlVertex<T>> const& patch,
                               ControlPoints<EdgeRegister<T>> const& registers) const
    {
        std::int32_t const id = in.primitive_id, first = StamPatchWords::kCount * id;
        std::int32_t const owner = load<T>(words, first + StamPatchWords::kOwner),
                           edges = load<T>(words, first + StamPatchWords::kEdges);
        bool const owned = owner == std::int32_t(StamPatchWords::kNone);
        DomainEdges<4, T> const at = domain_edges<kDomain>(in);
        mask_of<T> const none(false), outer = at.on[1] | at.on[2];
        mask_of<T> const corner = (at.on[0] & at.on[3]) | outer;
        mask_of<T> const spoke = edges & 1 ? none : mask_of<T>(at.on[0] & !corner);
        mask_of<T> const other_spoke = edges & 2 ? none : mask_of<T>(at.on[3] & !corner);
        mask_of<T> const within = !(at.on[0] | at.on[3] | outer);
        mask_of<T> const own =
            owned ? mask_of<T>(within | spoke | other_spoke) : mask_of<T>(within | spoke);
        mask_of<T> const of_owner = owned ? none : other_spoke;
        auto const rim = [&](T u, T v) {
            // The shader of the patches beside it, whose sums are numbered from its first line.
            SiteScope<T> const here;
            if constexpr (ScalarTraits<T>::kSites) site_state.enter(0, 0);
            return WatertightPatch<Rim>{}({u, v, T(0), id}, patch, registers);
        };
        T const zero(0), one(1), half(0.5);
        SurfacePoint<T> s{{zero, zero, zero}, {zero, zero, zero}};
        for (int i : loop<T>(2)) // the same places in the source for both
            s = when(
                i == 0 ? own : of_owner,
                [&] {
                    TangentFrame<T> const f = inside.template of_patch<T>(
                        i == 0 ? id : owner, i == 0 ? in.u : in.v, i == 0 ? in.v : zero);
                    return SurfacePoint<T>{f.position, unit_or(cross(f.du, f.dv), [&] {
                                               return rim(select(in.u > half, one, zero),
                                                          select(in.v > half, one, zero))
                                                   .normal;
                                           })};
                },
                s);
        return when(
            !(own | of_owner), [&] { return rim(in.u, in.v); }, s);
    }

    /// Of the patch's own net, on a spoke of another patch too.
    template <class T>
    SecondOrderFrame<T> second_order(ControlPoints<ControlVertex<T>> const& patch,
                                     DomainInput<T> const& in) const
    {
        return inside.second_order<T>(patch, in);
    }

private:
    // Edges and corners alone.
    struct Rim : CubicEdges<4> {
        static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
        static constexpr int kControlPoints = 12;
        template <class T>
        static constexpr TangentFrame<T> evaluate(auto const&, DomainInput<T> const&, bool)
        {
            float3<T> const zero(T(0), T(0), T(0));
            return {zero, zero, zero};
        }
    };
};

} // namespace tessemu
