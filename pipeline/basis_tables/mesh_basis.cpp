// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/mesh_basis.h"

#include "emu/parallel.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <set>

namespace tessemu {

namespace {

// The type of the patch on a face, and where it lies.
struct FoundPatch {
    PatchType type;
    std::uint32_t vertex = 0;
    std::uint32_t first_face = 0; // of the ring: the type's face 0
};

bool is_infinite(float sharpness)
{
    return sharpness >= kInfinitelySharp;
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
        std::uint32_t const v = out.vertex = t_.vertex_of(h);
        auto const n = std::uint32_t(t_.ring(v).size());
        if (n > PatchType::kMostFaces)
            throw LimitError("faces at " + refined_.vertex_in_words(v), n, PatchType::kMostFaces);
        sharpness_.around(v, ring_);
        std::uint32_t const position = t_.ring_index(h);
        auto const limited = [](float s) { return std::min(s, kInfinitelySharp); };
        VertexRing& corner = out.type.corner;
        corner.vertex = limited(ring_.vertex);
        for (float& s : ring_.edge) s = limited(s);
        std::vector<std::uint32_t> cuts;
        for (std::uint32_t j = 0; j < ring_.edge.size(); ++j)
            if (is_infinite(ring_.edge[j])) cuts.push_back(j);
        VertexRule const rule = ring_.rule();
        if (!ring_.is_semi_sharp() && cuts.size() > 1) {
            if (!ring_.open) cuts.push_back(cuts[0] + n); // round to the first
            std::size_t s = 0;
            auto const of_sector = [&] { return (position + n - cuts[s] % n) % n; };
            while (of_sector() >= cuts[s + 1] - cuts[s]) ++s;
            corner.closed = false;
            corner.faces = std::uint16_t(cuts[s + 1] - cuts[s]);
            corner.position = std::uint16_t(of_sector());
            corner.vertex = rule == VertexRule::Corner ? kInfinitelySharp : 0;
            out.first_face = cuts[s] % n;
            return out;
        }
        corner.faces = std::uint16_t(n);
        corner.closed = !ring_.open;
        corner.position = std::uint16_t(ring_.open ? position : 0);
        out.first_face = ring_.open ? 0 : position;
        corner.edges = ring_.edge;
        if (corner.closed)
            std::rotate(corner.edges.begin(), corner.edges.begin() + position, corner.edges.end());
        if (corner.closed &&
            std::none_of(corner.edges.begin(), corner.edges.end(), [](float s) { return s > 0; }))
            corner.edges.clear();
        return out;
    }

    // Vertices of the patch's control points, in their order.
    void add_points(FoundPatch const& p, HalfEdge h, std::vector<std::uint32_t>& out) const
    {
        auto const ring = t_.ring(p.vertex);
        auto const far = [&](HalfEdge k) { return t_.vertex_of(t_.next(k)); };
        auto const across = [&](HalfEdge k) { return far(t_.next(k)); };
        VertexRing const& corner = p.type.corner;
        out.push_back(p.vertex);
        for (std::size_t j = 0; j < corner.faces; ++j) {
            HalfEdge const k = ring[(p.first_face + j) % ring.size()];
            out.push_back(far(k));
            out.push_back(across(k));
        }
        if (!corner.closed)
            out.push_back(
                t_.vertex_of(t_.previous(ring[(p.first_face + corner.faces - 1u) % ring.size()])));
        // Half-edges on the patch's far sides, in the faces beyond: from (1,1), and from (0,1).
        HalfEdge const right = t_.twin(t_.next(h)), top = t_.twin(t_.next(t_.next(h))),
                       upper_right = t_.twin(t_.previous(right));
        out.push_back(t_.vertex_of(t_.next(t_.next(right))));
        out.push_back(t_.vertex_of(t_.previous(right)));
        out.push_back(t_.vertex_of(t_.next(t_.next(upper_right))));
        out.push_back(t_.vertex_of(t_.next(t_.next(top))));
        out.push_back(t_.vertex_of(t_.previous(top)));
        if (p.type.has_lower()) out.push_back(t_.vertex_of(t_.previous(t_.twin(t_.next(right)))));
        if (p.type.has_left())
            out.push_back(t_.vertex_of(t_.next(t_.next(t_.twin(t_.previous(top))))));
    }

private:
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
                       sharpness_.edge(ring[(j + 3) % 4]) == 0 &&
                       (sharpness_.edge(ring[j]) > 0) == (sharpness_.edge(ring[(j + 2) % 4]) > 0);
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
    std::vector<HalfEdge> corner_half_edge;
    // By vertex and the first face of its sector; of a closed ring one.
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> corners;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        HalfEdge const h = finder.corner_of(f);
        FoundPatch const p = finder.at(h);
        auto const [type, is_new_type] = numbers.try_emplace(p.type, std::uint32_t(types.size()));
        if (is_new_type) types.push_back(p.type);
        auto const [corner, is_new_corner] =
            corners.try_emplace({p.vertex, p.type.corner.closed ? 0 : p.first_face},
                                std::uint32_t(corner_owner_.size()));
        if (is_new_corner) corner_owner_.push_back(f);
        patches_.push_back({f, int(h - mesh.face_start[f]), type->second,
                            std::uint32_t(points_.size()), corner->second});
        corner_half_edge.push_back(h);
        finder.add_points(p, h, points_);
    }

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
    for (std::size_t i = 0; i < types.size(); ++i)
        types_.push_back(in_single_precision(types[i], *tables[i]));
    if (!options.enforced) return;

    // What patches share: a type's side against another's.
    std::set<Joint> joints;
    std::vector<std::uint32_t> const& start = mesh.face_start;
    auto const side_of = [&](HalfEdge h) { // of its face's patch, from its corner on
        return PatchSide((h - start[topology.face_of(h)] + 4 -
                          std::uint32_t(patches_[topology.face_of(h)].rotation)) %
                         4);
    };
    for (HalfEdge h = 0; h < mesh.face_vertices.size(); ++h) {
        HalfEdge const other = topology.twin(h);
        if (other == Topology::kNone) continue;
        Joint const joint{patches_[topology.face_of(h)].type, side_of(h),
                          patches_[topology.face_of(other)].type, side_of(other)};
        if (joint.is_canonical()) joints.insert(joint);
    }
    symmetry_ = enforce_symmetry(types_, std::vector<Joint>(joints.begin(), joints.end()));
}

} // namespace tessemu
