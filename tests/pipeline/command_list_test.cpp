// A frame as a list: what is counted, what may be left out, and patches that no tessellator makes.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/commands/command_list.h"

#include "emu/texture.h"
#include "io/model.h"
#include "pipeline/commands/direct3d10.h"
#include "pipeline/frame.h"
#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/edges.h"
#include "tests/support/scene.h"
#include "tests/support/show_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>

namespace tessemu {
namespace {

SchemeOnMesh load(char const* model, char const* scheme)
{
    return build_scheme(find_scheme(scheme), load_model(model).mesh);
}

FrameSettings posed(SchemeOnMesh const& m)
{
    FrameSettings s;
    s.width = s.height = 96;
    s.tess_factor = 3;
    s.camera = frame_points(m.mesh->mesh().positions, {0.5f, 0.4f, 1}, 1);
    s.pose = std::make_shared<Pose>(SpineRig(m.mesh->mesh()).sway(0.3));
    return s;
}

std::uint64_t skinning_threads(SchemeOnMesh const& m)
{
    return (m.mesh->mesh().positions.size() + 63) / 64 * 64;
}

CommandStatistics const* find(std::vector<CommandStatistics> const& commands,
                              std::string const& kind, std::string const& name)
{
    for (CommandStatistics const& c : commands)
        if (c.kind == kind && c.name == name) return &c;
    return nullptr;
}

TEST(CommandList, AFramesCountersAreTheSumsOverItsCommands)
{
    for (char const* scheme : {"gregory-stencil", "gregory-two-stage"})
        for (View view : {View::Lit, View::Wire, View::Coverage})
            for (bool direct3d10 : {false, true}) {
                SchemeOnMesh const m = load("jug", scheme);
                FrameSettings s = posed(m);
                s.view = view;
                s.direct3d10 = direct3d10;
                Frame const frame = draw_frame(*m.patches, s, ThreadPool(2));
                DrawStatistics sum;
                std::uint64_t number = 0;
                for (std::size_t i = 0; i < frame.commands.size(); ++i) {
                    CommandStatistics const& c = frame.commands[i];
                    sum += c.statistics;
                    number += c.number;
                    EXPECT_GT(c.number, 0u);
                    if (i == 0) continue; // like ones in a row would be one
                    CommandStatistics const& before = frame.commands[i - 1];
                    EXPECT_FALSE(before.kind == c.kind && before.name == c.name) << c.name;
                }
                EXPECT_EQ(sum, frame.statistics);
                CommandList const list = frame_commands(*m.patches, s, seen_surface(s));
                std::size_t const wires = view == View::Wire ? list.commands.size() : 0;
                EXPECT_GE(number, list.commands.size());
                EXPECT_LE(number, list.commands.size() + wires);
            }
}

struct Nothing {
    static constexpr std::array<int, 3> kThreads{4, 1, 1};
    template <class T> void operator()(ComputeGroup<T>&) const {}
};

TEST(CommandList, LikeCommandsInARowAreOneEntry)
{
    SchemeOnMesh const m = load("jug", "gregory-two-stage");
    CommandList const drawn = m.patches->commands({});
    auto const draw = [&](char const* name) {
        for (Command const& c : drawn.commands)
            if (Draw const* const d = std::get_if<Draw>(&c)) {
                Draw out = *d;
                out.name = name;
                return out;
            }
        throw Error("no draw");
    };
    auto const dispatch = [&](char const* name) {
        return Dispatch{name, bind_compute_shader(Nothing{}, {}), {3, 1, 1}};
    };
    CommandList list;
    list.commands = {draw("a"),     draw("a"),     draw("a"), dispatch("a"), dispatch("a"),
                     dispatch("b"), dispatch("a"), draw("b"), draw("a")};
    ListStatistics const s = run_commands(list, ThreadPool(2));
    std::vector<std::tuple<std::string, std::string, std::uint64_t>> is;
    for (CommandStatistics const& c : s.commands) is.emplace_back(c.kind, c.name, c.number);
    decltype(is) const expected{{"draw", "a", 3},     {"dispatch", "a", 2}, {"dispatch", "b", 1},
                                {"dispatch", "a", 1}, {"draw", "b", 1},     {"draw", "a", 1}};
    EXPECT_EQ(is, expected);
    EXPECT_EQ(s.commands[1].statistics.pipeline.CSInvocations, 24u);
    EXPECT_EQ(s.total.pipeline.CSInvocations, 48u);
    std::uint64_t const patches = s.commands[4].statistics.pipeline.HSInvocations;
    EXPECT_EQ(s.commands[0].statistics.pipeline.HSInvocations, 3 * patches);
    EXPECT_EQ(s.total.pipeline.HSInvocations, 5 * patches);
}

// Every patch's records, by kind and face.
using Surface = std::map<std::pair<std::string, std::uint32_t>, std::vector<std::uint32_t>>;
Surface surface(CommandList const& list)
{
    Surface out;
    CommandOptions options;
    options.visit = [&](SurfacePatch const& p) {
        std::vector<std::uint32_t>& bits = out[{p.kind().name, p.place().face}];
        EXPECT_TRUE(bits.empty());
        for (std::size_t i = 0; i < p.points(); ++i)
            for (float x : p.scalars(i)) bits.push_back(std::bit_cast<std::uint32_t>(x));
    };
    run_commands(list, ThreadPool(2), options);
    return out;
}

TEST(CommandList, FilteringDrawsOfTheSurfaceLeavesWhatFillsBuffers)
{
    SchemeOnMesh const m = load("jug", "gregory-two-stage");
    FrameSettings s = posed(m);
    auto const regular = [](Draw const& d) {
        return d.kind.patch_class == PatchClass::RegularQuad;
    };
    auto const fills = [](CommandList const& list) {
        std::size_t n = 0;
        for (Command const& c : list.commands) {
            Draw const* const d = std::get_if<Draw>(&c);
            n += !d || !d->shows_surface();
        }
        return n;
    };
    for (bool direct3d10 : {false, true}) {
        s.direct3d10 = direct3d10;
        CommandList const whole = frame_commands(*m.patches, s, surface_settings(s));
        CommandList part = frame_commands(*m.patches, s, surface_settings(s));
        part.filter_surface_draws([&](Draw const& d) { return !regular(d); });
        EXPECT_EQ(fills(part), fills(whole));
        EXPECT_TRUE(std::holds_alternative<Dispatch>(part.commands[0]));
        Surface const all = surface(whole), left = surface(part);
        std::size_t expected = 0;
        for (auto const& [patch, bits] : all) {
            if (patch.first == "regular quad") {
                EXPECT_EQ(left.count(patch), 0u);
                continue;
            }
            ++expected;
            ASSERT_EQ(left.count(patch), 1u);
            ASSERT_EQ(left.at(patch), bits);
        }
        EXPECT_EQ(left.size(), expected);
        EXPECT_GT(expected, 10u);
        EXPECT_LT(expected, all.size());
        EXPECT_EQ(left.size(), part.patches());
        EXPECT_EQ(all.size(), whole.patches());
    }
    // The pose is in them: at rest the bits are others.
    s.pose = {};
    EXPECT_NE(
        surface(frame_commands(*m.patches, s, surface_settings(s))).begin()->second,
        surface(frame_commands(*m.patches, posed(m), surface_settings(posed(m)))).begin()->second);
}

// ---- draws into targets of their own

// A number at every pixel; texel (x, y) of the table in blue.
struct Numbered {
    template <class T> using Input = test::SceneValue<T>;
    float number;
    Texture2D table;
    std::vector<ResourceInfo> resources() const { return {table.info()}; }
    template <class T>
    float4<T> operator()(PixelInput<T> const& pixel, test::SceneValue<T> const& in) const
    {
        T const texel = fetch_texel<T>(table, {pixel.position.x, pixel.position.y}).x;
        return {T(number) + in.value.x, in.value.y, texel, T(1)};
    }
};

// Cells of 9 x 9 pixels, a draw of two triangles for each.
struct Cells {
    static constexpr int kColumns = 8, kRows = 12, kCell = 9;
    std::vector<float> vertices, table = std::vector<float>(kColumns * kCell * kRows * kCell, 0.5f);
    ColorTarget color{kColumns * kCell, kRows* kCell, Format::R32G32B32A32_FLOAT};

