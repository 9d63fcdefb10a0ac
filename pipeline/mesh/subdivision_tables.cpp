// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/subdivision_tables.h"

#include "emu/compute_shader.h"
#include "pipeline/mesh/catmull_clark.h"

#include <algorithm>

namespace tessemu {

namespace {

// A point as a sum of weighted points of the buffer: what the masks blend where numbers will not
// do.
class Sum {
public:
    Sum() = default;
    explicit Sum(std::uint32_t point) : terms_{{point, 1}} {}

    struct Term {
        std::uint32_t point;
        double weight;
    };
    /// By ascending point, each once.
    std::vector<Term> terms() const
    {
        std::vector<Term> sorted = terms_, out;
        std::stable_sort(sorted.begin(), sorted.end(),
                         [](Term const& a, Term const& b) { return a.point < b.point; });
        for (Term const& t : sorted)
            if (!out.empty() && out.back().point == t.point)
                out.back().weight += t.weight;
            else
                out.push_back(t);
        return out;
    }

    Sum& operator+=(Sum const& o)
    {
        terms_.insert(terms_.end(), o.terms_.begin(), o.terms_.end());
        return *this;
    }
    Sum& operator*=(double s)
    {
        for (Term& t : terms_) t.weight *= s;
        return *this;
    }
    friend Sum operator+(Sum a, Sum const& b) { return a += b; }
    friend Sum operator*(Sum a, double s) { return a *= s; }
    friend Sum operator*(double s, Sum a) { return a *= s; }
    friend Sum operator/(Sum a, double s)
    {
        for (Term& t : a.terms_) t.weight /= s;
        return a;
    }

private:
    std::vector<Term> terms_;
};

class Builder {
public:
    Builder(Topology const& topology, Sharpness const& sharpness, SubdivisionTables& out)
        : topology_(topology),
          sharpness_(sharpness),
          out_(out)
    {
    }

    void add_faces(bool only_quads)
    {
        ControlMesh const& mesh = topology_.mesh();
        for (std::uint32_t v : mesh.face_vertices) out_.face_index.push_back(old(v));
        if (only_quads) return;
        for (std::uint32_t f = 0; f < out_.faces; ++f) {
            out_.face_offset_valence.push_back(mesh.face_start[f]);
            out_.face_offset_valence.push_back(std::uint32_t(mesh.face(f).size()));
        }
    }

    void add_edges(EdgeNumbers const& edges)
    {
        for (std::uint32_t e = 0; e < out_.edges; ++e) {
            HalfEdge const h = edges.first(e), other = topology_.twin(h);
            std::uint32_t const a = topology_.vertex_of(topology_.next(h)),
                                b = topology_.vertex_of(h);
            float const s = sharpness_.edge(h);
            double const w = s > 0 ? crease_weight(s, sharpness_.halves(h)) : 0;
            if (w == 1) {
                for (std::uint32_t end : {a, a, b, b}) out_.edge_index.push_back(old(end));
                continue;
            }
            std::uint32_t const f = topology_.face_of(h), g = topology_.face_of(other);
            for (std::uint32_t p : {old(a), face_point(f), old(b), face_point(g)})
                out_.edge_index.push_back(p);
            int const triangles = triangles_to_smooth(topology_, f, g);
            if (w == 0 && triangles == 0) continue;
            Sum point = CatmullClark::edge(Sum(old(a)), Sum(old(b)), Sum(face_point(f)),
                                           Sum(face_point(g)), triangles);
            if (w != 0)
                point = point * (1 - w) + CatmullClark::crease_edge(Sum(old(a)), Sum(old(b))) * w;
            add_blended(out_.first_edge_point() + e, point);
        }
    }

    void add_vertices()
    {
        RingSharpness sharp;
        for (std::uint32_t v = 0; v < out_.vertices; ++v) {
            auto const ring = topology_.ring(v);
            auto& index = out_.vertex_index;
            out_.vertex_offset_valence.push_back(std::uint32_t(index.size()));
            auto const edge = [&](std::size_t j) {
                return old(j < ring.size() ? topology_.vertex_of(topology_.next(ring[j]))
                                           : topology_.vertex_of(topology_.previous(ring.back())));
            };
            auto const face = [&](std::size_t j) { return face_point(topology_.face_of(ring[j])); };
            VertexRule rule = VertexRule::Smooth;
            bool const is_plain = sharpness_.is_plain(v);
            if (!is_plain) {
                sharpness_.around(v, sharp);
                rule = sharp.rule();
            }
            if (ring.empty() || rule == VertexRule::Corner) {
                out_.vertex_offset_valence.push_back(0);
            } else if (rule == VertexRule::Crease) {
                out_.vertex_offset_valence.push_back(1);
                for (std::size_t j : sharp.crease()) index.push_back(edge(j));
            } else {
                out_.vertex_offset_valence.push_back(std::uint32_t(ring.size()));
                for (std::size_t j = 0; j < ring.size(); ++j) {
                    index.push_back(edge(j));
                    index.push_back(face(j));
                }
            }
            if (is_plain || ring.empty() || !is_blended(sharp)) continue;
            add_blended(out_.first_vertex_point() + v,
                        vertex_point<CatmullClark>(
                            sharp, ring.size(), Sum(old(v)),
                            [&](std::size_t j) { return Sum(edge(j)); },
                            [&](std::size_t j) { return Sum(face(j)); }));
        }
    }

private:
    std::uint32_t old(std::uint32_t v) const { return out_.first + v; }
    std::uint32_t face_point(std::uint32_t f) const { return out_.first_face_point() + f; }
    void add_blended(std::uint32_t target, Sum const& sum)
    {
        SubdivisionTables::Blended& b = out_.blended;
        b.target.push_back(target);
        for (Sum::Term const& t : sum.terms()) {
            b.points.push_back(t.point);
            b.weights.push_back(float(t.weight));
        }
        b.first.push_back(std::uint32_t(b.points.size()));
    }

    Topology const& topology_;
    Sharpness const& sharpness_;
    SubdivisionTables& out_;
};

} // namespace

SubdivisionTables catmull_clark_tables(Topology const& topology, Sharpness const& sharpness,
                                       std::uint32_t first, bool only_quads)
{
    ControlMesh const& mesh = topology.mesh();
    EdgeNumbers const edges(topology);
    std::uint64_t const all =
        std::uint64_t(first) + 2 * mesh.positions.size() + mesh.faces() + edges.size();
    if (all > RWVectorBuffer::kMostVectors)
        throw LimitError("points of the vertex buffer of subdivision", all,
                         RWVectorBuffer::kMostVectors);
    constexpr std::uint64_t kMostFaces = 46340; // its square is below 2^31
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
        if (topology.ring(v).size() > kMostFaces)
            throw LimitError("faces at a vertex, to subdivide it,", topology.ring(v).size(),
                             kMostFaces);
    SubdivisionTables out;
    out.faces = std::uint32_t(mesh.faces());
    out.edges = std::uint32_t(edges.size());
    out.vertices = std::uint32_t(mesh.positions.size());
    out.first = first;
    Builder builder(topology, sharpness, out);
    builder.add_faces(only_quads);
    builder.add_edges(edges);
    builder.add_vertices();
    return out;
}

} // namespace tessemu
