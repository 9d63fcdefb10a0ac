// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/mesh_basis.h"

#include "emu/parallel.h"
#include "pipeline/mesh/flatness.h"

#include <algorithm>
#include <cassert>
#include <map>

namespace tessemu {

namespace {

// The type of the patch on a face, and where it lies.
struct FoundPatch {
    PatchType type;
    HalfEdge half_edge = 0;       // of the face, at the corner
    std::uint32_t first_face = 0; // of the corner's ring: the type's face 0
    std::array<std::pair<std::uint32_t, std::uint32_t>, 3> beyond; // vertices, and the same of them
};

bool is_finite(float sharpness)
{
    return sharpness > 0 && sharpness < kInfinitelySharp;
}

class PatchFinder {
public:
    explicit PatchFinder(RefinedMesh const& refined)
        : refined_(refined),
          t_(refined.topology()),
          sharpness_(t_)
    {
    }

    // Corner (0,0) of a face, whose other corners are regular.
    HalfEdge corner_of(std::uint32_t face) const
    {
        ControlMesh const& mesh = t_.mesh();
        HalfEdge const first = mesh.face_start[face];
        if (mesh.face(face).size() != 4) refuse(face, "is no quad");
        for (HalfEdge h = first; h < first + 4; ++h)
            if (is_plain(t_.next(t_.next(h))) && is_along(h, t_.next(h)) &&
                is_along(h, t_.previous(h)))
                return h;
        refuse(face, "has more than one vertex that is extraordinary or tagged");
    }

    FoundPatch at(HalfEdge h)
    {
        FoundPatch out;
        out.half_edge = h;
        PatchType& type = out.type;
        auto const [corner, first] = ring_at(h);
        type.corner = corner;
        out.first_face = first;
        HalfEdge const right = right_of(h), upper = upper_of(h);
        std::array<HalfEdge, 3> const beyond{t_.next(t_.next(right)),
                                             t_.next(t_.next(t_.twin(t_.previous(right)))),
                                             t_.previous(upper)};
        SubdivisionRules const& rules = t_.mesh().rules;
        if (rules.crease_method == CreaseMethod::Chaikin) {
            auto const ring = t_.ring(t_.vertex_of(h));
            std::size_t const edges = corner.edge_count(), j = corner.position;
            std::vector<float> outer(edges, 0);
            for (std::size_t i = 0; i < edges; ++i)
                if (i == j || i == (j + 1) % edges || is_finite(corner.edge(i)))
                    outer[i] = outer_sharpness(ring, first + i);
            bool const lends[] = {is_finite(outer[j]), is_finite(outer[(j + 1) % edges])};
            if (lends[0] || lends[1] || corner.is_semi_sharp()) {
                type.crease_method = CreaseMethod::Chaikin;
                type.outer = outer;
            }
            if (lends[0]) add_beyond(PatchType::RightVertex, beyond[0], out);
            if (lends[1]) add_beyond(PatchType::UpperVertex, beyond[2], out);
        }
        if (rules.sectors == SectorRules::Biermann) {
            for (int v = 0; v < 3; ++v) {
                VertexRing const ring = ring_at(beyond[std::size_t(v)]).first;
                bool const leans =
                    v != PatchType::DiagonalVertex &&
                    ring.leans((ring.position + (v == PatchType::RightVertex)) % ring.edge_count());
                if (leans || is_moved(ring)) add_beyond(v, beyond[std::size_t(v)], out);
            }
            bool const any = std::any_of(type.beyond.begin(), type.beyond.end(),
                                         [](auto const& ring) { return ring.has_value(); });
            if (any || corner.is_tagged() || is_moved(corner)) {
                type.sectors = SectorRules::Biermann;
                type.flatness = rules.flatness;
            }
        }
        return out;
    }

