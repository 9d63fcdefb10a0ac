// A patch of a subdivision surface from tables of basis functions (HOLL10 2C).
//
//     p(u,v) = sum_i B_i(u,v) p_i,   n(u,v) = sum_i B_i(u,v) n_i / |...|
//
// over the vertices of the patch and around it: positions and normals of the mesh after the initial
// step, summed by the same weights (subdivision shading with one normalisation). They come from
// buffers by SV_PrimitiveID, not as control points: a patch may have more than 32.
//
// Shared points have equal bits from both sides under any contraction: weights on a side are equal
// in both patches' tables, vertices come in one order for the whole mesh, and those that only one
// patch has weigh 0 there.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_shader.h"
#include "emu/hull_shader.h"
#include "emu/listed_sums.h"
#include "emu/vertex_shader.h"
#include "shaders_cpp/cage_form/cage_factors.h"
#include "shaders_cpp/table_term.h"
#include "shaders_cpp/tables/table_samples.h"
#include "shaders_cpp/tables/table_vertices_shader.h"

namespace tessemu {

/// Of something at a point's samples. Named products: no sum is fused with one. On a side two of them
/// are not 0.
template <int n, class T, class Of> auto weighted_sum(TablePlace<T, n> const& place, Of const& of)
{
    using X = std::remove_cvref_t<decltype(of(0))>;
    X sum = X(place.weight[0] * of(0));
    for (int i = 1; i < n; ++i) {
        X const term = place.weight[i] * of(i);
        sum = sum + term;
    }
    return sum;
}

/// What patches read.
struct TableBuffers {
    Buffer<std::uint32_t> patches; ///< [patch][3]: its first point, points, the first table entry
    Buffer<std::uint32_t> points;  ///< [point][2]: vertex; column of the tables
    Buffer<float> vertices;        ///< [vertex][TableVertices::kFloats]
    Buffer<float> tables;          ///< [type][column][sample]
    int samples = 0;               ///< of a table

    std::vector<ResourceInfo> resources() const
    {
        return {patches.info(), points.info(), vertices.info(), tables.info()};
    }

    struct List {
        std::int32_t first, count; ///< points
        std::int32_t table;        ///< where the patch's tables begin
    };
    template <class T> List list(std::int32_t patch) const
    {
        auto const word = [&](int k) { return load<T>(patches, 3 * patch + k); };
        std::int32_t const first = word(0), count = word(1), table = word(2);
        return {first, count, table};
    }
    /// work(vertex, where the point's table begins) for each point of a patch.
    template <class T, class Work> void for_each_point(List const& list, Work const& work) const
    {
        for (int k : loop<T>(list.count)) {
            std::int32_t const vertex = load<T>(points, 2 * (list.first + k)),
                               column = load<T>(points, 2 * (list.first + k) + 1);
            work(vertex, int_of<T>(list.table + column * samples));
        }
    }
    template <class T, int n>
    T weight_at(Buffer<float> const& of, int_of<T> const& table,
                TablePlace<T, n> const& place) const
    {
        auto const at = [&](int i) -> T { return load<T>(of, table + place.sample[i]); };
        if constexpr (n == 1) {
            return at(0);
        } else {
            return weighted_sum<n>(place, at);
        }
    }
    /// The same sums by the fast machine; false where it leaves them to the text.
    template <class T, int n>
    bool sum_at_once(List const& of, TablePlace<T, n> const& place, float3<T>& position,
                     float3<T>& normal) const
    {
        constexpr int N = lanes_of<T>, K = TableVertices::kFloats;
        if constexpr (std::same_as<T, FastLanes<N>>) {
            ListedSums<N, n> sums{points,  of.first, of.count, tables, of.table,
                                  samples, vertices, {},       {}};
            for (int i = 0; i < n; ++i)
                sums.sample[i] = place.sample[i], sums.weight[i] = place.weight[i].value;
            if (auto const s = sum_listed<K>(sums)) {
                position = {(*s)[0], (*s)[1], (*s)[2]};
                normal = {(*s)[3], (*s)[4], (*s)[5]};
                return true;
            }
        }
        return false;
    }
    /// Position (0) or normal (3) of a vertex.
    template <class T> float3<T> vector(std::int32_t vertex, int first) const
    {
        std::int32_t const at = vertex * TableVertices::kFloats + first;
        return {load<T>(vertices, at), load<T>(vertices, at + 1), load<T>(vertices, at + 2)};
    }
};

/// A point with subdivision shading: normals summed as positions are, and scaled.
struct TablePatch {
    TableBuffers buffers;

