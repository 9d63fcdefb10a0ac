// The draw that shows the tessellated patches: an instance a patch, whose vertices are texels of
// the targets that the two passes filled. Direct3D 11 cannot bind a texture as a vertex buffer, so
// the vertex shader loads by SV_VertexID; the paper sent targets round through the CPU.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/texture.h"
#include "emu/vertex_shader.h"
#include "shaders_cpp/displacement.h"
#include "shaders_cpp/pole_normals.h"

namespace tessemu {

/// What the draw knows of a patch.
struct TablePatchWords {
    static constexpr std::uint32_t kNone = 0xffffffffu;
    static constexpr int kX = 0, kY = 1; ///< its texel of vertex (0,0)
    static constexpr int kCorner = 2;    ///< its corner's normal
    static constexpr int kPole = 3;      ///< [4]: the pole at a corner, or kNone
    static constexpr int kShared = 7;    ///< its corner's shared normal, or kNone
    static constexpr int kAcross = 8;    ///< [2][3]: of the patch beyond edges 0 and 3, where they
                                         ///< are infinitely sharp, its texel of (0,0) and its
                                         ///< segments; else kNone
    static constexpr int kCount = 14;
};

/// Vertices of a surface.
///
/// Points on a patch's edges have equal bits from both sides: texels are sums in one order. The
/// normal at the patch's own corner is the corner's, at a pole that of the pole and along an edge
/// between two vertices of one pole too. On an infinitely sharp edge each side has its own; where
/// the surface is displaced such points move along the mean of both sides' unit normals.
///
/// \tparam Epilog  ProjectionEpilog or DisplacementEpilog
template <class Epilog> struct TableVertexShader {
    template <class T> struct Input { // SV_VertexID and SV_InstanceID are all that there is
        static constexpr auto signature() { return std::tuple{}; }
    };
    template <class T> using Output = typename Epilog::template Output<T>;

    Texture2D positions, normals; ///< the targets
    Buffer<float> corner_normals; ///< of CornerNormalShader
    Buffer<float> shared_normals; ///< of SharedNormalShader
    PoleNormals poles;
    Buffer<std::uint32_t> patches; ///< [patch][TablePatchWords]
    Buffer<std::uint32_t> places;  ///< [vertex]: x + (y << 8); none: row after row
    int level = 0;                 ///< 2^level segments along an edge
    bool has_poles = false, has_creases = false;
    std::array<float, 3> origin{}; ///< of the positions' target
    Epilog epilog;

    std::vector<ResourceInfo> resources() const
    {
        std::vector<ResourceInfo> out{positions.info(), normals.info(), corner_normals.info(),
                                      patches.info()};
        if (has_creases) out.push_back(shared_normals.info());
        if (!places.elements().empty()) out.push_back(places.info());
        poles.add_to(out);
        for (ResourceInfo& r : resources_of(epilog)) out.push_back(std::move(r));
        return out;
    }

    template <class T> Output<T> operator()(VertexInput<T> const& in, Input<T> const&) const
    {
        using Int = int_of<T>;
        auto const [x, y] = place<T>(in.vertex_id);
        std::int32_t const patch = in.instance_id;
        Int const i = x + Int(word<T>(patch, TablePatchWords::kX)),
                  j = y + Int(word<T>(patch, TablePatchWords::kY));
        float4<T> const p = load<T>(positions, i, j);
        Normal<T> const n = normal<T>(patch, x, y, i, j);
        T const step(1.0f / float(1 << level));
        DomainInput<T> const at{T(T(x) * step), T(T(y) * step), T(0), patch};
        float3<T> position(p.x, p.y, p.z);
        if (origin != std::array<float, 3>{})
            position = position + float3<T>(T(origin[0]), T(origin[1]), T(origin[2]));
        if constexpr (requires { epilog.height; }) {
            float3<T> const moving = moving_normal<T>(patch, x, y, n);
            Routine<T> const here("table_epilog"); // whatever was skipped for this patch
            Output<T> out = epilog(at, SurfacePoint<T>{position, moving});
            out.normal = n.unit;
            return out;
        } else {
            Routine<T> const here("table_epilog");
            return epilog(at, SurfacePoint<T>{position, n.unit});
        }
    }

private:
    template <class T> std::pair<int_of<T>, int_of<T>> place(int_of<T> vertex) const
    {
        using Int = int_of<T>;
        if (!places.elements().empty()) {
            Int const at = Int(load<T>(places, vertex));
            return {at & Int(255), at >> Int(8)};
        }
        int const side = (1 << level) + 1;
        Int const row =
            (vertex * Int((1 << 16) / side + 1)) >> Int(16); // vertex / side, below 2^11
        return {vertex - row * Int(side), row};
    }
    template <class T> std::int32_t word(std::int32_t patch, int which) const
    {
        return load<T>(patches, patch * TablePatchWords::kCount + which);
    }
    template <class T> static float3<T> load_vector(Buffer<float> const& from, std::int32_t vector)
    {
        return {load<T>(from, 3 * vector), load<T>(from, 3 * vector + 1),
                load<T>(from, 3 * vector + 2)};
    }

    template <class T> struct Normal {
        float3<T> unit;
        mask_of<T> is_pole;  ///< the same from all sides
        float3<T> direction; ///< as the target has it, of any length
    };

    /// \param x, y  the vertex in its patch
    /// \param i, j  its texel
    template <class T>
    Normal<T> normal(std::int32_t patch, int_of<T> x, int_of<T> y, int_of<T> i, int_of<T> j) const
    {
        using Int = int_of<T>;
        Int const last(1 << level);
        float4<T> const texel = load<T>(normals, i, j);
        float3<T> direction(texel.x, texel.y, texel.z);
        // Where there is none: on edges from the corner its own, which both patches have; on the
        // others, and beyond, z.
        float3<T> const z(T(0), T(0), T(1));
        float3<T> const of_corner =
            load_vector<T>(corner_normals, word<T>(patch, TablePatchWords::kCorner));
        mask_of<T> const far = (x == last) | (y == last);
        float3<T> otherwise = select(far, z, of_corner);
        mask_of<T> is_pole = x < Int(0);
        if (has_poles) is_pole = at_poles<T>(patch, x, y, otherwise);
        mask_of<T> const at_corner = (x == Int(0)) & (y == Int(0));
        otherwise = select(at_corner, of_corner, otherwise);
        direction = select(at_corner | is_pole, float3<T>(T(0), T(0), T(0)), direction);
        // Of products that are 0 the sign depends on the patch: + 0 makes it +.
        float3<T> const zero(T(0), T(0), T(0));
        return {unit_or(direction, [&] { return otherwise; }) + zero, is_pole,
                float3<T>(texel.x, texel.y, texel.z)};
    }

    /// The points that have a pole's normal: corners that are one, edges between two that are the
    /// same one.
    template <class T>
    mask_of<T> at_poles(std::int32_t patch, int_of<T> x, int_of<T> y, float3<T>& normal) const
    {
        using Int = int_of<T>;
        Int const last(1 << level), first(0);
        mask_of<T> const on[4] = {y == first, x == last, y == last, x == first};
        mask_of<T> out = x < first;
        auto const take = [&](std::int32_t pole, mask_of<T> here) {
            normal =
                select(here, poles.vector<T>(Int(pole), Int(PoleNormalShader::kNormal)), normal);
            out = out | here;
        };
        std::int32_t pole[4];
        for (int k = 0; k < 4; ++k) pole[k] = word<T>(patch, TablePatchWords::kPole + k);
        for (int k = 0; k < 4; ++k) {
            if (pole[k] == std::int32_t(TablePatchWords::kNone)) continue;
            take(pole[k], on[k] & on[(k + 3) % 4]);
            if (pole[k] == pole[(k + 1) % 4]) take(pole[k], on[k]);
        }
        return out;
    }

    /// What the surface is displaced along.
    template <class T>
    float3<T> moving_normal(std::int32_t patch, int_of<T> x, int_of<T> y,
                            Normal<T> const& normal) const
    {
        using Int = int_of<T>;
        float3<T> const& n = normal.unit;
        if (!has_creases) return n;
        float3<T> out = n;
        auto const none = std::int32_t(TablePatchWords::kNone);
        for (int edge = 0; edge < 2; ++edge) { // edge 0, which lies along x, and edge 3
            int const first = TablePatchWords::kAcross + 3 * edge;
            std::int32_t const column = word<T>(patch, first);
            if (column == none) continue;
            std::int32_t const row = word<T>(patch, first + 1),
                               segments = word<T>(patch, first + 2);
            // The other patch has the edge as its other one; its vertices are the same or finer.
            Int const along = ((edge == 0 ? x : y) * Int(segments)) >> Int(level);
            mask_of<T> const here = ((edge == 0 ? y : x) == Int(0)) & !normal.is_pole;
            out = when(
                here,
                [&]() -> float3<T> {
                    float4<T> const texel = edge == 0
                                                ? load<T>(normals, Int(column), Int(row) + along)
                                                : load<T>(normals, Int(column) + along, Int(row));
                    float3<T> const own = unit_or_zero(normal.direction),
                                    other = unit_or_zero(float3<T>(texel.x, texel.y, texel.z)),
                                    zero(T(0), T(0), T(0)), z(T(0), T(0), T(1));
                    // The side whose edge 0 it is first: both choose alike where they cancel.
                    float3<T> const a = edge == 0 ? own : other, b = edge == 0 ? other : own;
                    float3<T> const sum = a + b;
                    return unit_or(sum, [&] { return unit_or(a, [&] { return z; }); }) + zero;
                },
                out);
        }
        // At the corner that of all sides, or the only one's.
        std::int32_t const shared = word<T>(patch, TablePatchWords::kShared);
        float3<T> const at_corner = shared == none ? n : load_vector<T>(shared_normals, shared);
        return select((x == Int(0)) & (y == Int(0)), at_corner, out);
    }
};

} // namespace tessemu
