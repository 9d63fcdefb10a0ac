// Schemes of isolated nets, stam and its like: what their tests share.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/watertight.h"
#include "pipeline/schemes/scheme.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

namespace tessemu::test {

inline ParameterTexts const kSharedEdges{{"edges", "shared"}};
/// Every way in which edges and regular patches are drawn.
inline std::vector<ParameterTexts> all_choices()
{
    std::vector<ParameterTexts> out;
    for (char const* edges : {"paper", "shared"})
        for (char const* regular : {"bezier", "bspline"})
            out.push_back({{"edges", edges}, {"regular", regular}});
    return out;
}

// A closed strip of four quads around an axis, with vertices of two edges at its ends.
inline ControlMesh with_valence_two()
{
    ControlMesh m;
    m.positions = {{0, 0, 1}, {1, 0, 0}, {0, 0, -1}, {-1, 0, 0}, {0.5f, 1, 0}, {-0.5f, 1, 0}};
    m.add_face(std::array<std::uint32_t, 4>{0, 1, 2, 4});
    m.add_face(std::array<std::uint32_t, 4>{0, 4, 2, 5});
    m.add_face(std::array<std::uint32_t, 4>{0, 5, 2, 3});
    m.add_face(std::array<std::uint32_t, 4>{0, 3, 2, 1});
    return m;
}

// A face at the boundary of the refined mesh has a vertex there.
inline std::size_t boundary_faces(Topology const& t)
{
    std::size_t out = 0;
    for (std::uint32_t f = 0; f < t.mesh().faces(); ++f) {
        auto const face = t.mesh().face(f);
        out += std::any_of(face.begin(), face.end(),
                           [&](std::uint32_t v) { return t.is_boundary(v); });
    }
    return out;
}

inline std::size_t patches_of(PatchMesh const& m, std::string const& kind)
{
    for (PatchCount const& c : m.patch_counts())
        if (c.kind.name == kind) return c.patches;
    return 0;
}

// Without rays.
inline std::map<std::string, CheckedVerdict> checked(PatchMesh const& patches, WatertightSettings s)
{
    s.rays = 0;
    s.frame.width = s.frame.height = 64;
    std::map<std::string, CheckedVerdict> out;
    for (CheckedVerdict& v : check_watertight(patches, s, ThreadPool())) out[v.name] = std::move(v);
    return out;
}

} // namespace tessemu::test