    Cells()
    {
        for (auto [x, y] : {std::pair{-1, 1}, {1, 1}, {-1, -1}, {-1, -1}, {1, 1}, {1, -1}})
            vertices.insert(vertices.end(),
                            {float(x), float(y), 0.5f, 1, float(x), float(y), 0, 0});
        color.clear({-1, -1, -1, -1}, ThreadPool(1));
    }
    Draw draw(std::size_t i)
    {
        Draw d;
        d.name = "cell";
        d.pipeline.vertex_shader = bind_vertex_shader(test::SceneVertexShader{}, {});
        Numbered const shader{float(i), Texture2D(std::as_bytes(std::span(table)),
                                                  Format::R32_FLOAT, kColumns * kCell,
                                                  kRows * kCell, kColumns * kCell, 1, "table")};
        d.pipeline.pixel_shader = bind_pixel_shader(shader, {});
        d.call.topology = PrimitiveTopology::TriangleList;
        d.call.set_vertices(vertices, 8);
        d.call.vertex_count = 6;
        RasterTarget target;
        target.color = {&color};
        target.viewports = {{float(int(i) % kColumns * kCell), float(int(i) / kColumns * kCell),
                             kCell, kCell, 0, 1}};
        target.depth_stencil.depth_enable = false;
        d.target = target;
        return d;
    }
    std::vector<float> texels() const
    {
        std::vector<float> out;
        for (int y = 0; y < color.height(); ++y)
            for (int x = 0; x < color.width(); ++x)
                for (float c : color.load(x, y)) out.push_back(c);
        return out;
    }
};

TEST(OwnTarget, IsFilledWhateverTheRunsTargetIsAndShowsNoPatches)
{
    for (bool picture : {false, true}) {
        Cells cells;
        CommandList list;
        list.commands = {cells.draw(0), cells.draw(9)};
        list.filter_surface_draws([](Draw const&) { return false; });
        EXPECT_EQ(list.commands.size(), 2u);
        EXPECT_EQ(list.patches(), 0u);
        ColorTarget seen(9, 9, Format::R32_FLOAT);
        seen.clear({7, 7, 7, 7}, ThreadPool(1));
        RasterTarget raster;
        raster.color = {&seen};
        raster.viewports = {{0, 0, 9, 9, 0, 1}};
        CommandOptions options;
        if (picture) options.raster = &raster;
        options.visit = [](SurfacePatch const&) { FAIL() << "no patch"; };
        ListStatistics const s = run_commands(list, ThreadPool(2), options);
        EXPECT_EQ(s.total.pipeline.PSInvocations, 2u * 81);
        for (int y = 0; y < 18; ++y)
            for (int x = 0; x < 18; ++x) {
                bool const first = x < 9 && y < 9, second = x >= 9 && y >= 9;
                std::array<float, 4> const is = cells.color.load(x, y);
                EXPECT_EQ(is[2], first || second ? 0.5f : -1.0f) << x << ", " << y;
            }
        EXPECT_EQ(cells.color.load(13, 13)[0], 9.0f); // in the middle of its cell
        EXPECT_EQ(seen.load(4, 4)[0], 7.0f);
    }
}

TEST(DrawBatch, GivesTheTargetsAndCountsOfItsDrawsOneByOneOnAnyThreads)
{
    std::size_t const count = Cells::kColumns * Cells::kRows - 5;
    Cells alone;
    CommandList list;
    for (std::size_t i = 0; i < count; ++i) list.commands.emplace_back(alone.draw(i));
    ListStatistics const one_by_one = run_commands(list, ThreadPool(1));
    ASSERT_EQ(one_by_one.commands.size(), 1u);
    EXPECT_EQ(one_by_one.total.pipeline.PSInvocations, count * 81);
    StageStatistics const& shading =
        *std::find_if(one_by_one.total.stages.begin(), one_by_one.total.stages.end(),
                      [](StageStatistics const& stage) { return stage.stage == "pixel_shader"; });
    ASSERT_EQ(shading.fetches.size(), 1u);
    EXPECT_EQ(shading.fetches[0].unique_bytes, count * 81 * sizeof(float)); // of each draw
    for (int threads : {1, 2, 3, 8}) {
        Cells cells;
        CommandList batch;
        batch.commands = {DrawBatch{"cell", count, [&](std::size_t i) { return cells.draw(i); }}};
        ListStatistics const s = run_commands(batch, ThreadPool(threads));
        EXPECT_EQ(cells.texels(), alone.texels()) << threads;
        EXPECT_EQ(s.total, one_by_one.total) << threads;
        ASSERT_EQ(s.commands.size(), 1u);
        EXPECT_EQ(s.commands[0].kind, "draw");
        EXPECT_EQ(s.commands[0].name, "cell");
        EXPECT_EQ(s.commands[0].number, count);
        EXPECT_EQ(s.commands[0].statistics, s.total);
    }
}

TEST(DrawBatch, StaysWhereDrawsOfTheSurfaceGoAndIsNoCommandWhereItIsEmpty)
{
    SchemeOnMesh const m = load("jug", "gregory-two-stage");
    Cells cells;
    CommandList list = m.patches->commands({});
    list.commands.insert(list.commands.begin(),
                         DrawBatch{"cell", 3, [&](std::size_t i) { return cells.draw(i); }});
    list.commands.emplace_back(DrawBatch{"none", 0, {}});
    std::size_t const patches = list.patches();
    EXPECT_GT(patches, 0u);
    list = instanced(std::move(list), {});
    EXPECT_EQ(list.patches(), patches);
    list.filter_surface_draws([](Draw const&) { return false; });
    EXPECT_EQ(list.patches(), 0u);
    ListStatistics const s = run_commands(list, ThreadPool(2));
    ASSERT_FALSE(s.commands.empty());
    EXPECT_EQ(s.commands.front().name, "cell");
    EXPECT_EQ(s.commands.front().number, 3u);
    for (CommandStatistics const& c : s.commands) EXPECT_NE(c.name, "none");
    EXPECT_EQ(cells.color.load(18 + 4, 4)[0], 2.0f);
}

TEST(DrawBatch, AnErrorOfOneDrawReachesTheCaller)
{
    Cells cells;
    CommandList list;
    list.commands = {DrawBatch{"cell", 40, [&](std::size_t i) {
                                   if (i == 33) throw Error("cell 33 has no table");
                                   return cells.draw(i);
                               }}};
    for (int threads : {1, 3}) EXPECT_THROW(run_commands(list, ThreadPool(threads)), Error);
}

TEST(CommandList, TheWireViewDrawsTwiceAndDispatchesOnce)
{
    SchemeOnMesh const m = load("jug", "gregory-two-stage");
    FrameSettings s = posed(m);
    Frame const lit = draw_frame(*m.patches, s, ThreadPool(2));
    s.view = View::Wire;
    Frame const wire = draw_frame(*m.patches, s, ThreadPool(2));
    EXPECT_EQ(lit.statistics.pipeline.CSInvocations, skinning_threads(m));
    EXPECT_EQ(wire.statistics.pipeline.CSInvocations, skinning_threads(m));
    EXPECT_EQ(wire.statistics.pipeline.HSInvocations, 2 * lit.statistics.pipeline.HSInvocations);
    EXPECT_EQ(wire.commands.size(), 2 * lit.commands.size() - 1); // the dispatch
    for (CommandStatistics const& c : lit.commands) {
        CommandStatistics const* const same = find(wire.commands, c.kind, c.name);
        ASSERT_TRUE(same) << c.name;
        EXPECT_EQ(same->statistics.pipeline.PSInvocations, c.statistics.pipeline.PSInvocations);
        if (c.kind == "dispatch") continue;
        CommandStatistics const* const edges = find(wire.commands, c.kind, c.name + ": edges");
        ASSERT_TRUE(edges) << c.name;
        EXPECT_EQ(edges->number, c.number);
        EXPECT_GT(edges->statistics.pipeline.PSInvocations, 0u);
        EXPECT_EQ(edges->statistics.pipeline.DSInvocations, c.statistics.pipeline.DSInvocations);
    }
}

TEST(CommandList, ProgressCountsThePatchesOfAllDraws)
{
    SchemeOnMesh const m = load("jug", "gregory-stencil");
    FrameSettings const s = posed(m);
    std::size_t last = 0, patches = m.mesh->mesh().faces();
    draw_frame(*m.patches, s, ThreadPool(2), [&](std::size_t done, std::size_t all) {
        EXPECT_EQ(all, patches);
        EXPECT_GE(done, last);
        last = done;
    });
    EXPECT_EQ(last, patches);
}

// A bilinear patch for every quad, by a compute shader into a buffer: no tessellator, no instances.
glm::vec3 bilinear(std::array<glm::vec3, 4> const& p, float u, float v)
{
    glm::vec3 out;
    for (int k = 0; k < 3; ++k) {
        float const b0 = (1 - u) * p[0][k], b1 = u * p[1][k], t0 = (1 - u) * p[3][k],
                    t1 = u * p[2][k];
        float const low = (1 - v) * (b0 + b1), high = v * (t0 + t1);
        out[k] = low + high;
    }
    return out;
}

struct GridComputeShader {
    static constexpr std::array<int, 3> kThreads{32, 1, 1};
    Buffer<float> corners;  ///< [patch][4][3]
    Buffer<float> domain;   ///< [point][2]
    RWBuffer<float> points; ///< [patch][point][6]: position, normal
    int count = 0;          ///< points of a patch

