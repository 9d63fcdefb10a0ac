// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/valence_type.h"

#include <algorithm>

namespace tessemu {

namespace {
constexpr int kLeast = 3, kMost = 12, kRegular = 4, kHullShaderInputs = 32;
} // namespace

int ValenceType::inputs() const
{
    int n = 4;
    for (int v : valence) n += 2 * v - 5;
    return n;
}

bool ValenceType::is_of_loop10() const
{
    return inputs() <= kHullShaderInputs && std::all_of(valence.begin(), valence.end(), [](int n) {
               return n >= kLeast && n <= kMost;
           });
}

bool ValenceType::is_isolated() const
{
    return std::count(valence.begin(), valence.end(), kRegular) >= 3;
}

ValenceType valence_type(std::array<int, 4> valence)
{
    ValenceType best{valence};
    for (int r = 1; r < 4; ++r) {
        std::rotate(valence.begin(), valence.begin() + 1, valence.end());
        best = std::min(best, ValenceType{valence});
    }
    return best;
}

std::optional<ValenceType> valence_type(Neighbourhood const& patch)
{
    if (patch.sides != 4) return {};
    std::array<int, 4> valence{};
    for (std::size_t i = 0; i < 4; ++i) {
        CornerNeighbourhood const& c = patch.corner[i];
        if (c.boundary ||
            std::any_of(c.faces.begin(), c.faces.end(), [](auto const& f) { return f.sides != 4; }))
            return {};
        valence[i] = int(c.faces.size());
    }
    return valence_type(valence);
}

std::vector<ValenceType> valence_types(int max_inputs)
{
    std::vector<ValenceType> out;
    for (int a = kLeast; a <= kMost; ++a)
        for (int b = a; b <= kMost; ++b) // a smallest sequence begins with its smallest number
            for (int c = a; c <= kMost; ++c)
                for (int d = a; d <= kMost; ++d)
                    if (ValenceType const t{{a, b, c, d}};
                        t.inputs() <= max_inputs && valence_type(t.valence) == t)
                        out.push_back(t);
    return out;
}

std::vector<ValenceType> isolated_valence_types()
{
    std::vector<ValenceType> out;
    for (int n = kLeast; n <= kMost; ++n)
        out.push_back(valence_type(std::array{n, kRegular, kRegular, kRegular}));
    return out;
}

ControlMesh one_ring_cage(ValenceType const& type)
{
    // A corner's edges beyond the face: counter-clockwise, the first is that of the face across the
    // edge to the corner before, the last that of the face across the edge to the next.
    std::array<std::vector<std::uint32_t>, 4> spokes;
    std::uint32_t vertices = 4;
    for (std::size_t i = 0; i < 4; ++i)
        for (int k = 2; k < type.valence[i]; ++k) spokes[i].push_back(vertices++);
    ControlMesh mesh;
    mesh.add_face(std::vector<std::uint32_t>{0, 1, 2, 3});
    for (std::uint32_t i = 0; i < 4; ++i) {
        std::uint32_t const next = (i + 1) % 4;
        mesh.add_face(std::vector<std::uint32_t>{next, i, spokes[i].back(), spokes[next].front()});
        for (std::size_t k = 0; k + 1 < spokes[i].size(); ++k)
            mesh.add_face(
                std::vector<std::uint32_t>{i, spokes[i][k], vertices++, spokes[i][k + 1]});
    }
    mesh.positions.resize(vertices);
    return mesh;
}

} // namespace tessemu
