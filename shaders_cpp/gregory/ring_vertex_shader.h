// Vertex shader of Gregory patches in the two-stage form, LOOP09 section 4.1.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/gregory/gregory_ring.h"

namespace tessemu {

/// \tparam Weight  float; double in tests of the formulas
template <class Weight = float> struct RingVertexShader : GregoryRing<RingLayout::kEdges, Weight> {
    using Ring = GregoryRing<RingLayout::kEdges, Weight>;
    template <class T> using Input = ControlVertex<T>;
    template <class T> using Output = RingVertex<T>;

    /// \cost  that of GregoryRing::vertex; reads 2 ring words
    template <class T>
    RingVertex<T> operator()(VertexInput<T> const& in, ControlVertex<T> const& stream) const
    {
        using Int = int_of<T>;
        auto const at = Ring::template ring<T>(in.vertex_id);
        Int const row = (at.n + select(at.boundary, Int(RingRows::kBoundary), Int(0))) *
                        Int(RingConstants::kRow);
        constexpr std::integral_constant<int, RingLayout::kEdges> kTurns;
        return Ring::template vertex<RingVertex<T>>(at, stream.position, row, kTurns, EveryEdge{});
    }

private:
    struct EveryEdge {
        template <class T> void edge(RingVertex<T>& out, int j, float3<T> const& e) const
        {
            out.vectors[std::size_t(RingLayout::kE + j)] = e;
        }
        template <class T> void second(RingVertex<T>& out, int j, float3<T> const& r) const
        {
            out.vectors[std::size_t(RingLayout::kSecond + j)] = r;
        }
    };
};

} // namespace tessemu