    std::vector<ResourceInfo> resources() const
    {
        return {corners.info(), domain.info(), points.info()};
    }
    /// Groups: points of a patch, patches.
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            Int const point = in.dispatch_thread_id.x;
            T const u = load<T>(domain, point << Int(1)),
                    v = load<T>(domain, (point << Int(1)) + Int(1));
            auto const corner = [&](int i) -> float3<T> {
                std::int32_t const at = 12 * in.group_id.y + 3 * i;
                return {load<T>(corners, at), load<T>(corners, at + 1), load<T>(corners, at + 2)};
            };
            T const U = T(1) - u, V = T(1) - v;
            float3<T> const bottom = U * corner(0) + u * corner(1);
            float3<T> const top = U * corner(3) + u * corner(2);
            float3<T> const p = V * bottom + v * top;
            // Threads past the patch's last point store nowhere.
            Int const first =
                select(point < Int(count), (point + Int(count * in.group_id.y)) * Int(6), Int(-1));
            auto const put = [&](int k, T const& x) {
                store(points, select(first < Int(0), first, first + Int(k)), x);
            };
            put(0, p.x), put(1, p.y), put(2, p.z);
            put(3, u), put(4, v), put(5, T(1));
        });
    }
};

class GridPatches final : public PatchMesh {
public:
    explicit GridPatches(std::shared_ptr<RefinedMesh const> refined) : PatchMesh(std::move(refined))
    {
        for (std::uint32_t f = 0; f < mesh().mesh().faces(); ++f) {
            int const rotation = int(f % 4);
            places_.push_back(mesh().place(f, rotation));
            for (int k = 0; k < 4; ++k) {
                glm::vec3 const p = corners(f)[std::size_t(k)];
                corners_.insert(corners_.end(), {p.x, p.y, p.z});
            }
        }
    }
    /// Of the patch on a face.
    std::array<glm::vec3, 4> corners(std::uint32_t f) const
    {
        std::array<glm::vec3, 4> out;
        for (std::size_t k = 0; k < 4; ++k)
            out[k] = mesh().mesh().positions[mesh().mesh().face(f)[(k + f) % 4]];
        return out;
    }
    std::vector<PatchCount> patch_counts() const override { return {}; }

