// Inputs rebuilt from public reports about other programs, each with its right outcome.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/scheme.h"
#include "tests/cli/program.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace tessemu {
namespace {

struct Row {
    std::string command; ///< $C is the folder of the inputs, $O one for results
    int status;
    std::vector<std::string> says = {};  ///< in what is printed, results and messages
    std::vector<std::string> never = {}; ///< not there
};

// "coverage   skipped" and the like: a verdict's line begins so.
std::string const kCoverageSkipped = "coverage   skipped", kFail = " fail ";

std::vector<Row> const kRows{
    // Open edges that lie on each other.
    {"check $C/cube24.obj", 2, {"24 open edges", "--join"}, {"pass"}},
    {"check $C/cube24.obj --join 1e-6", 0, {"16 vertices are joined"}, {kFail}},
    // Far from the origin, tiny, thin.
    {"check $C/off1e4.obj", 0, {"raycast    pass"}, {kFail}},
    {"check $C/off1e5.obj", 0, {"raycast    pass"}, {kFail}},
    {"check $C/off1e6.obj", 0, {"raycast    pass"}, {kFail}},
    {"check $C/off1e7.obj", 0, {"raycast    pass"}, {kFail}},
    {"check $C/house_far.obj", 0, {"raycast    pass"}, {kFail}},
    {"check $C/house_utm.obj", 0, {"raycast    pass"}, {kFail}},
    {"check $C/house_ecef.obj", 0, {"raycast    pass"}, {kFail}},
    {"check $C/cube_2e-27.obj", 0, {"raycast    pass"}, {kFail}},
    {"check $C/cube_2e-30.obj", 0, {"raycast    pass"}, {kFail}},
    {"check $C/cube_2e-40.obj", 0, {"raycast    pass"}, {kFail}},
    {"check $C/cube_2e-60.obj", 0, {"raycast    pass"}, {kFail}},
    {"check $C/angstrom.obj", 0, {"raycast    pass"}, {kFail}},
    {"check $C/mast_y.obj", 0, {kCoverageSkipped, "no sample was covered"}, {kFail}},
    {"check golem --camera eye=0.1,0.2,0.1:target=1,0.3,0.5", 0, {kCoverageSkipped}, {kFail}},
    // Modelling programs' objects; tags.
    {"draw $C/uvsphere_32_16.obj -o $O/a.png", 0, {"warning", "dispatch"}},
    {"draw $C/uvsphere_16_8.obj -o $O/a.png", 0},
    {"draw $C/cylinder_32.obj -o $O/a.png", 0, {"warning", "dispatch"}},
    {"draw $C/cylinder_16.obj -o $O/a.png", 0, {"warning"}},
    {"draw $C/cone_32.obj -o $O/a.png", 0, {"warning", "dispatch"}},
    {"draw $C/cone_32.obj --view cage -o $O/a.png", 0},
    {"info $C/boundary_none_sharp_grid3.obj", 0, {"7 faces at the boundary are not drawn"}},
    // Every line.
    {"draw $C/vt_one_number.obj --displace $C/ramp.png -o $O/a.png", 0},
    {"draw $C/quad.obj -o $O/a.png", 0},
    {"draw $C/blank_line_inside.obj -o $O/a.png", 2, {"blank_line_inside.obj:16: '3'"}},
    // The tessellator.
    {"tessellate --domain tri --factors 2 2 2 -inf", 0, {"\"-inf\""}},
    {"tessellate --batch $C/blank.txt", 0},
    {"tessellate --batch $C/crlf.txt", 0},
    {"tessellate --partitioning pow2 --factors 5 5 5 5 5 5", 0},
    {"tessellate --help", 0, {"powers of two"}},
    {"tessellate --domain quad --output line --factors 2 2 2 2 2 2", 2, {"R75"}},
    {"tessellate --domain isoline --output triangle_cw --factors 2 2", 2, {"R75"}},
    // What was right.
    {"check $C/cube_cw.obj", 0, {}, {kFail}},
    {"check $C/cube_charts.obj --displace $C/bricks.png --displace-scale 0.2 --tess 13.4",
     0,
     {"displaced  pass"},
     {kFail}},
    {"check $C/caps10.obj", 0, {"coverage   pass"}, {kFail}},
    {"check $C/cube_hole.obj", 0, {kCoverageSkipped}, {kFail}},
    // Two fans at a vertex are taken; --strict refuses them.
    {"check $C/tjunction.obj", 0, {kCoverageSkipped, "several fans"}},
    {"check $C/tjunction.obj --strict", 2, {"tjunction.obj:"}},
    {"draw $C/grid_collapsed_edge.obj --tess-edge pixels=8 -o $O/a.png", 0, {"16 patches"}},
    {"draw $C/smooth_corner_quad.obj -o $O/a.png", 0},
    {"draw $C/pentagon_pair.obj -o $O/a.png", 0, {"warning"}},
};

std::string with_folders(std::string command)
{
    for (auto const& [name, folder] :
         {std::pair{"$C", test::shared("cases")}, std::pair{"$O", test::scratch()}})
        for (std::size_t at; (at = command.find(name)) != std::string::npos;)
            command.replace(at, 2, folder.string());
    return command;
}

TEST(Cases, HaveTheirRightOutcomes)
{
    TESSEMU_NEEDS_SHARED("cases/README.md");
    for (Row const& row : kRows) {
        SCOPED_TRACE(row.command);
        bool const sized = row.command.starts_with("check") || row.command.starts_with("draw");
        test::Result const r =
            test::run(with_folders(row.command) + (sized ? " --size 128x128" : "") +
                      (row.command.starts_with("check") ? " --rays 20000" : ""));
        EXPECT_EQ(r.status, row.status) << r.err;
        std::string const all = r.out + r.err;
        for (std::string const& text : row.says)
            EXPECT_NE(all.find(text), std::string::npos) << text << " in\n" << all;
        for (std::string const& text : row.never)
            EXPECT_EQ(all.find(text), std::string::npos) << text << " in\n" << all;
    }
}

TEST(Cases, EveryThirdPartyCageIsDrawnByTheDefaultScheme)
{
    TESSEMU_NEEDS_SHARED("models/README.md");
    FrameSettings small;
    small.width = small.height = 64;
    small.tess_factor = 3;
    int drawn = 0;
    for (auto const& file : std::filesystem::directory_iterator(test::shared("models"))) {
        if (file.path().extension() != ".obj") continue;
        SCOPED_TRACE(file.path().filename().string());
        SchemeOnMesh const m =
            build_scheme(find_scheme("gregory-stencil"), load_model(file.path().string()).mesh);
        small.camera = frame_points(m.mesh->base().positions, {0.4f, 0.3f, 1}, 1);
        Frame const frame = draw_frame(*m.patches, small, ThreadPool(2));
        EXPECT_GT(frame.statistics.pipeline.PSInvocations, 64u); // a line across has 64
        ++drawn;
    }
    EXPECT_GT(drawn, 0);
}

// Of an OBJ file.
std::vector<std::array<double, 3>> lines_of(std::string const& text, std::string const& keyword)
{
    std::vector<std::array<double, 3>> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string first;
        std::array<double, 3> x{};
        if (words >> first && first == keyword && words >> x[0] >> x[1] >> x[2]) out.push_back(x);
    }
    return out;
}