    // Vertices of the patch's control points, in their order.
    void add_points(FoundPatch const& p, std::span<std::uint16_t const> beyond,
                    std::vector<std::uint32_t>& out) const
    {
        HalfEdge const h = p.half_edge;
        auto const ring = t_.ring(t_.vertex_of(h));
        VertexRing const& corner = p.type.corner;
        out.push_back(t_.vertex_of(h));
        for (std::size_t j = 0; j < corner.edge_count(); ++j) {
            out.push_back(edge_end(ring, p.first_face + j));
            if (j < corner.faces) out.push_back(across(ring[(p.first_face + j) % ring.size()]));
        }
        HalfEdge const right = right_of(h), upper = upper_of(h),
                       diagonal = t_.twin(t_.previous(right));
        out.push_back(t_.vertex_of(t_.next(t_.next(right))));
        out.push_back(t_.vertex_of(t_.previous(right)));
        out.push_back(t_.vertex_of(t_.next(t_.next(diagonal))));
        out.push_back(t_.vertex_of(t_.next(t_.next(upper))));
        out.push_back(t_.vertex_of(t_.previous(upper)));
        if (p.type.has_lower()) out.push_back(t_.vertex_of(t_.previous(t_.twin(t_.next(right)))));
        if (p.type.has_left()) out.push_back(across(t_.twin(t_.previous(upper))));
        if (beyond.empty()) return;
        auto const points = p.type.beyond_points();
        for (std::uint16_t i : beyond) {
            PatchType::BeyondPoint const& x = points[i];
            auto const& [vertex, first] = p.beyond[std::size_t(x.vertex)];
            auto const of = t_.ring(vertex);
            out.push_back(x.is_face ? across(of[(first + x.index) % of.size()])
                                    : edge_end(of, first + x.index));
        }
    }

    // A name for the side of infinitely sharp edges that a half-edge's face lies on, around its
    // vertex: the last such edge before the face; none where there is none.
    HalfEdge side_of(HalfEdge h) const
    {
        auto const ring = t_.ring(t_.vertex_of(h));
        std::size_t j = t_.ring_index(h);
        for (std::size_t n = 0; n < ring.size(); ++n, j = (j + ring.size() - 1) % ring.size())
            if (sharpness_.edge(ring[j]) >= kInfinitelySharp) return ring[j];
        return Topology::kNone;
    }

private:
    std::uint32_t far_end(HalfEdge h) const { return t_.vertex_of(t_.next(h)); }
    std::uint32_t across(HalfEdge h) const { return t_.vertex_of(t_.next(t_.next(h))); }
    // In the faces on the patch's right and upper sides: from (1,1) and from (0,1).
    HalfEdge right_of(HalfEdge h) const { return t_.twin(t_.next(h)); }
    HalfEdge upper_of(HalfEdge h) const { return t_.twin(t_.next(t_.next(h))); }
    // The last edge of an open ring belongs to its last face.
    std::uint32_t edge_end(std::span<HalfEdge const> ring, std::size_t j) const
    {
        if (j >= ring.size() && t_.is_boundary(t_.vertex_of(ring[0])))
            return t_.vertex_of(t_.previous(ring.back()));
        return far_end(ring[j % ring.size()]);
    }

    // The ring of a half-edge's vertex, looked at by its face: where nothing is semi-sharp the
    // sector that the face is in. And its first face.
    std::pair<VertexRing, std::uint32_t> ring_at(HalfEdge h)
    {
        VertexRing out;
        std::uint32_t const v = t_.vertex_of(h), position = t_.ring_index(h);
        auto const n = std::uint32_t(t_.ring(v).size());
        if (n > PatchType::kMostFaces)
            throw LimitError("faces at " + refined_.vertex_in_words(v), n, PatchType::kMostFaces);
        sharpness_.around(v, ring_);
        for (float& s : ring_.edge) s = std::min(s, kInfinitelySharp);
        std::vector<std::uint32_t> cuts;
        for (std::uint32_t j = 0; j < ring_.edge.size(); ++j)
            if (ring_.edge[j] > 0) cuts.push_back(j);
        out.vertex = std::min(ring_.vertex, kInfinitelySharp);
        // A given flatness may move a sector because of another.
        bool const is_whole =
            ring_.biermann && ring_.flatness && *ring_.flatness > 0 && !ring_.open;
        if (!ring_.is_semi_sharp() && cuts.size() > 1 && !is_whole) {
            if (!ring_.open) cuts.push_back(cuts[0] + n); // round to the first
            std::size_t s = 0;
            auto const in_sector = [&] { return (position + n - cuts[s] % n) % n; };
            while (in_sector() >= cuts[s + 1] - cuts[s]) ++s;
            out.closed = false;
            out.faces = std::uint16_t(cuts[s + 1] - cuts[s]);
            out.position = std::uint16_t(in_sector());
            out.vertex = ring_.rule() == VertexRule::Corner ? kInfinitelySharp : 0;
            if (is_concave(cuts[s] % n)) out.concave = {0};
            return {out, cuts[s] % n};
        }
        out.faces = std::uint16_t(n);
        out.closed = !ring_.open;
        std::uint32_t const first = ring_.open ? 0 : position;
        out.position = std::uint16_t(ring_.open ? position : 0);
        if (!cuts.empty()) {
            out.edges = ring_.edge;
            std::rotate(out.edges.begin(), out.edges.begin() + first, out.edges.end());
            for (std::size_t edge : ring_.concave)
                out.concave.push_back(std::uint16_t((edge + n - first) % n));
            std::sort(out.concave.begin(), out.concave.end());
        }
        return {out, first};
    }
    bool is_concave(std::size_t edge) const
    {
        return std::binary_search(ring_.concave.begin(), ring_.concave.end(), edge);
    }
    // In each step.
    bool is_moved(VertexRing const& r) const
    {
        SubdivisionRules const& rules = t_.mesh().rules;
        return is_flattened(r.sharpness(rules.sectors, rules.flatness), r.faces);
    }
    void add_beyond(int v, HalfEdge h, FoundPatch& out)
    {
        auto const [ring, first] = ring_at(h);
        out.type.beyond[std::size_t(v)] = ring;
        out.beyond[std::size_t(v)] = {t_.vertex_of(h), first};
    }
    // Of the edge that goes on from edge j: at its end, beyond two more.
    float outer_sharpness(std::span<HalfEdge const> ring, std::size_t j) const
    {
        if (j >= ring.size() && t_.is_boundary(t_.vertex_of(ring[0]))) return kInfinitelySharp;
        HalfEdge const other = t_.twin(ring[j % ring.size()]); // from the far end
        if (other == Topology::kNone) return kInfinitelySharp;
        std::uint32_t const v = t_.vertex_of(other);
        auto const around = t_.ring(v);
        return std::min(sharpness_.edge(around[(t_.ring_index(other) + 2) % around.size()]),
                        kInfinitelySharp);
    }