    CommandList commands(SurfaceSettings const& s) const override
    {
        struct Memory {
            std::vector<float> domain, points;
            std::vector<std::uint32_t> indices;
        };
        auto const memory = std::make_shared<Memory>();
        Draw d;
        d.name = "bilinear quads";
        d.kind = {"bilinear quad", PatchClass::Other};
        d.patches = places_;
        TessFactors factors;
        factors.fill(s.tess_factor);
        d.grid = TessellatorCache({TessellatorDomain::Quad, s.partitioning}).find(factors);
        auto const points = std::uint32_t(d.grid->patch.points()),
                   patches = std::uint32_t(places_.size());
        for (std::size_t i = 0; i < points; ++i)
            memory->domain.insert(memory->domain.end(), {d.grid->u[i], d.grid->v[i]});
        for (std::uint32_t p = 0; p < patches; ++p)
            for (std::uint32_t i : d.grid->patch.indices) memory->indices.push_back(p * points + i);
        memory->points.resize(std::size_t(6) * points * patches);
        GridComputeShader cs;
        cs.corners = {corners_, 0, "corners"};
        cs.domain = {memory->domain, 1, "domain"};
        cs.points = {memory->points, 2, "points"};
        cs.count = int(points);
        d.pipeline.vertex_shader =
            bind_vertex_shader(test::ShowPoint{s.view_projection}, s.machine);
        d.call.topology = PrimitiveTopology::TriangleList;
        d.call.set_vertices(memory->points, 6);
        d.call.indices = std::span<std::uint32_t const>(memory->indices);
        CommandList list;
        list.memory.push_back(memory);
        list.commands.emplace_back(Dispatch{
            "points", bind_compute_shader(cs, s.machine), {(points + 31) / 32, patches, 1}});
        list.commands.emplace_back(std::move(d));
        return list;
    }

private:
    std::vector<PatchPlace> places_;
    std::vector<float> corners_;
};

