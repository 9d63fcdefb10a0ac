// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/holl10/figures.h"

#include "analysis/papers/holl10/frames.h"
#include "shaders_cpp/tables/table_patch.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace tessemu {

namespace {

constexpr int kLevel = 5; ///< the paper's M5

Holl10Scheme const& scheme_of(std::string_view paper)
{
    for (Holl10Scheme const& s : kHoll10Schemes)
        if (s.paper == paper) return s;
    throw Error(fmt::format("HOLL10 compares no {}", paper));
}

struct Factors {
    std::array<float, 3> edges; ///< in the tessellator's order
    float inside;
};

struct FixedFactorsHullShader : TableHullShader<TessellatorDomain::Tri> {
    Factors fixed;

    template <class T>
    std::array<T, 6> tess_factors(PatchInput, Points<T> const&, Points<T> const&,
                                  Points<T> const&) const
    {
        return {
            T(fixed.edges[0]), T(fixed.edges[1]), T(fixed.edges[2]), T(fixed.inside), T(1), T(1)};
    }
};

// The first patch with an extraordinary vertex, at factors of its own.
class OnePatch final : public PatchMesh {
public:
    OnePatch(PatchMesh const& all, Factors const& factors)
        : PatchMesh(all.shared_mesh()),
          all_(all),
          factors_(factors)
    {
    }
    CommandList commands(SurfaceSettings const& s) const override
    {
        CommandList list = all_.commands(s);
        list.filter_surface_draws(
            [](Draw const& d) { return d.kind.patch_class == PatchClass::Other; });
        list.for_each_surface_draw([&](Draw& d) {
            d.patches = d.patches.first(1);
            d.call.index_count = std::uint32_t(d.call.control_points);
            d.pipeline.hull_shader =
                bind_hull_shader(FixedFactorsHullShader{{}, factors_}, s.machine);
        });
        return list;
    }
    std::vector<PatchCount> patch_counts() const override { return {}; }

private:
    PatchMesh const& all_;
    Factors factors_;
};

PaperFigure::Panel panel(PatchMesh const& patches, FrameSettings const& settings,
                         std::string caption, ThreadPool const& threads)
{
    Frame frame = draw_frame(patches, settings, threads);
    return {std::move(frame.color), std::move(caption)};
}

float aspect(FrameSettings const& s)
{
    return float(s.width) / float(s.height);
}

ControlMesh octahedron()
{
    ControlMesh m;
    m.name = "octahedron";
    m.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (std::uint32_t x : {0u, 1u})
        for (std::uint32_t y : {2u, 3u})
            for (std::uint32_t z : {4u, 5u}) {
                bool const even = (x + y + z) % 2 == 0;
                m.add_face(even ? std::vector<std::uint32_t>{x, y, z}
                                : std::vector<std::uint32_t>{y, x, z});
            }
    return m;
}

} // namespace

ControlMesh triangle_star(int valence)
{
    constexpr int kRings = 4;
    ControlMesh m;
    m.name = fmt::format("valence {}", valence);
    m.positions.emplace_back(0.f, 0.f, 0.f);
    // Ring r has r places a sector, from one spoke to the next.
    auto const first = [&](int r) { return 1 + valence * r * (r - 1) / 2; };
    auto const at = [&](int r, int i) {
        return std::uint32_t(r == 0 ? 0 : first(r) + i % (valence * r));
    };
    for (int r = 1; r <= kRings; ++r)
        for (int i = 0; i < valence * r; ++i) {
            double const turn = 2 * std::numbers::pi * i / (valence * r);
            double const x = r * std::cos(turn), y = r * std::sin(turn);
            m.positions.emplace_back(float(x), float(y),
                                     float(0.1 * x * x - 0.09 * y * y + 0.05 * x * y));
        }
    for (int r = 0; r < kRings; ++r)
        for (int sector = 0; sector < valence; ++sector)
            for (int i = 0; i <= r; ++i) {
                int const inner = sector * r + i, outer = sector * (r + 1) + i;
                m.add_face(std::vector<std::uint32_t>{at(r, inner), at(r + 1, outer),
                                                      at(r + 1, outer + 1)});
                if (i < r)
                    m.add_face(std::vector<std::uint32_t>{at(r, inner), at(r + 1, outer + 1),
                                                          at(r, inner + 1)});
            }
    return m;
}