    // Four faces, and no tag.
    bool is_plain(HalfEdge h) const
    {
        std::uint32_t const v = t_.vertex_of(h);
        return sharpness_.is_plain(v) && t_.ring(v).size() == 4;
    }
    // The vertex of `h` is in the middle of a line that starts at the vertex of `start`, and is
    // regular: nothing else is sharp there.
    bool is_along(HalfEdge start, HalfEdge h) const
    {
        std::uint32_t const v = t_.vertex_of(h), from = t_.vertex_of(start);
        auto const ring = t_.ring(v);
        if (sharpness_.is_plain(v)) return ring.size() == 4;
        if (sharpness_.vertex(v) > 0) return false;
        auto const far = [&](HalfEdge k) { return t_.vertex_of(t_.next(k)); };
        if (t_.is_boundary(v))
            return ring.size() == 2 && sharpness_.edge(ring[1]) == 0 &&
                   (far(ring[0]) == from || t_.vertex_of(t_.previous(ring[1])) == from);
        if (ring.size() != 4) return false;
        for (std::size_t j = 0; j < 4; ++j)
            if (far(ring[j]) == from)
                return sharpness_.edge(ring[(j + 1) % 4]) == 0 &&
                       sharpness_.edge(ring[(j + 3) % 4]) == 0;
        return false;
    }

    [[noreturn]] void refuse(std::uint32_t face, std::string const& why) const
    {
        throw Error("face " + std::to_string(face + 1) + " of the mesh after " +
                    std::to_string(refined_.steps()) + " steps of subdivision " + why +
                    ": tables need one more step");
    }

    RefinedMesh const& refined_;
    Topology const& t_;
    Sharpness sharpness_;
    RingSharpness ring_;
};

} // namespace

MeshBasis::MeshBasis(RefinedMesh const& refined, BasisTableStore* store, BasisOptions options,
                     RefinementProgress const& progress)
{
    Topology const& topology = refined.topology();
    ControlMesh const& mesh = refined.mesh();
    PatchFinder finder(refined);
    std::map<PatchType, std::uint32_t> numbers;
    std::vector<PatchType> types;
    std::vector<FoundPatch> found;
    // By vertex and the side of its infinitely sharp edges.
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> corners;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        FoundPatch const& p = found.emplace_back(finder.at(finder.corner_of(f)));
        auto const [type, is_new_type] = numbers.try_emplace(p.type, std::uint32_t(types.size()));
        if (is_new_type) types.push_back(p.type);
        auto const [corner, is_new_corner] =
            corners.try_emplace({topology.vertex_of(p.half_edge), finder.side_of(p.half_edge)},
                                std::uint32_t(corner_owner_.size()));
        if (is_new_corner) corner_owner_.push_back(f);
        patches_.push_back(
            {f, int(p.half_edge - mesh.face_start[f]), type->second, 0, corner->second});
    }

