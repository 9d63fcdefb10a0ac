// Hull shader of Gregory patches in the two-stage form, LOOP09 section 4.2: an invocation for each
// corner of a patch assembles the corner's control points from what the vertex shader made of its
// vertices.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/two_stage_form/corner_tables.h"

namespace tessemu {

/// \tparam kDomain_   Quad or Tri
/// \tparam kVectors   of a corner: p, e+, e-, f+, f-; 4 in a regular patch, whose f- equals f+
template <TessellatorDomain kDomain_, int kVectors, class Weight = float>
struct CornerHullShader : CornerTables<kDomain_ == TessellatorDomain::Quad ? 4 : 3, Weight> {
    static constexpr TessellatorDomain kDomain = kDomain_;
    using Tables = CornerTables<kDomain_ == TessellatorDomain::Quad ? 4 : 3, Weight>;
    using Tables::kSides;
    template <class T> using Input = RingVertex<T>;
    template <class T> using ControlPoint = CornerVectors<kVectors, T>;
    template <class T> using PatchConstant = EdgeRegister<T>;

    int patch_constants() const { return 5 * kSides; }

    /// \cost  12 mul a face point
    template <class T>
    CornerVectors<kVectors, T>
    control_point(PatchInput patch, ControlPoints<RingVertex<T>> const& in, int_of<T> i) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        Int const next = Tables::template next<T>(i), previous = Tables::template previous<T>(i);
        auto const at = Tables::template corner<T>(patch, i);
        auto const after = Tables::template corner<T>(patch, next);
        T const C = Tables::template cosine<T>(at);
        V const p = in.vector(i, Int(RingLayout::kP));
        V const e_plus = in.vector(i, Int(RingLayout::kE) + at.plus);
        V const e_minus = in.vector(i, Int(RingLayout::kE) + at.minus);
        T const d(kSides == 4 ? 3.0 : 4.0), share(kSides == 4 ? 1.0 / 3 : 1.0 / 4);
        auto const face_point = [&](T c_other, V const& e, V const& e_other, V const& r) -> V {
            T const c2 = C + C;
            V const sum = c_other * p + T(d - c2 - c_other) * e + c2 * e_other + r;
            return share * sum;
        };
        CornerVectors<kVectors, T> out;
        out.vectors[CornerLayout::kP] = p;
        out.vectors[CornerLayout::kEPlus] = e_plus;
        out.vectors[CornerLayout::kEMinus] = e_minus;
        out.vectors[CornerLayout::kFPlus] =
            face_point(Tables::template cosine<T>(after), e_plus,
                       in.vector(next, Int(RingLayout::kE) + after.minus),
                       in.vector(i, Int(RingLayout::kSecond) + at.plus));
        if constexpr (kVectors == 5) {
            auto const before = Tables::template corner<T>(patch, previous);
            // r of the other edge is seen from its other side.
            out.vectors[CornerLayout::kFMinus] =
                face_point(Tables::template cosine<T>(before), e_minus,
                           in.vector(previous, Int(RingLayout::kE) + before.plus),
                           -in.vector(i, Int(RingLayout::kSecond) + at.minus));
        }
        return out;
    }

    /// Transversal fields of the edges in canonical direction, then the corners' normals.
    template <class T>
    EdgeRegister<T> patch_constant(PatchInput patch, ControlPoints<RingVertex<T>> const& in,
                                   ControlPoints<CornerVectors<kVectors, T>> const& corners,
                                   int_of<T> id) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        V const zero(T(0), T(0), T(0));
        auto const r = Tables::template field_register<T>(patch, id);
        mask_of<T> const end = (r.which == Int(0)) | (r.which == Int(3));
        V value = when(
            !r.on_edge, [&]() -> V { return Tables::template corner_normal<T>(patch, in, r); },
            zero);
        value = when(
            r.on_edge & !r.alone,
            [&]() -> V {
                auto const at = Tables::template corner<T>(patch, r.corner);
                Int const j = select(r.far, at.minus, at.plus);
                V const transversal = when(
                    !end, [&]() -> V { return in.vector(r.corner, Int(RingLayout::kSecond) + j); },
                    zero);
                return when(
                    end, [&]() -> V { return Tables::template across<T>(in, at, r.corner, j); },
                    transversal);
            },
            value);
        if constexpr (kVectors == 5) {
            // An edge with one patch: its own inward field.
            value = when(
                r.alone,
                [&]() -> V {
                    Int const from = select(
                        end, Int(CornerLayout::kP),
                        select(r.far, Int(CornerLayout::kEMinus), Int(CornerLayout::kEPlus)));
                    Int const to = select(
                        end, select(r.far, Int(CornerLayout::kEPlus), Int(CornerLayout::kEMinus)),
                        select(r.far, Int(CornerLayout::kFMinus), Int(CornerLayout::kFPlus)));
                    T const scale = select(end, T(3), T(kSides == 4 ? 3 : 4));
                    V const inward =
                        scale * V(corners.vector(r.corner, to) - corners.vector(r.corner, from));
                    return select(r.far, -inward, inward);
                },
                value);
        }
        return Tables::template packed<T>(r, value);
    }
};

} // namespace tessemu