// Three quads around a corner of a cube, and their children.
std::shared_ptr<RefinedMesh const> three_quads(int steps)
{
    ControlMesh m;
    m.positions = {{0, 0, 0},    {1, 0.1f, 0}, {1.1f, 1, 0},   {0, 1, 0.2f},
                   {0, 0, 1.3f}, {1, 0, 1},    {0.1f, 1, 1.1f}};
    m.add_face(std::array<std::uint32_t, 4>{0, 3, 2, 1});
    m.add_face(std::array<std::uint32_t, 4>{0, 1, 5, 4});
    m.add_face(std::array<std::uint32_t, 4>{4, 6, 3, 0});
    return std::make_shared<RefinedMesh const>(std::move(m), steps, catmull_clark_step);
}

TEST(Grid, PatchesThatNoTessellatorMakesAreVisitedOneByOneWithTheirPlaces)
{
    for (int steps : {0, 1, 2})
        for (float factor : {1.0f, 3.6f, 8.0f}) {
            GridPatches const patches(three_quads(steps));
            FrameSettings s;
            s.tess_factor = factor;
            std::uint32_t visited = 0;
            ListStatistics const statistics =
                visit_surface(patches, s, ThreadPool(2), [&](SurfacePatch const& p) {
                    ASSERT_EQ(p.number(), visited++);
                    EXPECT_EQ(p.kind().name, "bilinear quad");
                    EXPECT_EQ(p.place(), patches.mesh().place(p.number(), int(p.number() % 4)));
                    EXPECT_EQ(p.triangles(), p.domain().patch.indices);
                    EXPECT_GE(p.triangles().size(), 6u);
                    auto const corners = patches.corners(p.number());
                    for (std::size_t i = 0; i < p.points(); ++i) {
                        float const u = p.domain().u[i], v = p.domain().v[i];
                        ASSERT_EQ(p.vertex(i).position, bilinear(corners, u, v));
                        ASSERT_EQ(p.vertex(i).normal, glm::vec3(u, v, 1));
                        ASSERT_EQ(p.scalars(i).size(), 7u);
                    }
                });
            EXPECT_EQ(visited, 3u << 2 * steps);
            EXPECT_GT(statistics.total.pipeline.CSInvocations, 0u);
            EXPECT_EQ(statistics.total.pipeline.DSInvocations, 0u);
        }
}