    constexpr std::uint64_t kMostBytes = std::uint64_t(8) << 30;
    std::uint64_t bytes = 0; // in double, and as much again in floats and as textures
    for (PatchType const& t : types)
        bytes += 2 * 3 * sizeof(double) * kTableSamples * std::uint64_t(t.points());
    if (bytes > kMostBytes)
        throw LimitError("bytes of basis-function tables of " + std::to_string(types.size()) +
                             " types of patches (sectors of many faces have as many types, and so "
                             "have sharpnesses that are all different)",
                         bytes, kMostBytes);
    std::vector<std::optional<BasisTables>> tables(types.size());
    std::vector<std::size_t> missing;
    std::size_t done = 0;
    for (std::size_t i = 0; i < types.size(); ++i) {
        if (store) tables[i] = store->find(types[i]);
        if (!tables[i]) missing.push_back(i);
    }
    done = types.size() - missing.size();
    auto const tell = [&] {
        if (progress) progress(done, types.size());
    };
    // A thread's few at a time, so that a store has them soon and progress is told from here.
    std::size_t const at_once = options.threads ? std::size_t(4 * options.threads->threads()) : 1;
    for (std::size_t first = 0; first < missing.size(); first += at_once) {
        std::size_t const count = std::min(at_once, missing.size() - first);
        auto const make = [&](std::size_t i) {
            std::size_t const type = missing[first + i];
            tables[type] = make_basis_tables(types[type]);
        };
        if (options.threads)
            options.threads->parallel_for(count, make);
        else
            make(0);
        for (std::size_t i = first; i < first + count; ++i)
            if (store) store->keep(types[missing[i]], *tables[missing[i]]);
        done += count;
        tell();
    }
    std::map<std::pair<std::uint32_t, std::vector<std::uint16_t>>, std::uint32_t> variants;
    std::vector<std::uint32_t> vertices;
    std::map<std::uint32_t, std::uint16_t> number_of; // by vertex
    for (std::size_t f = 0; f < patches_.size(); ++f) {
        BasisPatch& patch = patches_[f];
        BasisTables const& of_type = *tables[patch.type];
        vertices.clear(), number_of.clear();
        finder.add_points(found[f], of_type.beyond, vertices);
        patch.first_point = std::uint32_t(points_.size());
        std::vector<std::uint16_t> point_of;
        for (std::uint32_t v : vertices) {
            auto const [number, is_new] = number_of.try_emplace(v, std::uint16_t(number_of.size()));
            if (is_new) points_.push_back(v);
            point_of.push_back(number->second);
        }
        auto const [variant, is_new] =
            variants.try_emplace({patch.type, point_of}, std::uint32_t(types_.size()));
        if (is_new)
            types_.push_back(in_single_precision(types[patch.type], of_type, std::move(point_of)));
        patch.type = variant->second;
    }
    if (!options.enforced) return;

    // Patches of equal types meet alike: what two of them share stands for all.
    std::map<Joint, JointPoints> joints;
    auto const points_of = [&](BasisPatch const& p) {
        return std::span(points_).subspan(p.first_point, std::size_t(types_[p.type].points));
    };
    std::map<std::uint32_t, std::uint16_t> number_in_a;
    std::vector<std::uint32_t> const& start = mesh.face_start;
    auto const side_of = [&](HalfEdge h) { // of its face's patch, from its corner on
        return PatchSide((h - start[topology.face_of(h)] + 4 -
                          std::uint32_t(patches_[topology.face_of(h)].rotation)) %
                         4);
    };
    for (HalfEdge h = 0; h < mesh.face_vertices.size(); ++h) {
        HalfEdge const other = topology.twin(h);
        PatchSide const side = side_of(h);
        if (other == Topology::kNone || (side != PatchSide::Lower && side != PatchSide::Right))
            continue;
        assert(side_of(other) == (side == PatchSide::Lower ? PatchSide::Left : PatchSide::Upper));
        BasisPatch const &a = patches_[topology.face_of(h)], &b = patches_[topology.face_of(other)];
        auto const [joint, is_new] = joints.try_emplace({a.type, side, b.type});
        if (!is_new) continue;
        number_in_a.clear();
        for (std::uint32_t v : points_of(a))
            number_in_a.emplace(v, std::uint16_t(number_in_a.size()));
        std::uint16_t k = 0;
        for (std::uint32_t v : points_of(b)) {
            auto const in_a = number_in_a.find(v);
            if (in_a != number_in_a.end()) joint->second.push_back({in_a->second, k});
            ++k;
        }
    }
    std::vector<Joint> list;
    std::vector<JointPoints> points;
    for (auto& [joint, shared] : joints) {
        list.push_back(joint);
        points.push_back(std::move(shared));
    }
    enforce_symmetry(types_, list, points);
}

} // namespace tessemu
