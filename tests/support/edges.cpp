// SPDX-License-Identifier: Apache-2.0
#include "tests/support/edges.h"

#include "shaders_cpp/domain_edges.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <bit>
#include <map>
#include <unordered_map>

namespace tessemu::test {

namespace {

using Bits = std::array<std::uint32_t, 6>;

Bits bits_of(SurfaceVertex const& v)
{
    Bits out;
    for (int c = 0; c < 3; ++c) {
        out[std::size_t(c)] = std::bit_cast<std::uint32_t>(v.position[c]);
        out[std::size_t(3 + c)] = std::bit_cast<std::uint32_t>(v.normal[c]);
    }
    return out;
}

struct MeshPointHash {
    std::size_t operator()(MeshPoint const& p) const
    {
        std::size_t h = std::size_t(p.kind);
        for (std::uint32_t word : {p.a, p.b, p.s, p.t})
            h = (h ^ word ^ h >> 29) * 0x9e3779b97f4a7c15u;
        return h ^ h >> 32;
    }
};

struct Seen {
    Bits bits;
    std::size_t patch;             // that had it last
    int patches = 1;               // that have it
    int outlines = 0;              // on whose triangles' outline it lies
    std::size_t outline_patch = 0; // the last of them
    MeshLine line{};               // unless it is a corner of a patch
    std::uint32_t at = 0;          // on the line
};

// Points on the outline of a patch's triangles. With fractional_odd spacing and an inside factor of
// 1, points of inner rings lie on the patch's edges too (V18); those are inside the triangulation.
std::vector<char> outline_of(TessellatedPatch const& t)
{
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> triangles;
    for (std::size_t i = 0; i + 2 < t.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k)
            ++triangles[std::minmax(t.indices[i + k], t.indices[i + (k + 1) % 3])];
    std::vector<char> out(t.points(), 0);
    for (auto const& [edge, n] : triangles)
        if (n == 1) out[edge.first] = out[edge.second] = 1;
    return out;
}

class Comparison {
public:
    explicit Comparison(ControlMesh const& mesh) : mesh_(mesh) {}

    void add(SurfacePatch const& patch)
    {
        std::size_t const number = ++patches_;
        PatchPlace const& place = patch.place();
        int const n = place.sides;
        MeshInterval edge[4];
        for (int k = 0; k < n; ++k) {
            edge[k] = mesh_interval(mesh_, place, k);
            intervals_[edge[k].line].push_back(std::minmax(edge[k].from, edge[k].to));
        }
        TessellatedPatch const& tess = patch.domain().patch;
        std::vector<char>& outline = outlines_[tess.indices];
        if (outline.empty()) outline = outline_of(tess);
        for (std::size_t i = 0; i < tess.points(); ++i) {
            float const u = patch.domain().u[i], v = patch.domain().v[i];
            DomainEdges<4, float> const at = domain_edges<float>(n, u, v, 1 - u - v, 1 - u, 1 - v);
            auto const edges = std::count(at.on, at.on + n, true);
            if (edges == 0) continue;
            bool const corner = edges > 1;
            MeshPoint const point = mesh_point(mesh_, place, tess.u[i], tess.v[i]);
            Bits const bits = bits_of(patch.vertex(i));
            auto const [it, fresh] = seen_.try_emplace(point, Seen{bits, number});
            Seen& seen = it->second;
            for (int k = 0; k < n && !corner; ++k) // a parameter is a multiple of 2^-16
                if (at.on[k])
                    seen.line = edge[k].line, seen.at = edge[k].at(std::uint32_t(at.t[k] * 65536));
            if (outline[i] && seen.outline_patch != number)
                ++seen.outlines, seen.outline_patch = number;
            if (seen.patch == number) continue;
            seen.patch = number;
            ++seen.patches;
            compare(point, seen.bits, bits, corner);
        }
    }

    EdgeComparison result()
    {
        for (auto const& [point, seen] : seen_) {
            out_.shared_points += seen.patches > 1;
            if (seen.outlines != 1) continue;
            std::size_t inside = 0;
            for (auto const& [low, high] : intervals_[seen.line])
                inside += low < seen.at && seen.at < high;
            out_.lonely_points += inside == 2;
        }
        return std::move(out_);
    }

private:
    void compare(MeshPoint const& point, Bits const& first, Bits const& bits, bool corner)
    {
        bool position = false, normal = false;
        for (std::size_t c = 0; c < 6; ++c) {
            bool const differs = bits[c] != first[c];
            (c < 3 ? position : normal) |= differs;
            if (corner || c >= 3) continue;
            ++out_.shared_edge_coordinates;
            out_.differing_edge_coordinates += differs;
        }
        out_.differing_positions += position;
        out_.differing_normals += normal;
        if ((position || normal) && out_.first_difference.empty())
            out_.first_difference = in_words(point) + (position ? ", position" : ", normal");
    }

    ControlMesh const& mesh_;
    std::size_t patches_ = 0;
    std::unordered_map<MeshPoint, Seen, MeshPointHash> seen_;
    std::map<MeshLine, std::vector<std::pair<std::uint32_t, std::uint32_t>>> intervals_;
    std::map<std::vector<std::uint32_t>, std::vector<char>> outlines_; // by pattern
    EdgeComparison out_;
};

} // namespace

EdgeComparison compare_edges(PatchMesh const& patches, FrameSettings const& s,
                             ThreadPool const& threads, ReplaceDomainShader const& replace)
{
    CommandList list = frame_commands(patches, s, surface_settings(s));
    list.for_each_surface_draw([&](Draw& d) {
        if (DomainShader other = replace ? replace(d) : nullptr)
            d.pipeline.domain_shader = std::move(other);
    });
    Comparison out(patches.mesh().base());
    CommandOptions options;
    options.visit = [&](SurfacePatch const& patch) { out.add(patch); };
    run_commands(list, threads, options);
    return out.result();
}

std::vector<Machine> contraction_policies(std::uint64_t seeds)
{
    std::vector<Machine> out(2);
    out[1].contraction = Contraction::All;
    if (kSlow) seeds = std::min<std::uint64_t>(seeds, 2);
    for (std::uint64_t seed = 1; seed <= seeds; ++seed)
        out.push_back({kNativeLanes, Contraction::Mixed, seed});
    return out;
}

bool meets_case(Machine const& policy, std::size_t i, std::size_t n)
{
    return policy.contraction != Contraction::Mixed || policy.seed % n == i;
}

} // namespace tessemu::test
