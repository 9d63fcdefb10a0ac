// SPDX-License-Identifier: Apache-2.0
#include "tests/support/edges.h"

#include <fmt/format.h>

#include <cstring>
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
};
} // namespace

EdgeComparison compare_edges(ControlMesh const& mesh, PatchMesh const& patches,
                             FrameSettings const& s, ThreadPool const& threads,
                             ReplaceDomainShader const& replace)
{
    EdgeComparison out;
    std::unordered_map<Place, Seen, PlaceHash> seen;
    PassSettings settings;
    settings.tess_factor = s.tess_factor;
    settings.partitioning = s.partitioning;
    settings.machine = s.machine;
    for (DrawPass const& pass : patches.passes(settings)) {
        GraphicsPipelineDesc desc = pass.pipeline.desc();
        if (replace)
            if (auto const other = replace(pass)) desc.domain_shader = other;
        auto const visit = [&](ShadedPatch const& patch) {
            PatchOrigin const& origin = pass.patches[patch.primitive_id];
            auto const face = mesh.face(origin.face);
            int const n = origin.sides;
            auto const vertex = [&](int i) { return face[std::size_t((i + origin.rotation) % n)]; };
            auto const& tess = patch.points->patch;
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
                    if (fresh) continue;
                    Seen& other = it->second;
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
        draw(GraphicsPipeline(std::move(desc)), pass.call, nullptr, visit, threads);
    }
    return out;
}

} // namespace tessemu::test
