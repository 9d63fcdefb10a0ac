// Domain shaders of the two-stage form: the same evaluation on control points that arrive corner by
// corner.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/gregory/domain_shaders.h"
#include "shaders_cpp/gregory/sector_hull_shader.h"

namespace tessemu {

/// Sectors as a patch of control points p, e+, e-, f+, f-, each corner by corner.
template <int N, int kVectors, class T> class SectorPatch {
public:
    constexpr explicit SectorPatch(ControlPoints<SectorOf<kVectors, T>> const& sectors)
        : sectors_(sectors)
    {
    }
    constexpr ControlVertex<T> operator[](int i) const { return {sectors_.vector(i % N, i / N)}; }

private:
    ControlPoints<SectorOf<kVectors, T>> const& sectors_;
};

/// \tparam Inside    of the stencil form
/// \tparam kVectors  of a sector
template <class Inside, int kCount> struct InSectors {
    static constexpr TessellatorDomain kDomain = Inside::kDomain;
    static constexpr int kControlPoints = kDomain == TessellatorDomain::Quad ? 4 : 3;
    template <class T> using ControlPoint = SectorOf<kCount, T>;
    template <class T> using Sectors = ControlPoints<SectorOf<kCount, T>>;
    template <class T> using View = SectorPatch<kControlPoints, kCount, T>;

    template <class T>
    static constexpr TangentFrame<T> evaluate(Sectors<T> const& sectors, DomainInput<T> const& in,
                                              bool true_normals)
    {
        return Inside::template evaluate<T>(View<T>(sectors), in, true_normals);
    }
    template <class T> static constexpr EdgeCurve<T> edge(Sectors<T> const& sectors, int k)
    {
        return Inside::template edge<T>(View<T>(sectors), k);
    }
    template <class T> static constexpr float3<T> corner(Sectors<T> const& sectors, int i)
    {
        return Inside::template corner<T>(View<T>(sectors), i);
    }
    template <class T>
    static constexpr float3<T> corner_normal(ControlPoints<EdgeRegister<T>> const& registers, int i)
    {
        return registers[4 * kControlPoints + i].vector;
    }
};

using RegularSectorsDomainShader = WatertightPatch<InSectors<RegularQuadInside, 4>>;
using GregoryQuadSectorsDomainShader = WatertightPatch<InSectors<GregoryQuadInside, 5>>;
using GregoryTriangleSectorsDomainShader = WatertightPatch<InSectors<GregoryTriangleInside, 5>>;

} // namespace tessemu
