// Displacement along the surface normal, closed across patches and texture seams (LOOP09 4.4, 4.5;
// docs/math/loop09.md, 9).
//
//     P' = P + scale h N
//
// P and N have equal bits on both sides of an edge. So has h: a height map on texture coordinates
// is read where the edge's or the corner's owner has it, in the edge's canonical direction, and the
// solid pattern depends on P alone.
//
// A sampler's weights have 8 bits, 256 steps from texel to texel, so the shader loads four texels
// and weighs them itself. Places in the map are counted in texels, as a whole number and a part, or
// the shader would lose the part's last bits: a single has 24, and a map may be 16,384 wide.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/memory.h"
#include "shaders_cpp/domain_edges.h"
#include "shaders_cpp/projection.h"

namespace tessemu {

/// What reaches the rasterizer of a displaced surface.
template <class T> struct DisplacedVertex {
    float4<T> position;    ///< SV_Position
    float3<T> normal;      ///< of the smooth surface, object space
    float3<T> base;        ///< the smooth surface's point, object space
    float2<T> coordinates; ///< of the patch itself in the height map, in texels
    static constexpr auto signature()
    {
        return std::tuple{&DisplacedVertex::position, &DisplacedVertex::normal,
                          &DisplacedVertex::base, &DisplacedVertex::coordinates};
    }
};

/// Slots from here on belong to the epilog of a surface's domain shader, those before to the
/// surface.
inline constexpr int kEpilogSlot = 64;

/// What lies beyond a height map's border: Direct3D's address modes WRAP, CLAMP and MIRROR.
enum class HeightWrap : std::uint8_t { Repeat, Clamp, Mirror };

/// A place in a height map: `whole` and `part` added, in texels from the first texel's centre, rows
/// from the top.
template <class T> struct TexelPlace {
    float2<T> whole, part;
    static constexpr auto signature() { return std::tuple{&TexelPlace::whole, &TexelPlace::part}; }
};

/// Heights, mostly in [0, 1].
struct HeightMap {
    static constexpr int kImageSlot = kEpilogSlot;

    Buffer<float> texels; ///< an R32_FLOAT texture, row by row; none: the solid pattern
    int width = 0, height = 0;
    HeightWrap wrap = HeightWrap::Repeat;
    float frequency = 1; ///< of the pattern, periods per unit of length

    bool is_image() const { return !texels.elements().empty(); }
    ResourceInfo info() const
    {
        ResourceInfo info = texels.info();
        info.kind = ResourceKind::Texture;
        return info;
    }

    /// \param base  the smooth surface's point
    template <class T> T operator()(float3<T> const& base, TexelPlace<T> const& place) const
    {
        return is_image() ? bilinear<T>(place) : studs<T>(base);
    }

private:
    /// \cost 4 fetches
    template <class T> T bilinear(TexelPlace<T> const& place) const
    {
        Routine<T> const here("height");
        T const left = floor(place.part.x), top = floor(place.part.y);
        T const fx = place.part.x - left, fy = place.part.y - top;
        T const i = place.whole.x + left, j = place.whole.y + top;
        int_of<T> const x0 = address<T>(i, width), x1 = address<T>(T(i + T(1)), width);
        int_of<T> const y0 = address<T>(j, height) * int_of<T>(width),
                        y1 = address<T>(T(j + T(1)), height) * int_of<T>(width);
        auto const between = [](T const& a, T const& b, T const& f) -> T {
            T const step = b - a;
            return a + f * step;
        };
        T const upper = between(load<T>(texels, y0 + x0), load<T>(texels, y0 + x1), fx);
        T const lower = between(load<T>(texels, y1 + x0), load<T>(texels, y1 + x1), fx);
        return between(upper, lower, fy);
    }

