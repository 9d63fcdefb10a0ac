// Patches of different levels of subdivision in one surface, as adaptive schemes draw them: checker
// and comparison know each by its place on the file's mesh.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/compare.h"
#include "analysis/watertight.h"
#include "io/model.h"
#include "pipeline/schemes/scheme.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

// Some faces as they are, the others as four: each half of the faces is hidden from one scheme,
// and both shape the same surface.
class MixedLevels final : public PatchMesh {
public:
    MixedLevels(ControlMesh const& mesh, int coarse_factor)
        : PatchMesh(std::make_shared<RefinedMesh const>(mesh, 0, catmull_clark_step)),
          coarse_factor_(coarse_factor)
    {
        ControlMesh half[2] = {mesh, mesh};
        for (std::uint32_t f = 0; f < mesh.faces(); ++f) half[f % 2].holes.push_back(f);
        coarse_ = build_scheme(find_scheme("gregory-stencil"), half[0]);
        BuildOptions once;
        once.subdivide = 1;
        fine_ = build_scheme(find_scheme("gregory-stencil"), half[1], once);
    }

    CommandList commands(SurfaceSettings const& settings) const override
    {
        SurfaceSettings coarse = settings;
        coarse.tess_factor *= float(coarse_factor_);
        CommandList list = coarse_.patches->commands(coarse);
        CommandList more = fine_.patches->commands(settings);
        for (Command& c : more.commands) list.commands.push_back(std::move(c));
        for (auto& m : more.memory) list.memory.push_back(std::move(m));
        return list;
    }
    std::vector<PatchCount> patch_counts() const override
    {
        return coarse_.patches->patch_counts();
    }

private:
    int coarse_factor_;
    SchemeOnMesh coarse_, fine_;
};

// A torus of 8 x 8 quads without extraordinary vertices: bicubics of every level are one surface.
ControlMesh torus()
{
    ControlMesh m;
    constexpr std::uint32_t n = 8;
    constexpr int kCircle[n][2] = {{2, 0},  {2, 2},   {0, 2},  {-2, 2},
                                   {-2, 0}, {-2, -2}, {0, -2}, {2, -2}};
    for (auto const& big : kCircle)
        for (auto const& small : kCircle)
            m.positions.emplace_back(big[0] * (4 + small[0]), big[1] * (4 + small[0]),
                                     4 * small[1]);
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            auto const at = [&](std::uint32_t a, std::uint32_t b) { return a % n * n + b % n; };
            std::uint32_t const f[4] = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
            m.add_face(f);
        }
    return m;
}

WatertightSettings settings_for(ControlMesh const& mesh)
{
    WatertightSettings s;
    s.rays = 0;
    s.frame.width = s.frame.height = 96;
    s.frame.tess_factor = 4;
    s.frame.partitioning = Partitioning::Integer;
    s.frame.camera = frame_points(mesh.positions, {0.4f, 0.3f, 1}, 1);
    return s;
}

CheckedVerdict topology(std::vector<CheckedVerdict> const& all)
{
    for (CheckedVerdict const& v : all)
        if (v.name == "topology") return v;
    ADD_FAILURE();
    return {};
}

// Twice the segments on an edge twice as long: the same points. With as many segments the long
// edges pass the middles of the short ones by, a T-junction each.
TEST(MixedLevels, TheCheckerTellsMatchingEdgesFromTJunctions)
{
    ControlMesh const mesh = torus();
    WatertightSettings const s = settings_for(mesh);
    ThreadPool const threads;
    CheckedVerdict const closed = topology(check_watertight(MixedLevels(mesh, 2), s, threads));
    EXPECT_EQ(closed.verdict, Verdict::Pass) << (closed.sites.empty() ? "" : closed.sites[0].text);
    // 32 faces of each kind. On each of 64 edges between kinds and 32 between whole faces 7 points
    // inside; 3 on each half of 32 edges between split faces and of 2 lines in each of these.
    EXPECT_EQ(closed.checked, (64u + 32) * 7 + (32 + 32 * 2) * 2 * 3);
    CheckedVerdict const open = topology(check_watertight(MixedLevels(mesh, 1), s, threads));
    EXPECT_EQ(open.verdict, Verdict::Fail);
    // Faces alternate along j: on each of those 64 edges the points at odd eighths are alone.
    EXPECT_EQ(open.failures, 64u * 4);
}

// Each patch, of whatever level, is compared with the limit of its own part of the face: a regular
// mesh has no error but of rounding, nor a patch that the comparison would put elsewhere.
TEST(MixedLevels, TheComparisonFindsEachPatchOnItsFace)
{
    ControlMesh const mesh = torus();
    FrameSettings frame;
    for (int level : {1, 3}) {
        EqualParameterErrors const e =
            equal_parameter_errors(MixedLevels(mesh, 2), frame, level, ThreadPool());
        ErrorStatistics const position = e.position_statistics();
        // Every face, whole or split, has 2^(level-1) + 1 points a side at least: all are compared.
        EXPECT_GT(position.samples, mesh.faces() * (1u << (2 * (level - 1))));
        // Control points and points are sums of at most 16 products each, rounded once a product
        // and a sum: 2 (16 + 16) units of 2^-24 of the largest coordinate, which the diagonal
        // exceeds.
        EXPECT_LE(position.max, 64 * 0x1p-24);
    }
}

} // namespace
} // namespace tessemu