    std::vector<ResourceInfo> resources() const { return buffers.resources(); }

    /// \param place  of the point among the samples
    /// \cost  a point of the patch: 6 mul, 6 add, 9 fetches; of three samples 3 mul, 2 add and 2
    ///        fetches more
    template <class T, int n>
    SurfacePoint<T> operator()(std::int32_t patch, TablePlace<T, n> const& place) const
    {
        float3<T> position(T(0), T(0), T(0)), normal = position;
        TableBuffers::List const list = buffers.list<T>(patch);
        if (!buffers.sum_at_once(list, place, position, normal))
            buffers.for_each_point<T>(list, [&](std::int32_t vertex, int_of<T> const& table) {
                T const weight = buffers.weight_at<T>(buffers.tables, table, place);
                position = add_term(position, weight, buffers.vector<T>(vertex, 0));
                normal = add_term(normal, weight, buffers.vector<T>(vertex, 3));
            });
        // Opposite normals cancel in between: there is z, the same from all sides.
        return {position, unit_or(normal, [] { return float3<T>(T(0), T(0), T(1)); })};
    }
};

/// Of two tangents. A routine: the patches of an edge have its samples in different places.
template <class T> float3<T> sample_normal(float3<T> const& a, float3<T> const& b)
{
    Routine<T> const here("sample_normal");
    return unit_or(float3<T>(cross(a, b)), [] { return float3<T>(T(0), T(0), T(1)); });
}

/// The same with the geometric normals of samples, from tables of two tangents whose cross product
/// points outwards; linear between samples, and scaled. At the patch's corners, where tangents are
/// the patches' own, those of the vertices.
/// \tparam kCorners  Samples::kCorners
template <int kCorners> struct TangentTablePatch {
    TableBuffers buffers;
    std::array<Buffer<float>, 2> tangents; ///< as TableBuffers::tables
    Buffer<std::uint32_t> corners;         ///< [patch][kCorners]: a vertex
    Buffer<float> corner_normals;          ///< [vertex][3]
    std::array<int, kCorners> corner_samples{};

    std::vector<ResourceInfo> resources() const
    {
        std::vector<ResourceInfo> out = buffers.resources();
        for (Buffer<float> const& t : tangents) out.push_back(t.info());
        out.push_back(corners.info());
        out.push_back(corner_normals.info());
        return out;
    }

    /// \cost  a point of the patch: 9 mul, 9 add, 8 fetches; of three samples 15 mul, 14 add and 6
    ///        fetches more
    template <class T, int n>
    SurfacePoint<T> operator()(std::int32_t patch, TablePlace<T, n> const& place) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        V const zero(T(0), T(0), T(0)), z(T(0), T(0), T(1));
        V position = zero, sums[n][2];
        for (auto& s : sums) s[0] = s[1] = zero;
        TableBuffers::List const list = buffers.list<T>(patch);
        buffers.for_each_point<T>(list, [&](std::int32_t vertex, Int const& table) {
            V const p = buffers.vector<T>(vertex, 0);
            position = add_term(position, buffers.weight_at<T>(buffers.tables, table, place), p);
            for (int i = 0; i < n; ++i)
                for (int k = 0; k < 2; ++k)
                    sums[i][k] = add_term(
                        sums[i][k], load<T>(tangents[std::size_t(k)], table + place.sample[i]), p);
        });
        V normals[n];
        for (int i = 0; i < n; ++i) normals[i] = sample_normal(sums[i][0], sums[i][1]);
        for (int c = 0; c < kCorners; ++c) {
            std::int32_t const at = 3 * load<T>(corners, kCorners * patch + c);
            V const corner(load<T>(corner_normals, at), load<T>(corner_normals, at + 1),
                           load<T>(corner_normals, at + 2));
            for (int i = 0; i < n; ++i)
                normals[i] = select(place.sample[i] == Int(corner_samples[std::size_t(c)]), corner,
                                    normals[i]);
        }
        V normal = normals[0];
        if constexpr (n > 1) {
            V const sum = weighted_sum<n>(place, [&](int i) -> V const& { return normals[i]; });
            normal = unit_or(sum, [&] { return z; });
        }
        return {position, normal + zero}; // -0 is 0
    }
};

