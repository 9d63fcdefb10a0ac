// SPDX-License-Identifier: Apache-2.0
#include "tests/support/edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <unordered_map>

namespace tessemu::test {

namespace {
struct Place {
    std::uint32_t a, b,
        t; // edge a < b with the parameter from a in 1/65536, or corner a with b = a
    friend bool operator==(Place const&, Place const&) = default;
};
struct PlaceHash {
    std::size_t operator()(Place const& p) const
    {
        return ((std::size_t(p.a) * 0x9e3779b97f4a7c15u) ^ (std::size_t(p.b) << 20) ^ p.t) *
               0xbf58476d1ce4e5b9u;
    }
};
struct Seen {
    std::array<std::uint32_t, 6> bits;
    bool shared = false;
    bool outline = false; // of a patch's triangles
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
} // namespace

EdgeComparison compare_edges(ControlMesh const& mesh, PatchMesh const& patches,
                             FrameSettings const& s, ThreadPool const& threads,
                             ReplaceDomainShader const& replace)
{
    EdgeComparison out;
    std::unordered_map<Place, Seen, PlaceHash> seen;
    for (DrawPass& pass : frame_passes(patches, s, pass_settings(s))) {
        GraphicsPipelineDesc desc = pass.pipeline.desc();
        if (replace)
            if (auto const other = replace(pass)) desc.domain_shader = other;
        std::map<std::vector<std::uint32_t>, std::vector<char>> outlines; // by pattern
        auto const visit = [&](ShadedPatch const& patch) {
            PatchOrigin const& origin = pass.patches[patch.primitive_id];
            auto const face = mesh.face(origin.face);
            int const n = origin.sides;
            auto const vertex = [&](int i) { return face[std::size_t((i + origin.rotation) % n)]; };
            auto const& tess = patch.points->patch;
            std::vector<char>& outline = outlines[tess.indices];
            if (outline.empty()) outline = outline_of(tess);
            for (std::size_t i = 0; i < tess.points(); ++i) {
                std::uint32_t const u = tess.u[i], v = tess.v[i], one = kFixedOne;
                std::uint32_t const w = one - u - v;
                bool on[4];
                std::uint32_t t[4];
                if (n == 4) {
                    on[0] = v == 0, on[1] = u == one, on[2] = v == one, on[3] = u == 0;
                    t[0] = u, t[1] = v, t[2] = one - u, t[3] = one - v;
                } else {
                    on[0] = w == 0, on[1] = u == 0, on[2] = v == 0;
                    t[0] = v, t[1] = w, t[2] = u;
                }
                for (int k = 0; k < n; ++k) {
                    if (!on[k]) continue;
                    std::uint32_t a = vertex(k), b = vertex(k + 1), parameter = t[k];
                    bool const corner = parameter == 0 || parameter == one;
                    if (corner) {
                        a = b = parameter == 0 ? a : b;
                        parameter = 0;
                    } else if (a > b) {
                        std::swap(a, b);
                        parameter = one - parameter;
                    }
                    std::array<std::uint32_t, 6> bits;
                    constexpr std::size_t component[6] = {0, 1, 2, 4, 5, 6};
                    for (std::size_t c = 0; c < 6; ++c)
                        std::memcpy(&bits[c], &patch.outputs[component[c] * patch.stride + i], 4);
                    auto const [it, fresh] = seen.try_emplace({a, b, parameter}, Seen{bits});
                    Seen& other = it->second;
                    other.outline |= outline[i] != 0;
                    if (fresh) continue;
                    if (!other.shared) ++out.shared_points;
                    other.shared = true;
                    bool position = false, normal = false;
                    for (std::size_t c = 0; c < 6; ++c) {
                        bool const differs = bits[c] != other.bits[c];
                        (c < 3 ? position : normal) |= differs;
                        if (!corner && c < 3) {
                            ++out.shared_edge_coordinates;
                            out.differing_edge_coordinates += differs;
                        }
                    }
                    out.differing_positions += position;
                    out.differing_normals += normal;
                    if ((position || normal) && out.first_difference.empty())
                        out.first_difference =
                            fmt::format("edge {}-{}, t = {}/65536, {}", a + 1, b + 1, parameter,
                                        position ? "position" : "normal");
                }
            }
        };
        pass.pipeline = GraphicsPipeline(std::move(desc));
        draw_pass(pass, nullptr, visit, threads);
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> patches_at;
    for (std::size_t f = 0; f < mesh.faces(); ++f) {
        auto const face = mesh.face(f);
        for (std::size_t i = 0; i < face.size(); ++i)
            ++patches_at[std::minmax(face[i], face[(i + 1) % face.size()])];
    }
    for (auto const& [place, point] : seen)
        if (place.a != place.b && point.outline && !point.shared &&
            patches_at[{place.a, place.b}] == 2)
            ++out.lonely_points;
    return out;
}

} // namespace tessemu::test