PaperFigure reproduce_holl10_figure4(std::vector<ControlMesh> const& meshes,
                                     FrameSettings const& settings, ThreadPool const& threads,
                                     PaperProgress const& progress)
{
    constexpr char const* kSteps[] = {"0", "1", "2"};
    PaperFigure f;
    f.columns = int(std::size(kSteps)) + 1;
    for (ControlMesh const& mesh : meshes) {
        FrameSettings s = settings;
        s.view = View::Zebra;
        s.camera = frame_points(mesh.positions, {0.45f, 0.35f, 1}, aspect(s));
        auto const add = [&](ParameterTexts set, std::string const& what) {
            set.emplace_back("mesher", "pattern");
            SchemeOnMesh const on =
                build_scheme(find_scheme(scheme_of("SM").scheme), mesh, {.set = std::move(set)});
            f.panels.push_back(panel(*on.patches, at_level(s, on, kLevel),
                                     fmt::format("{}: {}", mesh.name, what), threads));
            if (progress) progress(f.panels.size(), meshes.size() * std::size_t(f.columns));
        };
        for (char const* steps : kSteps)
            add({{"shading", steps}}, fmt::format("shading from M{}", steps));
        add({{"normals", "tangents"}}, "the surface's normals");
    }
    f.remarks = {
        "Reflection lines at level 5: subdivision shading of normals that are taken of the "
        "faces of M0, M1 and M2, beside the normals of the limit surface."};
    return f;
}

PaperFigure reproduce_holl10_figure5(FrameSettings const& settings, ThreadPool const& threads)
{
    SchemeOnMesh const on = build_scheme(find_scheme(scheme_of("SM").scheme), octahedron());
    FrameSettings s = settings;
    s.view = View::Wire;
    s.partitioning = Partitioning::Integer;
    std::vector<glm::vec3> points;
    visit_surface(OnePatch(*on.patches, {{4, 4, 4}, 4}), s, threads, [&](SurfacePatch const& p) {
        for (std::size_t i = 0; i < p.points(); ++i) points.push_back(p.vertex(i).position);
    });
    s.camera = frame_points(points, {1, 0.35f, 0.35f}, aspect(s));
    PaperFigure f;
    f.columns = 3;
    for (Factors const& of : {Factors{{1, 1, 1}, 1},
                              {{8, 8, 8}, 8},
                              {{32, 32, 32}, 32},
                              {{1, 4, 4}, 4},
                              {{4, 8, 16}, 8},
                              {{32, 2, 2}, 2}})
        f.panels.push_back(panel(OnePatch(*on.patches, of), s,
                                 fmt::format("edges {} {} {}, inside {}", of.edges[0], of.edges[1],
                                             of.edges[2], of.inside),
                                 threads));
    f.remarks = {"One triangle of M1 of an octahedron on Direct3D 11's tessellator, integer "
                 "factors. All panels read the same table, of 32 segments."};
    return f;
}

PaperFigure reproduce_holl10_figure6(FrameSettings const& settings, ThreadPool const& threads,
                                     PaperProgress const& progress)
{
    constexpr int kValences[] = {4, 8, 12};
    constexpr char const* kShown[] = {"QAS", "PT", "PN-Tri.", "SM"};
    PaperFigure f;
    f.columns = int(std::size(kShown));
    for (int valence : kValences) {
        ControlMesh const mesh = triangle_star(valence);
        FrameSettings s = settings;
        s.view = View::Zebra;
        s.camera = frame_points(std::span(mesh.positions).first(std::size_t(1 + valence)),
                                {0, -0.4f, 1}, aspect(s));
        fit_depth_range(s.camera, mesh.positions);
        for (char const* scheme : kShown) {
            SchemeOnMesh const on = build_holl10(scheme_of(scheme), mesh);
            f.panels.push_back(panel(*on.patches, at_level(s, on, kLevel),
                                     fmt::format("{}, valence {}", scheme, valence), threads));
            if (progress) progress(f.panels.size(), std::size(kValences) * std::size(kShown));
        }
    }
    f.remarks = {"Reflection lines of surfaces at level 5 around the vertex in the middle, of the "
                 "shading's normals. The paper does not name its mesh: rings of triangles on a "
                 "saddle."};
    return f;
}

PaperFigure reproduce_holl10_figure7(std::vector<ControlMesh> const& meshes,
                                     FrameSettings const& settings, ThreadPool const& threads,
                                     PaperProgress const& progress)
{
    constexpr char const* kShown[] = {"Flat", "PT", "PN-Tri.", "QAS", "SM"};
    PaperFigure f;
    f.columns = int(std::size(kShown));
    for (ControlMesh const& mesh : meshes) {
        FrameSettings s = settings;
        s.camera = frame_points(mesh.positions, {0.45f, 0.35f, 1}, aspect(s));
        for (char const* scheme : kShown) {
            SchemeOnMesh const on = build_holl10(scheme_of(scheme), mesh);
            f.panels.push_back(panel(*on.patches, at_level(s, on, kLevel),
                                     fmt::format("{}: {}", mesh.name, scheme), threads));
            if (progress) progress(f.panels.size(), meshes.size() * std::size(kShown));
        }
    }
    f.remarks = {"All at level 5. Substitutes other than QAS interpolate M0's vertices, QAS and SM "
                 "approximate them."};
    return f;
}

} // namespace tessemu
