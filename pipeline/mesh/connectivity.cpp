// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/connectivity.h"

#include <algorithm>
#include <array>
#include <bit>

namespace tessemu {

namespace {

// A corner in a number that orders: boundary, faces, position, sides of the faces from the patch
// on.
std::uint64_t corner_signature(Topology const& topology, HalfEdge h)
{
    std::uint32_t const v = topology.vertex_of(h);
    auto const ring = topology.ring(v);
    bool const boundary = topology.is_boundary(v);
    std::size_t const first = boundary ? 0 : topology.ring_index(h);
    std::uint64_t pattern = 0;
    for (std::size_t j = 0, at = first; j < ring.size(); ++j) {
        bool const triangle = topology.mesh().face(topology.face_of(ring[at])).size() == 3;
        pattern = std::rotl(pattern, 1) ^ (triangle ? 1 : 0);
        if (++at == ring.size()) at = 0;
    }
    std::uint64_t const position = boundary ? topology.ring_index(h) : 0;
    return (pattern & 0xffffffffu) | (position << 32) | (std::uint64_t(ring.size()) << 44) |
           (std::uint64_t(boundary) << 62);
}

// Numbers a patch's inputs in the order in which they come.
class LocalNumbers {
public:
    explicit LocalNumbers(Neighbourhood& out) : out_(out)
    {
        out.inputs.clear();
        out.numbers.clear();
    }
    /// The inputs are the patch's.
    void finish()
    {
        if (out_.inputs.empty()) out_.inputs.assign(few_.begin(), few_.begin() + count_);
    }

    int of(std::uint32_t v)
    {
        if (count_ >= kFew) return of_many(v);
        for (std::size_t at = v * 0x9e3779b1u >> (32 - kBits);; at = (at + 1) % slots_.size()) {
            if (slots_[at] == 0) {
                few_[std::size_t(count_++)] = v;
                slots_[at] = std::uint16_t(count_);
                return count_ - 1;
            }
            if (few_[slots_[at] - 1u] == v) return slots_[at] - 1;
        }
    }

private:
    static constexpr int kFew = 64, kBits = 7;

    int of_many(std::uint32_t v)
    {
        if (out_.inputs.empty()) {
            out_.inputs.assign(few_.begin(), few_.end());
            for (int i = 0; i < kFew; ++i) out_.numbers.emplace(few_[std::size_t(i)], i);
        }
        auto const [at, fresh] = out_.numbers.emplace(v, int(out_.inputs.size()));
        if (fresh) out_.inputs.push_back(v);
        return at->second;
    }

    Neighbourhood& out_;
    int count_ = 0; // up to kFew
    std::array<std::uint32_t, kFew> few_;
    std::array<std::uint16_t, 1 << kBits> slots_{}; // by a hash: number + 1
};

// What is equal for neighbourhoods of one type: all but the inputs.
void make_key(Neighbourhood& n)
{
    std::size_t longest = 1;
    for (int i = 0; i < n.sides; ++i) longest += 5 + 9 * n.corner[i].faces.size();
    n.key.resize(longest);
    char* key = n.key.data();
    auto const add = [&](int i) {
        *key++ = char(i);
        *key++ = char(i >> 8);
    };
    *key++ = char(n.sides);
    for (int i = 0; i < n.sides; ++i) {
        CornerNeighbourhood const& c = n.corner[i];
        *key++ = char(c.boundary);
        add(int(c.faces.size()));
        add(c.position);
        for (CornerNeighbourhood::Face const& f : c.faces) {
            *key++ = char(f.sides);
            for (int s = 0; s < std::min(f.sides, 4); ++s) add(f.vertices[s]);
        }
    }
    n.key.resize(std::size_t(key - n.key.data()));
}

} // namespace

void find_neighbourhood(Topology const& topology, std::uint32_t face, Neighbourhood& out)
{
    ControlMesh const& mesh = topology.mesh();
    HalfEdge const first = mesh.face_start[face];
    int const sides = int(mesh.face(face).size());
    std::array<std::uint64_t, 4> signature{};
    for (int i = 0; i < sides; ++i)
        signature[std::size_t(i)] = corner_signature(topology, first + std::uint32_t(i));
    int best = 0;
    for (int r = 1; r < sides; ++r)
        for (int i = 0; i < sides; ++i) {
            std::uint64_t const a = signature[std::size_t((r + i) % sides)];
            std::uint64_t const b = signature[std::size_t((best + i) % sides)];
            if (a == b) continue;
            if (a < b) best = r;
            break;
        }

    out.sides = sides;
    out.rotation = best;
    LocalNumbers local(out);
    for (int i = 0; i < sides; ++i) {
        HalfEdge const h = first + std::uint32_t((best + i) % sides);
        std::uint32_t const v = topology.vertex_of(h);
        auto const ring = topology.ring(v);
        auto const n = std::uint32_t(ring.size());
        std::uint32_t const j = topology.ring_index(h);
        CornerNeighbourhood& c = out.corner[i];
        c.boundary = topology.is_boundary(v);
        c.position = c.boundary ? int(j) : 0;
        out.ring_shift[i] = c.boundary ? 0 : int((n - j) % n);
        c.faces.resize(n);
        std::uint32_t at = c.boundary ? 0 : j;
        for (CornerNeighbourhood::Face& f : c.faces) {
            HalfEdge const corner = ring[at];
            if (++at == n) at = 0;
            std::uint32_t const g = topology.face_of(corner), begin = mesh.face_start[g],
                                end = mesh.face_start[g + 1];
            f.sides = int(end - begin);
            HalfEdge next = corner;
            for (int s = 0; s < f.sides && s < 4; ++s) {
                f.vertices[s] = local.of(mesh.face_vertices[next]);
                if (++next == end) next = begin;
            }
        }
    }
    local.finish();
    make_key(out);
    if (out.inputs.size() > 0xffff)
        throw LimitError("inputs of a patch", out.inputs.size(), 0xffff);
}

} // namespace tessemu
