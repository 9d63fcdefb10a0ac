// SPDX-License-Identifier: Apache-2.0
#include "analysis/shared_edges.h"

#include "shaders_cpp/domain_edges.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <bit>

namespace tessemu {

glm::vec3 SeenPoint::displaced() const
{
    glm::vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = std::bit_cast<float>(bits[kDisplaced + std::size_t(k)]);
    return p;
}

std::size_t SharedEdges::Hash::operator()(MeshPoint const& p) const
{
    return ((std::size_t(p.a) * 0x9e3779b97f4a7c15u) ^ (std::size_t(p.b) << 20) ^
            (std::size_t(p.s) << 40) ^ p.t ^ (std::size_t(p.kind) << 62)) *
           0xbf58476d1ce4e5b9u;
}

SharedEdges::SharedEdges(PatchMesh const& patches, FrameSettings const& frame, bool keep_triangles,
                         ThreadPool const& threads)
    : mesh_(patches.mesh().base()),
      topology_(patches.mesh().base_topology()),
      eye_(frame.camera.eye),
      backward_(frame.camera.backward())
{
    if (patches.has_creases()) sharpness_.emplace(topology_);
    visit_surface(patches, frame, threads,
                  [&](SurfacePatch const& patch) { add(patch, keep_triangles); });
}

std::size_t SharedEdges::count_pieces(std::size_t least, std::size_t most) const
{
    std::size_t pieces = 0;
    for (auto const& [name, line] : lines_) {
        std::vector<std::uint32_t> ends;
        for (Interval const& i : line.intervals) ends.insert(ends.end(), {i.low, i.high});
        std::sort(ends.begin(), ends.end());
        ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
        for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
            auto const patches = std::size_t(
                std::count_if(line.intervals.begin(), line.intervals.end(), [&](Interval const& i) {
                    return i.low <= ends[k] && i.high >= ends[k + 1];
                }));
            pieces += least <= patches && patches <= most;
        }
    }
    return pieces;
}

void SharedEdges::extend(glm::vec3 position)
{
    if (!glm::all(glm::equal(position - position, glm::vec3(0)))) { // not of infinities and NaN
        extent_.finite = false;
        return;
    }
    extent_.low = glm::min(extent_.low, position);
    extent_.high = glm::max(extent_.high, position);
    double const away = glm::dot(eye_ - glm::dvec3(position), backward_);
    extent_.nearest = std::min(extent_.nearest, away);
    extent_.farthest = std::max(extent_.farthest, away);
}

SharedEdges::Outline SharedEdges::outline_of(TessellatedPatch const& t)
{
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> triangles;
    for (std::size_t i = 0; i + 2 < t.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k)
            ++triangles[std::minmax(t.indices[i + k], t.indices[i + (k + 1) % 3])];
    Outline out;
    out.on.assign(t.points(), 0);
    for (auto const& [edge, n] : triangles)
        if (n == 1) {
            out.on[edge.first] = out.on[edge.second] = 1;
            out.segments.insert(out.segments.end(), {edge.first, edge.second});
        }
    return out;
}

std::uint8_t SharedEdges::number_of_word(std::string const& word)
{
    auto const at = std::find(words_.begin(), words_.end(), word);
    if (at != words_.end()) return std::uint8_t(at - words_.begin());
    words_.push_back(word);
    return std::uint8_t(words_.size() - 1);
}

std::string const& SharedEdges::edge_in_words(std::vector<SeenPoint> const& seen) const
{
    for (SeenPoint const& s : seen)
        if (s.edge) return words_[s.edge];
    return words_[0];
}

std::uint16_t SharedEdges::side_of(MeshPoint const& point, std::uint32_t face) const
{
    if (!sharpness_ || point.kind == MeshPoint::Kind::Face) return 0;
    auto const is_sharp = [&](HalfEdge h) { return sharpness_->edge(h) >= kInfinitelySharp; };
    if (point.kind == MeshPoint::Kind::Edge) {
        HalfEdge const h = topology_.find_edge(point.a, point.b);
        return h != Topology::kNone && is_sharp(h) && topology_.face_of(h) != face;
    }
    // A side lies between two sharp edges of the ring, or one that is met twice.
    auto const ring = topology_.ring(point.a);
    std::uint16_t before = 0, all = 0;
    bool met = false;
    for (HalfEdge h : ring) {
        all += is_sharp(h);
        if (!met) before = all;
        met = met || topology_.face_of(h) == face;
    }
    return topology_.is_boundary(point.a) || all == 0 ? before : std::uint16_t(before % all);
}