TEST(Grid, PointsOfSharedEdgesMeetByName)
{
    for (int steps : {0, 2}) {
        GridPatches const patches(three_quads(steps));
        FrameSettings s;
        s.tess_factor = 5;
        test::EdgeComparison const c = test::compare_edges(patches, s, ThreadPool(2));
        // Inner edges have four points between their ends; then the inner vertices and, on the
        // boundary, those of two faces.
        std::size_t const n = std::size_t(1) << steps;
        std::size_t const edges = 3 * n + 3 * 2 * n * (n - 1);
        std::size_t const vertices = 1 + 3 * n + 3 * (n * n - 1);
        EXPECT_EQ(c.shared_points, 4 * edges + vertices);
        EXPECT_EQ(c.lonely_points, 0u);
        // Normals are the patch's own here: they differ, and positions must not.
        EXPECT_EQ(c.differing_positions, 0u) << c.first_difference;
        EXPECT_GT(c.differing_normals, 0u);
    }
}

// With a visitor beside it the picture is the same.
TEST(Grid, AVisitorDoesNotChangeThePicture)
{
    GridPatches const patches(three_quads(1));
    FrameSettings s;
    s.width = s.height = 64;
    s.tess_factor = 4;
    s.view = View::Normals;
    s.camera = frame_points(patches.mesh().mesh().positions, {-0.5f, -0.4f, -1}, 1);
    std::vector<std::byte> pictures[2];
    for (std::vector<std::byte>& picture : pictures) {
        ColorTarget color(64, 64);
        DepthTarget depth(64, 64);
        color.clear({0, 0, 0, 1}, ThreadPool(1));
        depth.clear(1, 0, ThreadPool(1));
        RasterTarget raster{{&color}, &depth, {{0, 0, 64, 64, 0, 1}}};
        raster.rasterizer.cull = CullMode::None;
        CommandList list = frame_commands(patches, s, seen_surface(s));
        list.for_each_surface_draw([&](Draw& d) { d.pipeline.pixel_shader = make_view(d, s); });
        std::size_t visited = 0;
        CommandOptions options;
        options.raster = &raster;
        if (&picture == &pictures[1]) options.visit = [&](SurfacePatch const&) { ++visited; };
        ListStatistics const statistics = run_commands(list, ThreadPool(2), options);
        EXPECT_EQ(visited, options.visit ? 12u : 0u);
        EXPECT_GT(statistics.total.pipeline.PSInvocations, 200u);
        for (int y = 0; y < 64; ++y)
            picture.insert(picture.end(), color.texel(0, y), color.texel(0, y) + color.row_bytes());
    }
    EXPECT_EQ(pictures[0], pictures[1]);
}

} // namespace
} // namespace tessemu
