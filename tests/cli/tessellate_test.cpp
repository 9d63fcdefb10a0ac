// The verb tessellate.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/builtin_models.h"
#include "tests/cli/program.h"
#include "tests/io/picture_hash.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace tessemu {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

using test::Result;
using test::run;
using test::scratch;

TEST(Program, TessellateBatchAnswersTheGoldenCases)
{
    fs::path const golden = TESSEMU_GOLDEN_BATCH;
    Result const r = run("tessellate --batch " + (golden / "cases.txt").string());
    ASSERT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(r.out, test::read_text(golden / "expected.txt"));
}

TEST(Program, AMalformedBatchLineIsNamed)
{
    fs::path const batch = scratch() / "batch.txt";
    for (char const* bad :
         {"quad integer", "quad integer triangle_cw 3f800000", "cube integer point 0",
          "tri integer point 3f800000 3f800000 3f800000 zzzzzzzz", "", "\r"}) {
        std::ofstream(batch) << "isoline integer line 3f800000 3f800000\n"
                             << bad << "\nisoline integer line 3f800000 3f800000\n";
        Result const r = run("tessellate --batch " + batch.string());
        EXPECT_EQ(r.status, 2) << bad;
        EXPECT_NE(r.err.find("batch.txt:2:"), std::string::npos) << r.err;
        EXPECT_TRUE(r.out.empty()) << bad;
    }
}

TEST(Program, EmptyLinesBehindABatchAndTheEndingsOfLinesChangeNothing)
{
    fs::path const batch = scratch() / "batch.txt";
    std::string const a = "isoline integer line 3f800000 3f800000",
                      b = "tri integer triangle_cw 40000000 40000000 40000000 40000000";
    std::ofstream(batch) << a + "\n" + b + "\n";
    Result const plain = run("tessellate --batch " + batch.string());
    ASSERT_EQ(plain.status, 0) << plain.err;
    EXPECT_TRUE(plain.err.empty());
    EXPECT_EQ(std::count(plain.out.begin(), plain.out.end(), '\n'), 2);
    for (std::string const& text : {a + "\r\n" + b + "\r\n", a + "\n" + b, a + "\n" + b + "\n\n",
                                    a + "\n" + b + "\n \n\r\n\n"}) {
        std::ofstream(batch) << text;
        Result const r = run("tessellate --batch " + batch.string());
        EXPECT_EQ(r.status, 0) << r.err;
        EXPECT_EQ(r.out, plain.out);
    }
    // The golden cases have outputs that Direct3D 11 forbids.
    std::ofstream(batch) << a + "\nquad integer line 3f800000 3f800000 3f800000 3f800000 "
                                "3f800000 3f800000\n";
    Result const illegal = run("tessellate --batch " + batch.string());
    EXPECT_EQ(illegal.status, 0);
    EXPECT_NE(illegal.err.find("batch.txt:2: Direct3D 11 has no such output"), std::string::npos)
        << illegal.err;
    EXPECT_NE(illegal.err.find("R75"), std::string::npos);
}

TEST(Program, TessellateTakesAnyFloatAndKeepsWhatWasAsked)
{
    auto const patch = [](std::string const& arguments) {
        Result const r = run("tessellate " + arguments);
        EXPECT_EQ(r.status, 0) << arguments << ": " << r.err;
        return r.status == 0 ? Json::parse(r.out) : Json();
    };
    Json const inside = patch("--domain tri --partitioning integer --factors 2 2 2 -inf");
    EXPECT_EQ(inside["config"]["factors"], Json::parse(R"([2.0, 2.0, 2.0, "-inf"])"));
    EXPECT_EQ(inside["case"], "tri integer triangle_cw 40000000 40000000 40000000 ff800000");
    // To the smallest, which is the same for NaN.
    Json const one = patch("--domain tri --partitioning integer --factors 2 2 2 1"),
               nan = patch("--domain tri --partitioning integer --factors 2 2 2 nan"),
               negative = patch("--domain tri --partitioning integer --factors 2 2 2 -.5");
    EXPECT_GT(one["points"], 0);
    for (Json const& same : {inside, nan, negative}) EXPECT_EQ(same["indices"], one["indices"]);
    EXPECT_EQ(nan["config"]["factors"][3], "nan");
    // At an edge: culled.
    for (std::string const factor : {"-inf", "nan", "-1", "0", "-nan", "-1e-40"})
        EXPECT_EQ(patch("--domain tri --factors 2 " + factor + " 2 2")["points"], 0) << factor;
    Json const most = patch("--domain tri --factors inf 2 2 2");
    EXPECT_EQ(most["u"], patch("--domain tri --factors 63 2 2 2")["u"]);
    EXPECT_EQ(most["config"]["factors"][0], "inf");
    // R59: pow2 is the hull shader's part.
    EXPECT_EQ(patch("--partitioning pow2 --factors 5 5 5 5 5 5")["u"],
              patch("--partitioning integer --factors 5 5 5 5 5 5")["u"]);
    EXPECT_NE(run("tessellate --help").out.find("R59"), std::string::npos);
}

TEST(Program, TessellateRefusesOutputsThatDirect3D11Forbids)
{
    for (char const* bad : {"--domain quad --output line --factors 1 1 1 1 1 1",
                            "--domain tri --output line --factors 1 1 1 1",
                            "--domain isoline --output triangle_cw --factors 1 1",
                            "--domain isoline --output triangle_ccw --factors 1 1"}) {
        Result const r = run(std::string("tessellate ") + bad);
        EXPECT_EQ(r.status, 2) << bad;
        EXPECT_NE(r.err.find("R75"), std::string::npos) << r.err;
        EXPECT_TRUE(r.out.empty());
    }
    for (char const* good : {"--domain quad --output point --factors 1 1 1 1 1 1",
                             "--domain tri --output triangle_ccw --factors 1 1 1 1",
                             "--domain isoline --output point --factors 1 1"})
        EXPECT_EQ(run(std::string("tessellate ") + good).status, 0) << good;
    EXPECT_EQ(Json::parse(run("tessellate --domain isoline --factors 2 3").out)["config"]["output"],
              "line");
}

TEST(Program, TessellateGivesOnePatchAsJson)
{
    Result const r = run("tessellate --domain quad --partitioning integer --factors 1 1 1 1 1 1");
    ASSERT_EQ(r.status, 0) << r.err;
    Json const j = Json::parse(r.out);
    EXPECT_EQ(j["u"], (std::vector<int>{0, 65536, 65536, 0}));
    EXPECT_EQ(j["indices"], (std::vector<int>{0, 1, 3, 1, 2, 3}));
}

} // namespace
} // namespace tessemu
