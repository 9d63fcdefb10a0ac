// What cracks in the scheme of tables: the shares of docs/bolz03.md, of order and of weights.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/watertight.h"
#include "io/model.h"
#include "pipeline/basis_tables/table_store.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/printed.h"
#include "tests/support/sanitized.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace tessemu {
namespace {

/// Tables as another generator might have made them: each weight an ulp of single precision above
/// or below ours.
class NoisyTables : public BasisTableStore {
public:
    std::optional<BasisTables> find(PatchType const& type) override
    {
        BasisTables out = make_basis_tables(type);
        for (auto* table : {&out.position, &out.du, &out.dv})
            for (double& w : *table) {
                auto const x = float(w);
                if (x != 0) w = std::nextafter(x, random_() & 1 ? INFINITY : -INFINITY);
            }
        return out;
    }
    void keep(PatchType const&, BasisTables const&) override {}

private:
    std::mt19937 random_{1};
};

// The same surface, its vertices and faces numbered at random.
ControlMesh in_random_order(ControlMesh const& mesh)
{
    std::mt19937 random(1);
    auto const shuffled = [&](std::size_t n) {
        std::vector<std::uint32_t> out(n);
        std::iota(out.begin(), out.end(), 0u);
        for (std::size_t i = n; i > 1; --i) std::swap(out[i - 1], out[random() % i]);
        return out;
    };
    std::vector<std::uint32_t> const vertices = shuffled(mesh.positions.size());
    ControlMesh out;
    out.name = mesh.name;
    out.positions.resize(vertices.size());
    for (std::size_t v = 0; v < vertices.size(); ++v)
        out.positions[vertices[v]] = mesh.positions[v];
    for (std::uint32_t f : shuffled(mesh.faces())) {
        std::vector<std::uint32_t> face;
        for (std::uint32_t v : mesh.face(f)) face.push_back(vertices[v]);
        out.add_face(face);
    }
    return out;
}

struct Cracked {
    double position, normal; ///< shares of the shared points, in percent
};

Cracked cracked(ControlMesh const& mesh, bool is_noisy, ParameterTexts const& set)
{
    NoisyTables noisy;
    BuildOptions options;
    options.set = set;
    options.tables = is_noisy ? &noisy : nullptr;
    SchemeOnMesh const on = build_scheme(find_scheme("bolz"), mesh, options);
    WatertightSettings s;
    s.frame.tess_factor = 32;
    s.frame.width = s.frame.height = 16;
    s.rays = 0;
    auto const verdicts = check_watertight(*on.patches, s, ThreadPool(0));
    auto const share = [](CheckedVerdict const& v) {
        EXPECT_GT(v.checked, 10000u);
        return 100.0 * double(v.failures) / double(v.checked);
    };
    EXPECT_EQ(verdicts[1].name + verdicts[2].name, "positionnormal");
    return {share(verdicts[1]), share(verdicts[2])};
}

TEST(BolzCracks, AreTheSharesOfThePage)
{
    if (test::kSlow) GTEST_SKIP() << "shares are those of any build; other tests run this code";
    ControlMesh const golem = load_model("golem").mesh;
    std::size_t compared = 0;
    for (auto const& row : test::table_of("docs/bolz03.md", "| tables | sums")) {
        ASSERT_EQ(row.size(), 7u);
        SCOPED_TRACE(row[0] + ", " + row[1]);
        bool const is_noisy = row[0].starts_with("an ulp off");
        ParameterTexts const set{
            {"tables", row[0].ends_with(", enforced") ? "enforced" : "unenforced"},
            {"order", row[1] == "global" ? "global" : "table"}};
        Cracked const ours[] = {cracked(golem, is_noisy, set),
                                cracked(in_random_order(golem), is_noisy, set)};
        for (std::size_t i = 0; i < 4; ++i) {
            Cracked const& c = ours[i / 2];
            double const percent = i % 2 == 0 ? c.position : c.normal;
            EXPECT_TRUE(test::printed(row[2 + i]).rounds_from(percent)) << i << ": " << percent;
            // Closed is closed, and no share that is rounded to 0.
            EXPECT_EQ(row[2 + i] == "0", percent == 0) << i << ": " << percent;
            ++compared;
        }
    }
    EXPECT_EQ(compared, 4u * 6);
}

} // namespace
} // namespace tessemu