void SharedEdges::add(SurfacePatch const& patch, bool keep_triangles)
{
    PatchPlace const& place = patch.place();
    auto const number = std::uint32_t(face_of_patch_.size());
    face_of_patch_.push_back(place.face);
    int const n = place.sides;
    MeshInterval edge[4];
    for (int k = 0; k < n; ++k) {
        edge[k] = mesh_interval(mesh_, place, k);
        lines_[edge[k].line].intervals.push_back(
            {std::min(edge[k].from, edge[k].to), std::max(edge[k].from, edge[k].to), number});
    }
    TessellatedPatch const& tess = patch.domain().patch;
    Outline& outline = outlines_[tess.indices];
    if (outline.on.empty()) outline = outline_of(tess);
    for (std::size_t i = 0; i < tess.points(); ++i) extend(patch.vertex(i).position);
    std::size_t const first_point = rays_.positions.size();
    if (keep_triangles) {
        auto const first = std::uint32_t(first_point);
        for (std::size_t i = 0; i < tess.points(); ++i)
            rays_.positions.push_back(patch.vertex(i).position);
        rays_.control.insert(rays_.control.end(), rays_.positions.begin() + std::ptrdiff_t(first),
                             rays_.positions.end());
        for (std::uint32_t i : tess.indices) rays_.triangles.push_back(first + i);
        face_of_triangle_.insert(face_of_triangle_.end(), tess.indices.size() / 3, place.face);
        for (std::uint32_t i : outline.segments) rays_.targets.push_back(first + i);
        face_of_target_.insert(face_of_target_.end(), outline.segments.size() / 2, place.face);
    }
    for (std::size_t i = 0; i < tess.points(); ++i) {
        if (!outline.on[i]) continue;
        float const u = patch.domain().u[i], v = patch.domain().v[i];
        DomainEdges<4, float> const at = domain_edges<float>(n, u, v, 1 - u - v, 1 - u, 1 - v);
        MeshPoint const point = mesh_point(mesh_, place, tess.u[i], tess.v[i]);
        int edges = 0, last = 0;
        for (int k = 0; k < n; ++k) {
            if (!at.on[k]) continue;
            ++edges, last = k;
            // Exact: a multiple of 2^-16.
            lines_[edge[k].line].points.push_back(
                {edge[k].at(std::uint32_t(at.t[k] * 65536)), number, point});
        }
        if (edges == 0) continue;
        SurfaceVertex const vertex = patch.vertex(i);
        SeenPoint seen{place.face, number, {}, 1, 0, side_of(point, place.face)};
        if (edges == 1) seen.edge = number_of_word(patch.kind().edges[std::size_t(last)]);
        for (int c = 0; c < 3; ++c) {
            auto const bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
            seen.bits[SeenPoint::kPosition + std::size_t(c)] = bits(vertex.smooth[c]);
            seen.bits[SeenPoint::kNormal + std::size_t(c)] = bits(vertex.normal[c]);
            seen.bits[SeenPoint::kDisplaced + std::size_t(c)] = bits(vertex.position[c]);
        }
        glm::vec3 const first = record(point, seen);
        if (keep_triangles) rays_.control[first_point + i] = first;
    }
}

glm::vec3 SharedEdges::record(MeshPoint const& point, SeenPoint const& seen)
{
    std::vector<SeenPoint>& all = points_[point];
    auto const same = std::find_if(all.begin(), all.end(), [&](SeenPoint const& s) {
        return s.bits == seen.bits && s.side == seen.side;
    });
    if (same != all.end()) {
        ++same->patches;
        if (!same->edge) same->edge = seen.edge;
    } else
        all.push_back(seen);
    return all.front().displaced();
}

} // namespace tessemu
