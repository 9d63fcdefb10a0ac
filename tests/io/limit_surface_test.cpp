// Patch corners lie on the Catmull-Clark limit surface.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/files.h"
#include "tests/support/limit_samples.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace tessemu {
namespace {

struct LimitCorners {
    double diagonal = 0;
    std::map<std::pair<std::uint32_t, int>, std::array<double, 3>> at; // (face, corner)
};

LimitCorners read_limit(std::filesystem::path const& path, ControlMesh const& mesh)
{
    test::LimitSamples const limit = test::read_limit_samples(path);
    LimitCorners out{limit.diagonal, {}};
    for (auto const& s : limit.samples) {
        auto const is = [&](double u, double v) {
            return std::abs(s.u - u) < 1e-9 && std::abs(s.v - v) < 1e-9;
        };
        int corner = -1;
        if (mesh.face(s.face).size() == 4) {
            if (is(0, 0)) corner = 0;
            if (is(1, 0)) corner = 1;
            if (is(1, 1)) corner = 2;
            if (is(0, 1)) corner = 3;
        } else if (is(0, 0)) {
            corner = s.sub; // sub-face i starts at vertex i
        }
        if (corner >= 0) out.at[{s.face, corner}] = {s.position.x, s.position.y, s.position.z};
    }
    return out;
}

class LimitSurfaceOn : public testing::TestWithParam<char const*> {};

TEST_P(LimitSurfaceOn, ExportedPatchCornersAgreeToOneMillionthOfTheDiagonal)
{
    std::string const name = GetParam();
    TESSEMU_NEEDS_SHARED("models/" + name + ".obj");
    TESSEMU_NEEDS_SHARED("golden/limit/" + name + ".csv.gz");
    SchemeOnMesh const m =
        build_scheme(find_scheme("gregory-stencil"),
                     load_model(test::shared("models/" + name + ".obj").string()).mesh);
    LimitCorners const limit =
        read_limit(test::shared("golden/limit/" + name + ".csv.gz"), m.mesh->base());
    std::size_t compared = 0;
    double worst = 0;
    visit_surface(*m.patches, {}, ThreadPool(), [&](SurfacePatch const& patch) {
        PatchPlace const& place = patch.place();
        for (std::size_t i = 0; i < patch.points(); ++i) {
            UnitPoint const at = domain_to_unit(place, patch.domain().u[i], patch.domain().v[i]);
            int corner;
            if (place.sides == 4)
                corner = at.v == 0 ? (at.u == 0 ? 0 : 1) : (at.u == 1 ? 2 : 3);
            else
                corner = at.u == 1 ? 0 : at.v == 1 ? 1 : 2;
            auto const it = limit.at.find({place.face, corner});
            ASSERT_NE(it, limit.at.end());
            glm::vec3 const p = patch.vertex(i).position;
            double d2 = 0;
            for (int k = 0; k < 3; ++k)
                d2 += std::pow(double(p[k]) - it->second[std::size_t(k)], 2);
            worst = std::max(worst, std::sqrt(d2) / limit.diagonal);
            ++compared;
        }
    });
    EXPECT_EQ(compared, limit.at.size());
    EXPECT_LE(worst, 1e-6);
    RecordProperty("corners", std::to_string(compared));
    RecordProperty("worst_distance_in_diagonals", fmt::format("{:.2g}", worst));
}
INSTANTIATE_TEST_SUITE_P(Models, LimitSurfaceOn,
                         testing::Values("bigguy", "monsterfrog", "suzanne", "chamfer_cube",
                                         "catmark_torus"));

} // namespace
} // namespace tessemu