TEST(Cases, ExportedNormalsAreOfUnitLengthAndAPolesPointsUp)
{
    TESSEMU_NEEDS_SHARED("cases/README.md");
    for (char const* name : {"dome", "grid_collapsed_edge", "quad", "smooth_corner_grid2"}) {
        SCOPED_TRACE(name);
        auto const mesh = test::scratch() / "normals.obj";
        ASSERT_EQ(test::run(with_folders("export $C/" + std::string(name) + ".obj --tess 4 -o ") +
                            mesh.string())
                      .status,
                  0);
        std::string const text = test::read_text(mesh);
        auto const points = lines_of(text, "v"), normals = lines_of(text, "vn");
        ASSERT_EQ(points.size(), normals.size());
        ASSERT_GT(points.size(), 0u);
        std::size_t poles = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            auto const &p = points[i], &n = normals[i];
            // A unit vector in float: 16 units of 2^-24, as tests/pipeline/poles_test.cpp has it.
            EXPECT_NEAR(std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), 1, 16 * 0x1p-24);
            if (std::string(name) != "dome" || std::hypot(p[0], p[1]) > 1e-6 || p[2] < 0.9)
                continue;
            ++poles;
            EXPECT_NEAR(n[2], 1, 16 * 0x1p-24);
        }
        if (std::string(name) == "dome") {
            EXPECT_EQ(poles, 8u * 6); // six points on each of eight collapsed edges
        }
    }
}

} // namespace
} // namespace tessemu
