// A height map from its file to an exported mesh: every sample counts as it is.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/program.h"
#include "tests/io/raw_image.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <fstream>
#include <sstream>

namespace tessemu {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using test::run;

// An image of gray and alpha, 16 bits each, over a square of n x n faces in the plane z = 0 whose
// texture coordinates go from `low` to `high`. All positions are whole multiples of 1/n.
struct Terrain {
    int width, height, faces;
    double low, high;
    std::vector<std::uint16_t> heights;

    Terrain(int width_, int height_, int faces_, double low_, double high_)
        : width(width_),
          height(height_),
          faces(faces_),
          low(low_),
          high(high_)
    {
        std::uint32_t state = 11;
        std::vector<std::uint16_t> numbers;
        for (int i = 0; i < width * height; ++i) {
            state = state * 1664525u + 1013904223u;
            heights.push_back(std::uint16_t(state >> 16));
            // Alpha is 0 or small at most texels: multiplied by it no height would be left.
            numbers.insert(numbers.end(), {heights.back(), std::uint16_t(i % 3 == 0   ? 0
                                                                         : i % 3 == 1 ? 90
                                                                                      : 65535)});
        }
        test::write_raw_image(image(), width, height, {"Y", "A"}, numbers);
        std::ofstream obj(cage());
        obj.precision(17);
        for (int j = 0; j <= faces; ++j)
            for (int i = 0; i <= faces; ++i)
                obj << "v " << double(i) / faces << " " << double(j) / faces << " 0\nvt "
                    << coordinate(double(i) / faces) << " " << coordinate(double(j) / faces)
                    << "\n";
        for (int j = 0; j < faces; ++j)
            for (int i = 0; i < faces; ++i) {
                obj << "f";
                int const v = j * (faces + 1) + i + 1;
                for (int k : {v, v + 1, v + faces + 2, v + faces + 1}) obj << " " << k << "/" << k;
                obj << "\n";
            }
    }
    static fs::path image() { return test::scratch() / "heights.png"; }
    static fs::path cage() { return test::scratch() / "terrain.obj"; }
    double coordinate(double x) const { return low + (high - low) * x; }

