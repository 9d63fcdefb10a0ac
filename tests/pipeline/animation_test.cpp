// Only the control mesh moves.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/scheme.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <set>

namespace tessemu {
namespace {

TEST(SpineRig, MovesRigidlyNearABoneAndKeepsLengths)
{
    ControlMesh const mesh = load_model("jug").mesh;
    SpineRig const rig(mesh, 5);
    for (double phase : {0.0, 0.31, 0.77}) {
        Pose const pose = rig.sway(phase);
        ASSERT_EQ(pose.bones.size(), 60u);
        EXPECT_EQ(pose.bytes(), 240u);
        for (std::size_t b = 0; b < 5; ++b) {
            float const* const m = pose.bones.data() + 12 * b;
            glm::vec3 const r[3] = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}};
            for (int i = 0; i < 3; ++i)
                for (int k = 0; k <= i; ++k)
                    EXPECT_NEAR(dot(r[i], r[k]), i == k ? 1 : 0, 4 * 0x1p-24);
            EXPECT_NEAR(dot(cross(r[0], r[1]), r[2]), 1, 8 * 0x1p-24);
        }
        // Weights of a vertex add up to 255; joints of neighbouring bones meet.
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            std::uint32_t const w = pose.skin->vertices[2 * v + 1];
            EXPECT_EQ((w & 255) + (w >> 8 & 255) + (w >> 16 & 255) + (w >> 24), 255u);
        }
    }
    // A period later everything is where it was; half a period later it is not.
    EXPECT_EQ(rig.sway(0.25).bones, rig.sway(1.25).bones);
    EXPECT_NE(rig.sway(0.25).bones, rig.sway(0.75).bones);
    EXPECT_THROW(SpineRig(mesh, 1), Error);
    EXPECT_THROW(SpineRig(mesh, 256), Error);
    EXPECT_THROW(SpineRig(ControlMesh{}), Error);
}

// A pose that is the identity gives the surface at rest but for the rounding of the weights' sum;
// one bone alone that shifts everything gives the shifted surface.
TEST(Animation, ARigidPoseMovesTheSurfaceRigidly)
{
    ControlMesh mesh = load_model("jug").mesh;
    auto skin = std::make_shared<Skin>();
    skin->bones = 1;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        skin->vertices.insert(skin->vertices.end(), {0u, 255u});
    // Quarter turn about z, then a shift; exact in binary.
    auto const pose =
        std::make_shared<Pose>(Pose{skin, {0, -1, 0, 0.5f, 1, 0, 0, 0.25f, 0, 0, 1, -2}});
    for (char const* scheme : {"gregory-stencil", "gregory-two-stage"}) {
        SchemeOnMesh const m = build_scheme(find_scheme(scheme), mesh);
        std::vector<glm::vec3> rest, moved;
        FrameSettings s;
        s.tess_factor = 4;
        for (auto* out : {&rest, &moved}) {
            s.pose = out == &moved ? pose : nullptr;
            visit_surface(*m.patches, s, ThreadPool(), [&](SurfacePatch const& p) {
                for (std::size_t i = 0; i < p.points(); ++i) out->push_back(p.vertex(i).position);
            });
        }
        ASSERT_EQ(rest.size(), moved.size());
        float largest = 0;
        for (glm::vec3 const& p : mesh.positions)
            largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        // Control points are sums of at most 32 inputs and three roundings each, weights of
        // magnitude at most 2 in all; evaluation adds as much again.
        float const bound = 2 * (32 + 3) * 0x1p-23f * 2 * (largest + 3);
        for (std::size_t i = 0; i < rest.size(); ++i) {
            glm::vec3 const expected(0.5f - rest[i].y, 0.25f + rest[i].x, rest[i].z - 2);
            EXPECT_LE(glm::length(moved[i] - expected), bound);
        }
    }
}

// Stencil form: the vertex shader moves the vertices, once in each draw that has them: a cache lasts
// for a draw, and this one is infinite. Two-stage form: a dispatch before the draws does, once a
// vertex, and the vertex shader costs what it did. Either way a weight that is not 0 costs 13
// multiplications: its scale, nine with the bone's rows, three with the weight.
TEST(Animation, CostsWhatThePaperSays)
{
    for (char const* scheme : {"gregory-stencil", "gregory-two-stage"}) {
        bool const stencil = std::string_view(scheme) == "gregory-stencil";
        SchemeOnMesh const m = build_scheme(find_scheme(scheme), load_model("jug").mesh);
        FrameSettings s;
        s.vertex_cache = vertex_cache_from_name("infinite");
        DrawStatistics const rest = visit_surface(*m.patches, s, ThreadPool(), {}).total;
        s.pose = std::make_shared<Pose>(SpineRig(m.mesh->mesh()).sway(0.1));
        DrawStatistics const moved = visit_surface(*m.patches, s, ThreadPool(), {}).total;
        auto const stage = [](DrawStatistics const& d, std::string const& name) {
            for (StageStatistics const& st : d.stages)
                if (st.stage == name) return st;
            return StageStatistics{};
        };
        std::uint64_t const vertices = m.mesh->mesh().positions.size();
        auto const weights_of = [&](std::size_t v) {
            std::uint64_t n = 0;
            for (int i = 0; i < 4; ++i)
                n += (s.pose->skin->vertices[2 * v + 1] >> (8 * i) & 255) != 0;
            return n;
        };
        std::uint64_t weights = 0;
        for (std::size_t v = 0; v < vertices; ++v) weights += weights_of(v);
        EXPECT_GT(weights, vertices) << "some vertex follows two bones";
        EXPECT_LT(weights, 2 * vertices) << "and some follows one alone";
        EXPECT_EQ(rest.pipeline.CSInvocations, 0u);
        if (stencil) {
            EXPECT_EQ(moved.pipeline.CSInvocations, 0u);
            EXPECT_EQ(stage(rest, "vertex_shader").flops.mul, 0u);
            std::uint64_t runs = 0, weights_of_runs = 0;
            m.patches->commands(s).for_each_surface_draw([&](Draw const& d) {
                auto const index = std::get<std::span<std::uint32_t const>>(d.call.indices);
                std::set<std::uint32_t> const drawn(index.begin(), index.end());
                runs += drawn.size();
                for (std::uint32_t v : drawn) weights_of_runs += weights_of(v);
            });
            EXPECT_GT(runs, vertices) << "some vertex belongs to several draws";
            EXPECT_EQ(moved.pipeline.VSInvocations, runs);
            EXPECT_EQ(stage(moved, "vertex_shader").flops.mul, 13 * weights_of_runs);
        } else {
            EXPECT_EQ(moved.pipeline.CSInvocations, (vertices + 63) / 64 * 64);
            EXPECT_EQ(stage(rest, "vertex_shader").flops, stage(moved, "vertex_shader").flops);
            EXPECT_EQ(stage(moved, "compute_shader").flops.mul, 13 * weights);
        }
        EXPECT_EQ(stage(rest, "hull_shader").flops, stage(moved, "hull_shader").flops);
        EXPECT_EQ(rest.pipeline.DSInvocations, moved.pipeline.DSInvocations);
    }
}

} // namespace
} // namespace tessemu
