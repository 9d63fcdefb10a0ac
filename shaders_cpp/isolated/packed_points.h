// Several control points packed into one output record of a hull shader, which has at most 32 of
// them: LOOP10 4.3.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/hull_shader.h"
#include "shaders_cpp/records.h"

namespace tessemu {

template <int K, class T> struct PackedPoints {
    static constexpr int kVectors = K;
    std::array<float3<T>, K> vectors;
    static constexpr auto signature() { return std::tuple{&PackedPoints::vectors}; }
};

/// Control point i is vector i % K of record i / K: as a patch of ControlVertices.
template <int K, class T> class UnpackedPoints {
public:
    constexpr explicit UnpackedPoints(ControlPoints<PackedPoints<K, T>> const& records)
        : records_(records)
    {
    }
    constexpr ControlVertex<T> operator[](int i) const { return {records_.vector(i / K, i % K)}; }

private:
    ControlPoints<PackedPoints<K, T>> const& records_;
};

/// A hull shader of rows, a StencilHullShader or one that derives from it, whose every thread makes
/// K control points. Its `points` are a multiple of K.
template <class Hull, int K> struct PackedHullShader : Hull {
    template <class T> using ControlPoint = PackedPoints<K, T>;
    template <class T> using Inputs = ControlPoints<ControlVertex<T>>;

    int control_points() const { return this->points / K; }

    /// \cost  that of K rows
    template <class T>
    PackedPoints<K, T> control_point(PatchInput patch, Inputs<T> const& in, int_of<T> id) const
    {
        using Int = int_of<T>;
        PackedPoints<K, T> out;
        for (int k : loop<T>(K))
            out.vectors[std::size_t(k)] =
                this->rows.template point<T>(patch, in, id * Int(K) + Int(k));
        return out;
    }
    template <class T>
    std::array<T, 6> tess_factors(PatchInput patch, Inputs<T> const& in,
                                  ControlPoints<PackedPoints<K, T>> const& out,
                                  auto const& constants) const
    {
        return Hull::template tess_factors<T>(patch, in, UnpackedPoints<K, T>(out), constants);
    }
};

} // namespace tessemu