    double texel(int x, int y, std::string const& wrap) const
    {
        auto const address = [&](int i, int n) {
            if (wrap == "clamp") return std::min(std::max(i, 0), n - 1);
            int const period = wrap == "mirror" ? 2 * n : n, m = ((i % period) + period) % period;
            return m < n ? m : 2 * n - 1 - m;
        };
        return heights[std::size_t(address(y, height) * width + address(x, width))] / 65535.0;
    }
    struct Sample {
        double height;
        glm::dvec2 slope; ///< along x and y of the square
        double from_line; ///< distance to the nearest line of texels' centres, in texels
    };
    // The bilinear formula at a point of the square.
    Sample sample(double x, double y, std::string const& wrap) const
    {
        double const s = coordinate(x) * width - 0.5, t = (1 - coordinate(y)) * height - 0.5;
        double const i = std::floor(s), j = std::floor(t), fs = s - i, ft = t - j;
        auto const at = [&](int a, int b) { return texel(int(i) + a, int(j) + b, wrap); };
        double const h00 = at(0, 0), h10 = at(1, 0), h01 = at(0, 1), h11 = at(1, 1);
        double const along_s = (1 - ft) * (h10 - h00) + ft * (h11 - h01),
                     along_t = (1 - fs) * (h01 - h00) + fs * (h11 - h10);
        return {(1 - ft) * ((1 - fs) * h00 + fs * h10) + ft * ((1 - fs) * h01 + fs * h11),
                {along_s * (high - low) * width, -along_t * (high - low) * height},
                std::min({fs, 1 - fs, ft, 1 - ft})};
    }
};

struct ExportedVertex {
    glm::dvec3 position, normal;
    glm::dvec2 uv;
    int face = -1;
};

std::vector<ExportedVertex> exported(Terrain const& terrain, std::string const& options)
{
    fs::path const mesh = test::scratch() / "displaced.obj";
    test::Result const r = run("export " + terrain.cage().string() + " --displace " +
                               terrain.image().string() + " " + options + " -o " + mesh.string());
    EXPECT_EQ(r.status, 0) << r.err;
    std::vector<ExportedVertex> out;
    std::ifstream in(mesh);
    int face = -1;
    for (std::string line, word; std::getline(in, line);) {
        std::istringstream words(line);
        words >> word;
        if (word == "v") {
            out.emplace_back();
            words >> out.back().position.x >> out.back().position.y >> out.back().position.z;
        } else if (word == "vn") {
            words >> out.back().normal.x >> out.back().normal.y >> out.back().normal.z;
        } else if (word == "vt") {
            words >> out.back().uv.x >> out.back().uv.y;
        } else if (word == "g") {
            face = std::stoi(line.substr(line.find('_') + 1));
        } else if (word == "f") {
            for (std::string corner; words >> corner;)
                out[std::size_t(std::stoi(corner)) - 1].face = face;
        }
    }
    return out;
}

// On a plane the displaced surface is (x, y, scale h): its normal is (-scale h_x, -scale h_y, 1).
void expect_bilinear(Terrain const& terrain, std::string const& wrap, double scale,
                     std::string const& options = "")
{
    SCOPED_TRACE(wrap + options);
    std::vector<ExportedVertex> const vertices =
        exported(terrain, "--displace-scale " + std::to_string(scale) + " --displace-wrap " + wrap +
                              " --normals displaced --tess 7.3 " + options);
    ASSERT_GT(vertices.size(), 500u);
    double const n = terrain.faces;
    // A tangent is good to 2^-21 of the largest coordinate, sqrt(3), over a patch's width, by a
    // straight line's weights, 2 and a little beyond its ends; so is its direction. Places in the
    // map are singles below 16 texels: off by 4 2^-21, which changes a slope along one axis by
    // that times the largest second difference, 2, per texel.
    double const tangent = 2.2 * std::sqrt(3) * 0x1p-21 * n, place = 4 * 0x1p-21;
    double const texels = (terrain.high - terrain.low) * std::max(terrain.width, terrain.height);
    std::size_t between = 0;
    for (ExportedVertex const& v : vertices) {
        ASSERT_GE(v.face, 0);
        double const x = (v.face % terrain.faces + v.uv.x) / n,
                     y = (v.face / terrain.faces + v.uv.y) / n;
        Terrain::Sample const h = terrain.sample(x, y, wrap);
        ASSERT_NEAR(v.position.z, scale * h.height, 1e-6) << x << " " << y;
        if (h.from_line < 1e-4) continue; // where the slope jumps
        ++between;
        glm::dvec3 const expected = glm::normalize(glm::dvec3(-scale * h.slope, 1));
        double const bound = 2 * tangent + scale * 2 * 2 * place * texels + 0x1p-23;
        ASSERT_LT(glm::distance(v.normal, expected), bound) << x << " " << y;
    }
    EXPECT_GT(between, 500u);
}

TEST(HeightMap, AnExportHasTheSamplesByTheBilinearFormulaAndTheNormalsOfThatSurface)
{
    Terrain const whole(8, 8, 4, 0, 1);
    for (char const* wrap : {"clamp", "repeat", "mirror"}) expect_bilinear(whole, wrap, 1);
    Terrain const beyond(9, 7, 5, -0.7, 1.6);
    for (char const* wrap : {"clamp", "repeat", "mirror"}) expect_bilinear(beyond, wrap, 0.25);
    for (char const* options :
         {" --direct3d 10", " --contraction mixed:3", " --scheme acc", " -j 3"})
        expect_bilinear(beyond, "clamp", 0.25, options);
}

// At the middle of a texel a difference over one texel on each side has both slopes' mean.
TEST(HeightMap, WhereTheSlopeJumpsBothSidesMeanCounts)
{
    Terrain const terrain(8, 8, 1, 0, 1);
    // Texels' centres are at odd sixteenths: all inner points of a tess factor of 16.
    std::vector<ExportedVertex> const vertices =
        exported(terrain, "--displace-scale 1 --displace-wrap clamp --normals displaced --tess 16 "
                          "--partitioning integer");
    std::size_t checked = 0;
    for (ExportedVertex const& v : vertices) {
        double const s = v.uv.x * 8 - 0.5, t = (1 - v.uv.y) * 8 - 0.5;
        if (s != std::floor(s) || t != std::floor(t)) continue;
        int const i = int(s), j = int(t);
        double const dx = (terrain.texel(i + 1, j, "clamp") - terrain.texel(i - 1, j, "clamp")) * 4,
                     dy = (terrain.texel(i, j - 1, "clamp") - terrain.texel(i, j + 1, "clamp")) * 4;
        ++checked;
        // As above: of one patch, of places without roundings.
        ASSERT_LT(glm::distance(v.normal, glm::normalize(glm::dvec3(-dx, -dy, 1))),
                  2 * 2.2 * std::sqrt(3) * 0x1p-21 + 0x1p-23);
    }
    EXPECT_EQ(checked, 64u);
}

TEST(HeightMap, OptionsThatNeedItAreRefusedWithoutIt)
{
    Terrain const terrain(2, 2, 1, 0, 1);
    std::string const cage = terrain.cage().string(), image = terrain.image().string(),
                      mesh = " -o " + (test::scratch() / "a.obj").string();
    struct {
        std::string command, says;
    } const rows[] = {
        {"export " + cage + " --displace-wrap clamp" + mesh, "--displace-wrap needs --displace"},
        {"export " + cage + " --displace studs --displace-wrap clamp" + mesh, "studs"},
        {"export " + cage + " --displace " + image + " --displace-wrap border" + mesh,
         "repeat, clamp or mirror"},
        {"export " + cage + " --normals displaced" + mesh, "--normals displaced needs --displace"},
        {"draw " + cage + " --displace " + image + " --normals displaced", "frozen or true"},
        {"export " + cage + " --displace " + image + " --displace-scale 1e30" + mesh,
         "the limit is 2^20 diagonals"},
        {"draw " + cage + " --displace studs --displace-scale 1e30 -o a.png",
         "the limit is 2^20 diagonals"},
        {"export " + cage + " --displace /dev/zero" + mesh, "/dev/zero: is no regular file"},
        {"compare golem --subdivide 6 --level 6", "quads of the limit surface at level 6"},
    };
    for (auto const& [command, says] : rows) {
        test::Result const r = run(command);
        EXPECT_EQ(r.status, 2) << command;
        EXPECT_NE(r.err.find(says), std::string::npos) << r.err;
    }
    EXPECT_FALSE(fs::exists(test::scratch() / "a.obj"));
}

TEST(HeightMap, ItsWrapIsInTheResult)
{
    Terrain const terrain(4, 4, 1, 0, 2);
    std::string const draw =
        terrain.cage().string() + " --size 16x16 --displace " + terrain.image().string();
    Json const plain = test::draw_json(draw),
               clamped = test::draw_json(draw + " --displace-wrap clamp");
    EXPECT_EQ(plain["config"]["displace_wrap"], "repeat");
    EXPECT_EQ(clamped["config"]["displace_wrap"], "clamp");
    EXPECT_NE(plain["hash"], clamped["hash"]);
    EXPECT_EQ(test::draw_json(draw + " --displace-wrap repeat")["hash"], plain["hash"]);
    EXPECT_FALSE(
        test::draw_json("jug --size 16x16 --displace studs")["config"].contains("displace_wrap"));
}

} // namespace
} // namespace tessemu
