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

// Local numbers of a patch's first inputs, by a hash of the global ones.
class LocalNumbers {
public:
    static constexpr int kMost = 64;

    /// The place of v among the inputs, or that behind the last.
    int find_or_add(std::vector<std::uint32_t> const& inputs, std::uint32_t v)
    {
        for (std::size_t at = v * 0x9e3779b1u >> (32 - kBits);; at = (at + 1) % slots_.size()) {
            if (slots_[at] == 0) {
                slots_[at] = std::uint8_t(inputs.size() + 1);
                return int(inputs.size());
            }
            if (inputs[slots_[at] - 1u] == v) return slots_[at] - 1;
        }
    }

private:
    static constexpr int kBits = 7;
    std::array<std::uint8_t, 1 << kBits> slots_{}; // number + 1
};

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
    out.inputs.clear();
    out.numbers.clear();
    std::size_t longest = 1;
    for (int i = 0; i < sides; ++i)
        longest += 5 + 9 * topology.ring(topology.vertex_of(first + std::uint32_t(i))).size();
    out.key.resize(longest);
    char* key = out.key.data();
    auto const add_to_key = [&](std::uint32_t i) {
        *key++ = char(i);
        *key++ = char(i >> 8);
    };
    LocalNumbers few;
    auto const number = [&](std::uint32_t v) {
        auto const n = int(out.inputs.size());
        if (n < LocalNumbers::kMost) return few.find_or_add(out.inputs, v);
        if (out.numbers.empty())
            for (int i = 0; i < n; ++i) out.numbers.emplace(out.inputs[std::size_t(i)], i);
        return out.numbers.emplace(v, n).first->second;
    };
    auto const local = [&](std::uint32_t v) {
        int const i = number(v);
        if (i == int(out.inputs.size())) out.inputs.push_back(v);
        add_to_key(std::uint32_t(i));
        return i;
    };
    *key++ = char(sides);
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
        *key++ = char(c.boundary);
        add_to_key(n);
        add_to_key(std::uint32_t(c.position));
        std::uint32_t at = c.boundary ? 0 : j;
        for (std::uint32_t k = 0; k < n; ++k) {
            HalfEdge g = ring[at];
            if (++at == n) at = 0;
            auto& f = c.faces[k];
            f.sides = int(mesh.face(topology.face_of(g)).size());
            *key++ = char(f.sides);
            for (int s = 0; s < f.sides && s < 4; ++s, g = topology.next(g))
                f.vertices[s] = local(topology.vertex_of(g));
        }
    }
    out.key.resize(std::size_t(key - out.key.data()));
    if (out.inputs.size() > 0xffff)
        throw LimitError("inputs of a patch", out.inputs.size(), 0xffff);
}

} // namespace tessemu
