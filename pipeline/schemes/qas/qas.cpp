// qas: quadratic approximation of Loop's limit surface (Boubekeur and Schlick 2007), a substitute
// that HOLL10 compares with.
//
//     limits of vertices and of the middles of edges, a dispatch ─> six control points ─> quadratics
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/loop.h"
#include "pipeline/schemes/qas/limit_rows.h"
#include "pipeline/schemes/scheme.h"
#include "shaders_cpp/gradient_points_shader.h"
#include "shaders_cpp/qas/qas_triangle.h"

namespace tessemu {

namespace {

class QasPatches final : public PatchMesh {
public:
    explicit QasPatches(std::shared_ptr<RefinedMesh const> refined) : PatchMesh(std::move(refined))
    {
        ControlMesh smooth = mesh().mesh(); // the scheme knows no tags
        smooth.creases.clear();
        smooth.corners.clear();
        Topology const topology(smooth);
        GradientRows const rows = loop_limit_rows(topology);
        first_ = rows.first;
        vertices_ = rows.vertices;
        weights_.assign(rows.weights.begin(), rows.weights.end());
        PointNumbers const number(topology, true);
        std::vector<char> const hidden = hidden_faces(mesh(), warnings_);
        for (std::uint32_t f = 0; f < smooth.faces(); ++f) {
            if (hidden[f]) continue;
            places_.push_back(mesh().place(f));
            HalfEdge const first = smooth.face_start[f];
            for (HalfEdge h = first; h < first + 3; ++h)
                indices_.push_back(number.vertex(topology.vertex_of(h)));
            for (HalfEdge h = first; h < first + 3; ++h) indices_.push_back(number.edge(h));
        }
    }

    CommandList commands(SurfaceSettings const& s) const override
    {
        CommandList list;
        if (places_.empty()) return list;
        VertexSource const positions = add_vertices(list, mesh(), s);
        std::size_t const count = first_.size() - 1;
        auto const points = std::make_shared<std::vector<float>>(
            count * std::size_t(GradientPointsShader::kFloats));
        list.memory.push_back(points);
        GradientPointsShader cs;
        cs.first = {first_, 0, "first_terms"};
        cs.vertices = {vertices_, 1, "term_vertices"};
        cs.weights = {weights_, 2, "term_weights"};
        cs.positions = {positions.floats, 3, "positions"};
        cs.points = {*points, 4, "limit_points"};
        cs.stride = positions.stride;
        list.commands.emplace_back(
            Dispatch{"limit points", bind_compute_shader(cs, s.machine), groups_for(count, 64)});
        constexpr int kFloats = GradientPointsShader::kFloats;
        add_patch_draw(list,
                       {kind(), VertexSource{*points, kFloats, kFloats}, QasHullShader::kPoints,
                        indices_, places_, bind_vertex_shader(NormalVertexShader{}, s.machine),
                        bind_hull_shader(QasHullShader{s.factor_rule()}, s.machine),
                        bind_domain_shader(QasTriangle{}, s.machine)},
                       s);
        return list;
    }
    std::vector<PatchCount> patch_counts() const override
    {
        if (places_.empty()) return {};
        return {{kind(), places_.size(), 1, QasHullShader::kPoints, QasHullShader::kPoints}};
    }
    std::vector<std::string> warnings() const override { return warnings_; }

private:
    static PatchKind kind() { return {"triangle", PatchClass::Triangle}; }

    // GradientPointsShader's.
    std::vector<std::uint32_t> first_, vertices_;
    std::vector<float> weights_;
    std::vector<PatchPlace> places_;
    std::vector<std::uint32_t> indices_;
    std::vector<std::string> warnings_;
};

class Qas final : public Scheme {
public:
    SchemeInfo info() const override
    {
        SchemeInfo info{"qas", "HOLL10", "5 (Boubekeur and Schlick 2007)",
                        "quadratic triangles through limit points of Loop subdivision"};
        info.takes.quads = false;
        info.takes.step = loop_step;
        info.takes.steps_with_polygons = 0;
        info.no_curvature = "its normals are blended from the limit points', not those of the "
                            "positions, which have kinks at the edges";
        return info;
    }
    std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const> mesh, Parameters const&,
                                     BuildServices const&) const override
    {
        return std::make_unique<QasPatches>(std::move(mesh));
    }
};

} // namespace

std::unique_ptr<Scheme> make_qas()
{
    return std::make_unique<Qas>();
}

} // namespace tessemu
