// A modelling program's first objects, and whatever models the shared folder has, are drawn and
// checked by the default commands.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/program.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace tessemu {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using test::Result;
using test::run;
using test::scratch;

std::uint64_t pixels(Json const& result)
{
    return result["counters"]["PSInvocations"].get<std::uint64_t>();
}

TEST(Shapes, AModellingProgramsFirstObjectsAreDrawn)
{
    for (test::Shape const& shape : test::first_objects()) {
        SCOPED_TRACE(shape.name);
        fs::path const model = scratch() / "shape.obj", json = scratch() / "shape.json",
                       picture = scratch() / "shape.png";
        std::ofstream(model) << test::obj_of(shape);
        Result const r =
            run("draw " + model.string() + " -o " + picture.string() + " --json " + json.string());
        ASSERT_EQ(r.status, 0) << r.err;
        EXPECT_TRUE(fs::exists(picture));
        Json const result = Json::parse(test::read_text(json));
        // The camera frames the sphere around the object: more than a twentieth of the picture.
        EXPECT_GT(pixels(result), 1024u * 1024 / 20);
        // Quads and triangles stay; a face of more sides makes quads of all; faces of a pole's
        // vertex are the only ones with another way.
        bool const wide =
            shape.name == "UV sphere" || shape.name == "cylinder" || shape.name == "cone";
        EXPECT_EQ(r.err.find("dispatch") != std::string::npos, wide) << r.err;
        bool const polygons = shape.name == "cylinder" || shape.name == "cone";
        EXPECT_EQ(r.err.find("more than 4 sides") != std::string::npos, polygons) << r.err;
    }
}

TEST(Shapes, AModellingProgramsFirstObjectsAreClosedOrOpenAsTheyAre)
{
    for (test::Shape const& shape : test::first_objects()) {
        SCOPED_TRACE(shape.name);
        fs::path const model = scratch() / "shape.obj", json = scratch() / "check.json";
        std::ofstream(model) << test::obj_of(shape);
        Result const r = run("check " + model.string() + " --json " + json.string());
        // A plane of one face shares no edge, and nothing of it can be checked.
        ASSERT_EQ(r.status, shape.name == "plane" ? 2 : 0) << r.out << r.err;
        Json const result = Json::parse(test::read_text(json));
        EXPECT_EQ(result["verdicts"].size(), 6u);
        for (auto const& [name, verdict] : result["verdicts"].items()) {
            SCOPED_TRACE(name);
            std::string const word = verdict["verdict"];
            EXPECT_NE(word, "fail") << verdict.dump();
            bool const edges = name == "position" || name == "normal" || name == "topology";
            if (name == "displaced" || shape.name == "plane")
                EXPECT_EQ(word, "skipped");
            else
                EXPECT_EQ(word, shape.closed || edges ? "pass" : "skipped");
        }
    }
}

} // namespace
} // namespace tessemu
