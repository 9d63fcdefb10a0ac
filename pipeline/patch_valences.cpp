// SPDX-License-Identifier: Apache-2.0
#include "pipeline/patch_valences.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <tuple>

namespace tessemu {

namespace {

struct Named {
    std::string_view name;
    std::array<float, 3> color;
};

Named named(int valence)
{
    switch (valence) {
    case PatchValence::kRegular:
        return {"grey", {0.74f, 0.74f, 0.74f}};
    case PatchValence::kBoundary:
        return {"beige", {0.87f, 0.81f, 0.68f}};
    case 3:
        return {"green", {0.36f, 0.74f, 0.40f}};
    case 5:
        return {"red", {0.91f, 0.34f, 0.29f}};
    case 6:
        return {"blue", {0.29f, 0.51f, 0.90f}};
    case 7:
        return {"yellow", {0.96f, 0.82f, 0.22f}};
    case 8:
        return {"violet", {0.63f, 0.39f, 0.84f}};
    case 9:
        return {"cyan", {0.27f, 0.80f, 0.84f}};
    case 10:
        return {"pink", {0.97f, 0.58f, 0.76f}};
    case 11:
        return {"brown", {0.58f, 0.38f, 0.21f}};
    case PatchValence::kLast:
        return {"navy", {0.16f, 0.24f, 0.47f}};
    default:
        return {"black", {0.20f, 0.19f, 0.20f}};
    }
}

} // namespace

std::string_view PatchValence::color_name() const
{
    return named(valence).name;
}

std::array<float, 3> PatchValence::color() const
{
    return named(valence).color;
}

std::string PatchValence::in_words() const
{
    if (valence == kBoundary) return "boundary";
    if (valence == kRegular) return "regular";
    return fmt::format("valence {}", valence);
}

PatchValence patch_valence(Topology const& topology, std::uint32_t face)
{
    auto const vertices = topology.mesh().face(face);
    PatchValence out{int(vertices.size())};
    bool boundary = false;
    auto const distance = [](int n) { return std::pair(std::abs(n - PatchValence::kRegular), n); };
    for (std::uint32_t v : vertices) {
        bool const at_boundary = topology.is_boundary(v);
        boundary = boundary || at_boundary;
        int const n = int(topology.valence(v));
        if (!at_boundary && distance(n) > distance(out.valence)) out.valence = n;
    }
    if (boundary && out.valence == PatchValence::kRegular) out.valence = PatchValence::kBoundary;
    return out;
}

PatchValences::PatchValences(RefinedMesh const& mesh) : faces_(mesh)
{
    for (std::uint32_t f = 0; f < mesh.mesh().faces(); ++f)
        valences_.push_back(patch_valence(mesh.topology(), f).valence);
}

PatchValence PatchValences::operator()(PatchPlace const& place) const
{
    return {valences_[faces_(place).face]};
}

std::vector<std::pair<PatchValence, std::size_t>> count_valences(PatchMesh const& mesh)
{
    PatchValences const valences(mesh.mesh());
    std::map<int, std::size_t> count;
    mesh.commands({}).for_each_surface_draw([&](Draw const& d) {
        for (PatchPlace const& p : d.patches) ++count[valences(p).valence];
    });
    std::vector<std::pair<PatchValence, std::size_t>> out;
    auto const take = [&](int valence) {
        auto const found = count.find(valence);
        if (found == count.end()) return;
        out.push_back({{valence}, found->second});
        count.erase(found);
    };
    take(PatchValence::kRegular);
    auto const boundary = count.extract(PatchValence::kBoundary);
    while (!count.empty()) take(count.begin()->first);
    if (boundary) out.push_back({{PatchValence::kBoundary}, boundary.mapped()});
    return out;
}

std::string valence_legend(PatchMesh const& mesh)
{
    std::string out;
    for (auto const& [v, patches] : count_valences(mesh))
        out += fmt::format("{:<11} {:<7} {:>9} patch{}\n", v.in_words(), v.color_name(), patches,
                           patches == 1 ? "" : "es");
    return out;
}

} // namespace tessemu
