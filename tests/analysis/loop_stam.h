// Stam and Loop's quad/triangle subdivision (2003), HOLL10's reference [4], without its correction
// of curvature: a scheme behind tables as one file of masks.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/limit_points.h"
#include "pipeline/mesh/refined_step.h"

namespace tessemu::test {

/// Of an edge each end weighs 3/8 and each side 1/8, a triangle's opposite vertex or a quad's two.
/// A vertex with n edges e and m quads f, split in the middles first and then smoothed:
///
///     a v + a/2 sum (v + e)/2 + a/4 sum mean(f),   1/a = 1 + n/2 + m/4
///
/// Catmull-Clark's where all is quads and n = 4, Loop's where all is triangles and n = 6.
struct LoopStam {
    static constexpr bool kKeepsTriangles = true, kSectorRules = false;
    static constexpr int kRings = 1;

    template <class X> static X face(X const& sum, int sides) { return sum / double(sides); }

    template <class X> static X edge_point(Topology const& t, HalfEdge h, std::span<X const> x)
    {
        X const ends = x[t.vertex_of(h)] + x[t.vertex_of(t.next(h))];
        HalfEdge const twin = t.twin(h);
        if (twin == Topology::kNone) return ends / 2.0;
        X out = ends * 0.375;
        for (HalfEdge side : {h, twin}) {
            HalfEdge const across = t.next(t.next(side));
            if (t.next(across) == side)
                out += x[t.vertex_of(across)] / 8.0;
            else
                out += (x[t.vertex_of(across)] + x[t.vertex_of(t.next(across))]) / 16.0;
        }
        return out;
    }

    template <class X>
    static X vertex_point(Topology const& t, std::uint32_t v, std::span<X const> x)
    {
        auto const ring = t.ring(v);
        if (t.is_boundary(v))
            return (x[t.vertex_of(t.next(ring.front()))] + 6.0 * x[v] +
                    x[t.vertex_of(t.previous(ring.back()))]) /
                   8.0;
        double weight = 1;
        X out = 1.0 * x[v];
        for (HalfEdge h : ring) {
            out += 0.25 * (x[v] + x[t.vertex_of(t.next(h))]);
            weight += 0.5;
            auto const face = t.mesh().face(t.face_of(h));
            if (face.size() == 3) continue;
            X sum = x[face[0]];
            for (std::size_t i = 1; i < face.size(); ++i) sum += x[face[i]];
            out += 0.25 / double(face.size()) * sum;
            weight += 0.25;
        }
        return out / weight;
    }

    /// By steps of the faces around: the rings become alike, smaller by half each time.
    template <class X>
    static X limit_point(Topology const& t, std::uint32_t v, std::span<X const> x)
    {
        ControlMesh fan; // vertex 0, then the others by first occurrence
        std::vector<std::uint32_t> of{v};
        for (HalfEdge h : t.ring(v)) {
            std::vector<std::uint32_t> face;
            HalfEdge k = h;
            do {
                auto const at = std::find(of.begin(), of.end(), t.vertex_of(k));
                face.push_back(std::uint32_t(at - of.begin()));
                if (at == of.end()) of.push_back(t.vertex_of(k));
                k = t.next(k);
            } while (k != h);
            fan.add_face(face);
        }
        fan.positions.resize(of.size());
        Topology const around(fan);
        PointNumbers const number(around, kKeepsTriangles);
        std::vector<X> points, next;
        for (std::uint32_t w : of) points.push_back(x[w]);
        constexpr int kSteps = 60; // 0.6^60 = 5e-14
        for (int step = 0; step < kSteps; ++step) {
            next = points;
            next[0] = vertex_point(around, 0, std::span<X const>(points));
            for (HalfEdge h : around.ring(0)) {
                HalfEdge const before = around.previous(h), across = around.next(around.next(h));
                auto const place = [&](HalfEdge to) -> X& { return next[around.vertex_of(to)]; };
                place(around.next(h)) = edge_point(around, h, std::span<X const>(points));
                place(before) = edge_point(around, before, std::span<X const>(points));
                if (across == before) continue;
                X sum = points[0];
                for (HalfEdge k = around.next(h); k != h; k = around.next(k))
                    sum += points[around.vertex_of(k)];
                place(across) = face(sum, 4);
            }
            points = next;
        }
        return points[0];
    }
};

inline RefinedStep take_loop_stam_step(Topology const& topology, std::uint32_t first)
{
    return take_weighted_step<LoopStam>(topology, first);
}
inline constexpr LimitRules loop_stam_limits = limit_rules<LoopStam>;
inline constexpr RefinementStep loop_stam_step{take_loop_stam_step, true, "Loop-Stam",
                                               &loop_stam_limits};

} // namespace tessemu::test
