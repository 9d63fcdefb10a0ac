// Points are moved as the header says, whatever kind of draw makes them.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/moved_points.h"

#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/show_point.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>

namespace tessemu {
namespace {

// One patch that no tessellator makes: a saddle over the unit square.
class Sheet final : public PatchMesh {
public:
    Sheet() : PatchMesh(std::make_shared<RefinedMesh const>(square(), 0, catmull_clark_step)) {}

    CommandList commands(SurfaceSettings const& s) const override
    {
        Draw d;
        d.patches = places_;
        d.grid = grid_;
        d.pipeline.vertex_shader =
            bind_vertex_shader(test::ShowPoint{s.view_projection}, s.machine);
        d.call.topology = PrimitiveTopology::TriangleList;
        d.call.set_vertices(points_, 6);
        d.call.indices = std::span<std::uint32_t const>(grid_->patch.indices);
        CommandList list;
        list.commands.emplace_back(std::move(d));
        return list;
    }
    std::vector<PatchCount> patch_counts() const override { return {}; }

private:
    static ControlMesh square()
    {
        ControlMesh m;
        m.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
        m.add_face(std::array<std::uint32_t, 4>{0, 1, 2, 3});
        return m;
    }
    static std::shared_ptr<DomainPoints const> grid()
    {
        TessFactors factors;
        factors.fill(5);
        return TessellatorCache({TessellatorDomain::Quad, Partitioning::Integer}).find(factors);
    }
    static std::vector<float> points(DomainPoints const& grid)
    {
        std::vector<float> out;
        for (std::size_t i = 0; i < grid.patch.points(); ++i) {
            float const u = grid.u[i], v = grid.v[i];
            out.insert(out.end(), {u, v, 0.3f * u * v, -0.3f * v, -0.3f * u, 1});
        }
        return out;
    }

    std::vector<PatchPlace> places_{mesh().place(0)};
    std::shared_ptr<DomainPoints const> grid_ = grid();
    std::vector<float> points_ = points(*grid_);
};

std::vector<SurfaceVertex> points_of(PatchMesh const& patches, FrameSettings const& s)
{
    std::vector<SurfaceVertex> out;
    visit_surface(patches, s, ThreadPool(2), [&](SurfacePatch const& p) {
        for (std::size_t i = 0; i < p.points(); ++i) out.push_back(p.vertex(i));
    });
    return out;
}

// A surface by draws of each kind, and the settings that it is drawn with.
template <class Work> void for_each_kind_of_draw(Work const& work)
{
    SchemeOnMesh const golem =
        build_scheme(find_scheme("gregory-stencil"), load_model("golem").mesh);
    FrameSettings plain;
    plain.tess_factor = 3.4f;
    FrameSettings instanced = plain, displaced = plain;
    instanced.direct3d10 = true;
    displaced.displacement = std::make_shared<Displacement>(Displacement::studs(0.2f, 0.05f));
    auto const on = [&](char const* kind, PatchMesh const& patches, FrameSettings const& s) {
        SCOPED_TRACE(kind);
        work(patches, s);
    };
    on("tessellated", *golem.patches, plain);
    on("by instances", *golem.patches, instanced);
    on("displaced", *golem.patches, displaced);
    on("without a tessellator", Sheet(), plain);
}

TEST(MovedPoints, GoAlongTheirNormalsByTheParityOfTheirBits)
{
    constexpr float kParity = 0.01f;
    for_each_kind_of_draw([&](PatchMesh const& patches, FrameSettings const& s) {
        auto const before = points_of(patches, s);
        auto const after = points_of(MovedPoints(patches, {kParity, 0}), s);
        ASSERT_EQ(before.size(), after.size());
        std::size_t outwards = 0;
        for (std::size_t i = 0; i < before.size(); ++i) {
            auto const bit = [](float x) { return std::bit_cast<std::uint32_t>(x) & 1; };
            glm::vec3 const p = before[i].position, n = before[i].normal;
            bool const odd = bit(p.x) ^ bit(p.y) ^ bit(p.z);
            outwards += odd;
            ASSERT_EQ(after[i].position, p + (odd ? kParity : -kParity) * n);
            ASSERT_EQ(after[i].normal, n);
        }
        // Both directions were met: either alone would show nothing of the parity.
        EXPECT_GT(outwards, 0u);
        EXPECT_LT(outwards, before.size());
    });
}

TEST(MovedPoints, LieOnTheLatticePointThatIsNearest)
{
    constexpr float kLattice = 64;
    for_each_kind_of_draw([&](PatchMesh const& patches, FrameSettings s) {
        auto const before = points_of(patches, s);
        Camera camera;
        camera.eye = {0.5f, 1, 6};
        s.view_projection = view_projection(camera, 1);
        auto const after = points_of(MovedPoints(patches, {0, kLattice}), s);
        ASSERT_EQ(before.size(), after.size());
        for (std::size_t i = 0; i < before.size(); ++i) {
            glm::vec3 const p = before[i].position;
            float4<float> const clip = transform(s.view_projection, float3<float>(p.x, p.y, p.z));
            float const inverse = 1 / clip.w;
            auto const nearest = [&](float x) {
                return std::floor(kLattice * (x * inverse) + 0.5f) / kLattice;
            };
            ASSERT_EQ(after[i].position,
                      glm::vec3(nearest(clip.x), nearest(clip.y), clip.z * inverse));
        }
    });
}

TEST(MovedPoints, AreMovedOnceMore)
{
    for_each_kind_of_draw([&](PatchMesh const& patches, FrameSettings const& s) {
        MovedPoints const apart(patches, {0.01f, 0});
        auto const twice = points_of(MovedPoints(apart, {0, 64}), s),
                   once = points_of(MovedPoints(patches, {0.01f, 64}), s);
        ASSERT_EQ(twice.size(), once.size());
        for (std::size_t i = 0; i < once.size(); ++i)
            ASSERT_EQ(twice[i].position, once[i].position);
    });
}

} // namespace
} // namespace tessemu