    /// A whole number as the number of a texel (R146): exact below 2^22, which bits beyond that a
    /// coordinate has not.
    template <class T> int_of<T> address(T x, int size) const
    {
        if (wrap != HeightWrap::Clamp) {
            float const period = float(wrap == HeightWrap::Mirror ? 2 * size : size);
            // Half a texel keeps the quotient off whole numbers, so its rounding does no harm.
            T const quotient = T(1 / period) * T(x + T(0.5));
            x = x - T(period) * floor(quotient);
        }
        if (wrap == HeightWrap::Mirror) x = min(x, T(T(float(2 * size - 1)) - x));
        x = min(max(x, T(0)), T(float(size - 1)));
        return asuint(T(x + T(0x1p23f))) & int_of<T>(0x7fffff);
    }

    /// Studs on a cubic lattice: (b(x) b(y) + b(y) b(z) + b(z) b(x)) / 3 with a bump of one period
    /// b(x) = 16 f^2 (1 - f)^2, f the fraction of x; once differentiable.
    template <class T> T studs(float3<T> const& base) const
    {
        Routine<T> const here("studs");
        auto const bump = [&](T const& x) -> T {
            T const scaled = T(frequency) * x;
            T const f = scaled - floor(scaled);
            T const g = f * T(T(1) - f);
            return T(16) * T(g * g);
        };
        T const x = bump(base.x), y = bump(base.y), z = bump(base.z);
        return T(1.0 / 3) * T(x * y + y * z + z * x);
    }
};

/// Texture coordinates of faces' corners, in texels of the height map, and whose they are on shared
/// edges and at corners.
///
/// A corner of a face has four pairs: the face's own; those of the edge's owner at both ends of the
/// edge that starts there, in the edge's canonical direction; those of the vertex's owner. Of the
/// faces that meet there the owner is the one with the smallest number. They are parts, to be added
/// to the whole numbers of the face, the edge and the vertex (TexelPlace), which follow them. A
/// patch that is a part of its face looks up where its points lie in the face, so that parts meet
/// with equal bits too.
struct OwnedCoordinates {
    static constexpr int kPairs = 4, kWholes = 3;
    static constexpr int kFloats = 2 * (kPairs + kWholes);
    /// Bits of a patch's second word.
    static constexpr int kTurns = 3;     ///< how often the patch is turned against the face
    static constexpr int kReversed = 2;  ///< shift: bit k, edge k runs against its canonical one
    static constexpr int kHalves = 64;   ///< the quad at an n-gon's corner: edges 0, 3 are halves
    static constexpr int kFlipped = 128; ///< a triangle's cell is upside down
    static constexpr int kLevel = 8;     ///< shift: the patch has a side of 2^-level of the face's
    static constexpr int kCell = 16;     ///< shift: its cell, row by row

    Buffer<float> corners;         ///< [face corner][kPairs + kWholes][2]
    Buffer<std::uint32_t> patches; ///< [primitive][2]: the face's first corner; the bits above
    int sides = 4;

