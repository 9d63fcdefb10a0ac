// Shaders of schemes whose control points are the cage's own vertices with their normals: what
// comes before the domain shader.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/hull_shader.h"
#include "shaders_cpp/cage_form/cage_factors.h"
#include "shaders_cpp/skinning.h"

namespace tessemu {

/// A vertex of the cage: object space, the normal of unit length where it exists.
template <class T> struct NormalVertex {
    float3<T> position, normal;
    static constexpr auto signature()
    {
        return std::tuple{&NormalVertex::position, &NormalVertex::normal};
    }
};

/// The vertex as it is.
struct NormalVertexShader {
    template <class T> using Input = NormalVertex<T>;
    template <class T> using Output = NormalVertex<T>;
    template <class T>
    NormalVertex<T> operator()(VertexInput<T> const&, NormalVertex<T> const& vertex) const
    {
        return vertex;
    }
};

/// The vertex in a pose.
struct SkinnedNormalVertexShader {
    template <class T> using Input = NormalVertex<T>;
    template <class T> using Output = NormalVertex<T>;
    SkinBuffers skin;

    std::vector<ResourceInfo> resources() const
    {
        return {skin.vertices.info(), skin.bones.info()};
    }
    template <class T>
    NormalVertex<T> operator()(VertexInput<T> const& in, NormalVertex<T> const& vertex) const
    {
        float3<T> const position = skin.posed<T>(in.vertex_id, vertex.position);
        return {position, unit_or_zero(skin.turned<T>(in.vertex_id, vertex.normal))};
    }
};

/// Hands control points on; the factors are those of straight edges between them.
template <TessellatorDomain kDomain_> struct CageHullShader {
    static constexpr TessellatorDomain kDomain = kDomain_;
    static constexpr int kSides = sides_of(kDomain);
    template <class T> using Input = NormalVertex<T>;
    template <class T> using ControlPoint = NormalVertex<T>;
    template <class T> using PatchConstant = ControlVertex<T>; // none
    template <class T> using Points = ControlPoints<NormalVertex<T>>;

    TessFactorRule factors;
    bool face_normals = false; ///< of all corners, in place of their vertices'

    int control_points() const { return kSides; }
    int patch_constants() const { return 0; }
    template <class T>
    NormalVertex<T> control_point(PatchInput, Points<T> const& in, int_of<T> id) const
    {
        NormalVertex<T> vertex = in[id];
        if (face_normals) vertex.normal = face_normal<T>(in);
        return vertex;
    }
    template <class T>
    ControlVertex<T> patch_constant(PatchInput, Points<T> const&, Points<T> const&, int_of<T>) const
    {
        return {};
    }
    template <class T>
    std::array<T, 6> tess_factors(PatchInput, Points<T> const&, Points<T> const& out,
                                  ControlPoints<ControlVertex<T>> const&) const
    {
        return cage_factors<kDomain, T>(factors, [&](int k) { return out[k].position; });
    }

private:
    /// Along twice the face's area; z where it has none.
    template <class T> static float3<T> face_normal(Points<T> const& in)
    {
        using V = float3<T>;
        V const a = in[0].position, b = in[1].position, c = in[2].position,
                d = in[3 % kSides].position;
        return unit_or(cross(V(c - a), V(d - b)), [] { return V(T(0), T(0), T(1)); });
    }
};

} // namespace tessemu