/// Factors of the straight edges between a patch's corners; no control points at all.
template <TessellatorDomain kDomain_> struct TableHullShader {
    static constexpr TessellatorDomain kDomain = kDomain_;
    template <class T> using Input = ControlVertex<T>;
    template <class T> using ControlPoint = ControlVertex<T>;
    template <class T> using PatchConstant = ControlVertex<T>; // none
    template <class T> using Points = ControlPoints<ControlVertex<T>>;

    TessFactorRule factors;

    int control_points() const { return 0; }
    int patch_constants() const { return 0; }
    template <class T> ControlVertex<T> control_point(PatchInput, Points<T> const&, int_of<T>) const
    {
        return {};
    }
    template <class T>
    ControlVertex<T> patch_constant(PatchInput, Points<T> const&, Points<T> const&, int_of<T>) const
    {
        return {};
    }
    template <class T>
    std::array<T, 6> tess_factors(PatchInput, Points<T> const& in, Points<T> const&,
                                  Points<T> const&) const
    {
        return cage_factors<kDomain, T>(factors, [&](int k) { return in[k].position; });
    }
};

/// On the tessellator's points.
/// \tparam Samples  TriangleSamples or QuadSamples
/// \tparam Patch    TablePatch or TangentTablePatch
template <class Samples, class Patch> struct TableDomainShader {
    static constexpr TessellatorDomain kDomain = Samples::kDomain;
    template <class T> using ControlPoint = ControlVertex<T>; // none
    template <class T> using PatchConstant = ControlVertex<T>;
    template <class T> using Output = SurfacePoint<T>;

    Patch patch;
    Samples samples;

    std::vector<ResourceInfo> resources() const { return patch.resources(); }
    template <class T>
    SurfacePoint<T> operator()(DomainInput<T> const& in, ControlPoints<ControlVertex<T>> const&,
                               ControlPoints<ControlVertex<T>> const&) const
    {
        return patch(in.primitive_id, samples.template between<T>(in));
    }
};

/// On a refinement pattern: an instance a patch, whose vertices bring u and v, multiples of
/// 1/segments (HOLL10's reference [9]).
template <class Samples, class Patch, class Epilog> struct TablePatternVertexShader {
    template <class T> struct Input {
        T u, v;
        static constexpr auto signature() { return std::tuple{&Input::u, &Input::v}; }
    };
    template <class T> using Output = typename Epilog::template Output<T>;

    Patch patch;
    Samples samples;
    Epilog epilog;

    std::vector<ResourceInfo> resources() const
    {
        std::vector<ResourceInfo> out = patch.resources();
        for (ResourceInfo& r : resources_of(epilog)) out.push_back(std::move(r));
        return out;
    }
    template <class T> Output<T> operator()(VertexInput<T> const& in, Input<T> const& p) const
    {
        DomainInput<T> const at{p.u, p.v, T(T(1) - p.u - p.v), in.instance_id};
        return epilog(at, patch(in.instance_id, samples.template at<T>(at)));
    }
};

} // namespace tessemu