    template <class T> struct Pair {
        TexelPlace<T> own, owner;
    };
    /// At (u, v) of the patch. \cost inside a quad 10 mul, 10 fetches
    template <class T> Pair<T> operator()(DomainInput<T> const& in) const
    {
        Routine<T> const here("owned_coordinates");
        std::int32_t const first = load<T>(patches, 2 * in.primitive_id);
        std::int32_t const word = load<T>(patches, 2 * in.primitive_id + 1);
        int const level = word >> kLevel & 255;
        if (level == 0 && !(word & kHalves)) return in_face<T>(first, word, in.u, in.v);
        // Turned into the face's frame, then into the patch's cell: all of it exact.
        int const turns = word & kTurns, cell = word >> kCell & 0xffff;
        T const U = T(1) - in.u, V = T(1) - in.v;
        T u = turns == 0 ? in.u : turns == 1 ? V : turns == 2 ? U : in.v;
        T v = turns == 0 ? in.v : turns == 1 ? in.u : turns == 2 ? V : U;
        if (sides == 3) {
            T const w = U - in.v;
            u = turns == 0 ? in.u : turns == 1 ? w : in.v;
            v = turns == 0 ? in.v : turns == 1 ? in.u : w;
            if (word & kFlipped) u = T(1) - u, v = T(1) - v;
        }
        T const size(1.0f / float(1 << level));
        return in_face<T>(first, word & ~kTurns, size * T(T(float(cell & ((1 << level) - 1))) + u),
                          size * T(T(float(cell >> level)) + v));
    }

private:
    template <class T> Pair<T> in_face(std::int32_t first, std::int32_t word, T u, T v) const
    {
        auto const read = [&](int corner, int which) -> float2<T> {
            std::int32_t const at =
                kFloats * (first + (corner + (word & kTurns)) % sides) + 2 * which;
            return {load<T>(corners, at), load<T>(corners, at + 1)};
        };
        // The whole numbers behind the pairs: of the face, of an edge, of a vertex.
        auto const place = [&](int corner, int which, float2<T> const& part) -> TexelPlace<T> {
            return {read(corner, kPairs + which), part};
        };
        float2<T> const c0 = read(0, 0), c1 = read(1, 0), c2 = read(2, 0);
        T const U = T(1) - u, V = T(1) - v, w = U - v;
        Pair<T> r;
        if (sides == 4) {
            float2<T> const bottom = U * c0 + u * c1, top = U * read(3, 0) + u * c2;
            r.own = place(0, 0, V * bottom + v * top);
        } else {
            r.own = place(0, 0, u * c0 + v * c1 + w * c2);
        }
        r.owner = r.own;
        DomainEdges<4, T> at = domain_edges<T>(sides, u, v, w, U, V);
        if (word & kHalves) {
            at.t[0] = T(0.5) * at.t[0];
            at.t[3] = T(0.5) + T(T(0.5) * at.t[3]);
        }
        for (int k : loop<T>(sides))
            r.owner = when(
                at.on[k],
                [&] {
                    bool const reversed = word >> (kReversed + k) & 1;
                    return place(
                        k, 1,
                        on_edge<T>(read(k, 1), read(k, 2), reversed ? T(T(1) - at.t[k]) : at.t[k]));
                },
                r.owner);
        for (int k : loop<T>(sides)) {
            mask_of<T> const corner = at.on[k] & at.on[(k + sides - 1) % sides];
            r.owner = when(
                corner, [&] { return place(k, 2, read(k, 3)); }, r.owner);
        }
        return r;
    }

    /// The same routine from both sides of an edge, whatever the patches' shapes.
    template <class T> static float2<T> on_edge(float2<T> const& first, float2<T> const& last, T s)
    {
        Routine<T> const here("edge_coordinates");
        return float2<T>(T(T(1) - s) * first + s * last);
    }
};

/// The epilog of a displaced surface.
struct DisplacementEpilog {
    template <class T> using Input = SurfacePoint<T>;
    template <class T> using Output = DisplacedVertex<T>;

    HeightMap height;
    float scale = 0; ///< displacement where the height is 1, object space
    OwnedCoordinates coordinates;
    Matrix4 view_projection = kIdentity;

    std::vector<ResourceInfo> resources() const
    {
        if (!height.is_image()) return {};
        return {height.info(), coordinates.corners.info(), coordinates.patches.info()};
    }

    template <class T>
    DisplacedVertex<T> operator()(DomainInput<T> const& in, SurfacePoint<T> const& s) const
    {
        float2<T> own(T(0), T(0));
        TexelPlace<T> owner{own, own};
        if (height.is_image()) {
            OwnedCoordinates::Pair<T> const c = coordinates.template operator()<T>(in);
            own = c.own.whole + c.own.part;
            owner = c.owner;
        }
        T const h = T(scale) * height.template operator()<T>(s.position, owner);
        float3<T> const displaced = s.position + h * s.normal;
        return {transform(view_projection, displaced), s.normal, s.position, own};
    }
};

/// Attributes of a displaced surface that its pixel shaders read.
template <class T> struct DisplacedAttributes {
    float3<T> normal, base;
    float2<T> coordinates;
    static constexpr auto signature()
    {
        return std::tuple{&DisplacedAttributes::normal, &DisplacedAttributes::base,
                          &DisplacedAttributes::coordinates};
    }
};

} // namespace tessemu
