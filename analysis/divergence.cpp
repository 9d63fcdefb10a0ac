// SPDX-License-Identifier: Apache-2.0
#include "analysis/divergence.h"

namespace tessemu {

namespace {

constexpr std::uint32_t kCurve = 1; // the valence of a vertex on one

// turns(i): of thread i's loop. `branch` of them are on the other side of a branch.
template <class Turns>
LoopTurns in_groups(std::size_t threads, std::size_t width, std::uint32_t branch,
                    Turns const& turns)
{
    LoopTurns out;
    for (std::size_t first = 0; first < threads; first += width) {
        std::size_t const end = std::min(first + width, threads);
        std::uint64_t longest = 0, other_side = 0;
        for (std::size_t i = first; i < end; ++i) {
            std::uint64_t const n = turns(i);
            out.needed += n;
            std::uint64_t& side = n == branch ? other_side : longest;
            side = std::max(side, n);
        }
        out.run += (longest + other_side) * (end - first);
    }
    return out;
}

} // namespace

StepDivergence divergence(SubdivisionTables const& t, int width)
{
    if (width < 1)
        throw Error("threads of a group is " + std::to_string(width) + ", it must be 1 or more");
    auto const in_step = std::size_t(width);
    auto const valence = [](std::vector<std::uint32_t> const& offset_valence) {
        return [&](std::size_t i) { return offset_valence[2 * i + 1]; };
    };
    StepDivergence out;
    if (t.face_offset_valence.empty())
        out.face_points.needed = out.face_points.run = 4 * std::uint64_t(t.faces);
    else
        out.face_points = in_groups(t.faces, in_step, 0, valence(t.face_offset_valence));
    out.vertex_points = in_groups(t.vertices, in_step, kCurve, valence(t.vertex_offset_valence));
    out.blended_points = in_groups(t.blended.target.size(), in_step, 0, [&](std::size_t i) {
        return t.blended.first[i + 1] - t.blended.first[i];
    });
    return out;
}

} // namespace tessemu
