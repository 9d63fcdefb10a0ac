// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/subdivision_tables.h"

#include "emu/compute_shader.h"
#include "pipeline/mesh/catmull_clark.h"

#include <map>

namespace tessemu {

namespace {

// What the masks blend where numbers will not do: points of the buffer.
using Sum = WeightedSum;

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
            Lean const by = sharpness_.lean(h);
            if (w == 0 && triangles == 0 && by.end < 0) continue;
            Sum point = CatmullClark::edge(Sum(old(a)), Sum(old(b)), Sum(face_point(f)),
                                           Sum(face_point(g)), triangles);
            lean<CatmullClark>(point, by, Sum(old(b)), Sum(old(a)));
            if (w != 0)
                point = point * (1 - w) + CatmullClark::crease_edge(Sum(old(a)), Sum(old(b))) * w;
            blended_[out_.first_edge_point() + e] = std::move(point);
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
            blended_[out_.first_vertex_point() + v] = vertex_point<CatmullClark>(
                sharp, ring.size(), Sum(old(v)), [&](std::size_t j) { return Sum(edge(j)); },
                [&](std::size_t j) { return Sum(face(j)); });
        }
    }

    void flatten(EdgeNumbers const& edges)
    {
        std::vector<std::pair<std::uint32_t, Sum>> moves; // all of the points as they are
        each_flat_ring<CatmullClark>(
            topology_, sharpness_, edges, [&](FlatRing const& flat, auto const& id) {
                auto const number = [&](std::size_t i) {
                    return out_.first_face_point() + std::uint32_t(id(i));
                };
                flat.moves(
                    [&](std::size_t i) { return new_point(number(i)); },
                    [&](std::size_t i, Sum by) { moves.emplace_back(number(i), std::move(by)); });
            });
        for (auto const& [point, by] : moves) {
            auto const [row, is_new] = blended_.try_emplace(point);
            if (is_new) row->second = new_point_of_kernels(point);
            row->second += by;
        }
    }

    /// Face points that are blended themselves give way to the vertices that they are made of.
    void finish_blended()
    {
        SubdivisionTables::Blended& b = out_.blended;
        for (auto const& [target, sum] : blended_) {
            Sum all;
            for (WeightedSum::Term const& t : sum.terms())
                all += (is_face_point(t.point) && blended_.count(t.point)
                            ? new_point_of_kernels(t.point)
                            : Sum(t.point)) *
                       t.weight;
            b.add(target, all);
        }
    }

private:
    std::uint32_t old(std::uint32_t v) const { return out_.first + v; }
    std::uint32_t face_point(std::uint32_t f) const { return out_.first_face_point() + f; }
    bool is_face_point(std::uint32_t point) const
    {
        return point >= out_.first_face_point() && point < out_.first_edge_point();
    }
    Sum new_point(std::uint32_t point) const
    {
        auto const row = blended_.find(point);
        return row != blended_.end() ? row->second : new_point_of_kernels(point);
    }
    // From old vertices and face points; a face point from old vertices.
    Sum new_point_of_kernels(std::uint32_t point) const
    {
        auto const sum_of = [](std::span<std::uint32_t const> index) {
            Sum sum;
            for (std::uint32_t p : index) sum += Sum(p);
            return sum;
        };
        ControlMesh const& mesh = topology_.mesh();
        if (is_face_point(point)) {
            std::uint32_t const f = point - out_.first_face_point(),
                                sides = std::uint32_t(mesh.face(f).size());
            auto const corners = std::span(out_.face_index).subspan(mesh.face_start[f], sides);
            return CatmullClark::face(sum_of(corners), int(sides));
        }
        if (point < out_.first_vertex_point()) {
            std::size_t const e = point - out_.first_edge_point();
            return sum_of(std::span(out_.edge_index).subspan(4 * e, 4)) / 4;
        }
        std::uint32_t const v = point - out_.first_vertex_point();
        auto const index =
            std::span(out_.vertex_index).subspan(out_.vertex_offset_valence[2 * std::size_t(v)]);
        std::uint32_t const n = out_.vertex_offset_valence[2 * std::size_t(v) + 1];
        if (n == 0) return Sum(old(v));
        if (n == 1) return CatmullClark::crease_vertex(Sum(index[0]), Sum(old(v)), Sum(index[1]));
        Sum ends, faces;
        for (std::uint32_t j = 0; j < n; ++j) {
            ends += Sum(index[2 * j]);
            faces += Sum(index[2 * j + 1]);
        }
        return CatmullClark::vertex(int(n), Sum(old(v)), ends, faces);
    }

    Topology const& topology_;
    Sharpness const& sharpness_;
    SubdivisionTables& out_;
    std::map<std::uint32_t, Sum> blended_; // by new point
};

void refuse_buffer(std::uint64_t points)
{
    if (points > RWVectorBuffer::kMostVectors)
        throw LimitError("points of the vertex buffer of subdivision", points,
                         RWVectorBuffer::kMostVectors);
}

} // namespace

void SubdivisionTables::Blended::add(std::uint32_t new_point, WeightedSum const& sum)
{
    target.push_back(new_point);
    for (WeightedSum::Term const& t : sum.terms()) {
        points.push_back(t.point);
        weights.push_back(float(t.weight));
    }
    first.push_back(std::uint32_t(points.size()));
}

SubdivisionTables weighted_tables(std::span<WeightedSum const> points, std::uint32_t vertices,
                                  std::uint32_t first)
{
    refuse_buffer(std::uint64_t(first) + vertices + points.size());
    SubdivisionTables out;
    out.edges = std::uint32_t(points.size()) - vertices;
    out.vertices = vertices;
    out.first = first;
    for (std::uint32_t i = 0; i < points.size(); ++i)
        out.blended.add(out.first_face_point() + i, points[i]);
    return out;
}

SubdivisionTables catmull_clark_tables(Topology const& topology, Sharpness const& sharpness,
                                       std::uint32_t first, bool only_quads)
{
    ControlMesh const& mesh = topology.mesh();
    EdgeNumbers const edges(topology);
    refuse_buffer(std::uint64_t(first) + 2 * mesh.positions.size() + mesh.faces() + edges.size());
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
    builder.flatten(edges);
    builder.finish_blended();
    return out;
}

} // namespace tessemu
