// docs/new_scheme.md: its code blocks, built as they stand there, are a scheme.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/frame.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <bit>
#include <sstream>

namespace tessemu {

// The page's make_phong; the build gives its names another beginning beside the project's.
std::unique_ptr<Scheme> make_page_phong();

namespace {

// A closed cage of triangles.
ControlMesh octahedron()
{
    ControlMesh m;
    m.positions = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1.5f}, {0, 0, -1}};
    for (std::uint32_t i = 0; i < 4; ++i) {
        m.add_face(std::array{i, (i + 1) % 4, 4u});
        m.add_face(std::array{(i + 1) % 4, i, 5u});
    }
    return m;
}

struct Drawn {
    std::vector<std::uint32_t> bits;
    DrawStatistics statistics;
};
Drawn surface(SchemeOnMesh const& on, Machine const& machine)
{
    FrameSettings s;
    s.tess_factor = 5.3f;
    s.machine = machine;
    Drawn out;
    out.statistics = visit_surface(*on.patches, s, ThreadPool(2), [&](SurfacePatch const& p) {
                         for (std::size_t i = 0; i < p.points(); ++i)
                             for (float x : p.scalars(i))
                                 out.bits.push_back(std::bit_cast<std::uint32_t>(x));
                     }).total;
    return out;
}

TEST(NewSchemePage, ItsCodeDrawsAndCountsWhatTheProjectsOwnSchemeDoes)
{
    auto const page = make_page_phong();
    SchemeOnMesh const own = build_scheme(find_scheme("phong"), octahedron()),
                       theirs = build_scheme(*page, octahedron());
    for (Machine const& machine : {Machine{}, Machine{kNativeLanes, Contraction::All},
                                   Machine{kNativeLanes, Contraction::Mixed, 7}}) {
        Drawn const a = surface(own, machine), b = surface(theirs, machine);
        ASSERT_GT(a.bits.size(), 1000u);
        EXPECT_EQ(a.bits, b.bits);
        EXPECT_EQ(a.statistics, b.statistics);
    }
    Frame const picture = draw_frame(*theirs.patches, FrameSettings{}, ThreadPool(2));
    EXPECT_GT(picture.statistics.pipeline.PSInvocations, 1000u);
    EXPECT_THROW(build_scheme(*page, octahedron(), {0, {{"alpha", "2"}}}), Error);
}

TEST(NewSchemePage, ItIsAsShortAsItSays)
{
    std::istringstream page(test::read_text(test::source("docs/new_scheme.md")));
    int lines = 0;
    bool inside = false;
    for (std::string line; std::getline(page, line);) {
        if (line.starts_with("```"))
            inside = !inside;
        else if (inside && !line.empty())
            ++lines;
    }
    EXPECT_GT(lines, 50);
    EXPECT_LT(lines, 100);
}

} // namespace
} // namespace tessemu
