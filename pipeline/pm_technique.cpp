// SPDX-License-Identifier: Apache-2.0
#include "pipeline/pm_technique.h"

#include "pipeline/loop09_constants.h"
#include "pipeline/ring_patch_mesh.h"
#include "shaders_cpp/pm/pm_patch.h"
#include "shaders_cpp/pm/pm_vertex_shader.h"

namespace tessemu {

std::vector<double> make_pm_constants()
{
    using C = PmConstants;
    std::vector<double> out(std::size_t((RingLayout::kEdges + 1) * C::kRow));
    for (int n = 2; n <= RingLayout::kEdges; ++n) {
        double* const row = out.data() + n * C::kRow;
        double const all = n * (n + 5), length = 1 / (n * loop09_lambda(n));
        row[0] = n * n / all;
        row[1] = 4 / all;
        row[2] = 1 / all;
        for (int j = 0; j < n; ++j) {
            double* const each = row + 3 + C::kEach * j;
            each[0] = length * cos_pi(2 * j, n);
            each[1] = length * sin_pi(2 * j, n);
            each[2] = cos_pi(2 * j, n);
            each[3] = sin_pi(2 * j, n);
        }
    }
    return out;
}

namespace {

enum Kind { kRegularQuad, kPmQuad, kPmTriangle };

class PmTechnique final : public Technique {
public:
    SchemeInfo info() const override
    {
        return {
            "pm",
            "LOOP09",
            "5, 6 (Myles, Ni and Peters 2008)",
            "Pm-patches: quartic Bezier triangles around a centre, 25 coefficients for a quad, 19 "
            "for a triangle; closed meshes only",
            {}};
    }

    std::unique_ptr<PatchMesh> build(Topology const& topology,
                                     std::map<std::string, double> const& parameters) const override
    {
        if (!parameters.empty())
            throw Error("pm has no parameter '" + parameters.begin()->first + "'");
        ControlMesh const& mesh = topology.mesh();
        for (std::uint32_t f = 0; f < mesh.faces(); ++f)
            for (std::uint32_t v : mesh.face(f))
                if (topology.is_boundary(v))
                    throw MeshError(f,
                                    "pm draws closed meshes only: face " + std::to_string(f + 1) +
                                        " has vertex " + std::to_string(v + 1) +
                                        " on the boundary; gregory-stencil draws boundaries too");
        RingScheme s;
        s.kinds = {{{"regular quad", kRegularQuad},
                    4,
                    sector_hull_program<PmRegularHullShader<>>,
                    surface_program<RegularSectorsDomainShader>},
                   {{"P4", kPmQuad},
                    4,
                    sector_hull_program<PmHullShader<TessellatorDomain::Quad>>,
                    surface_program<PmQuadDomainShader>},
                   {{"P3", kPmTriangle},
                    3,
                    sector_hull_program<PmHullShader<TessellatorDomain::Tri>>,
                    surface_program<PmTriangleDomainShader>}};
        s.kind_of = [&topology](std::uint32_t face) -> std::size_t {
            if (topology.mesh().face(face).size() == 3) return kPmTriangle;
            return is_regular(topology, face) ? kRegularQuad : kPmQuad;
        };
        auto constants = std::make_shared<std::vector<float>>();
        for (double c : make_pm_constants()) constants->push_back(float(c));
        s.vertex_program = [constants](RingTextures const& textures, PassSettings const& settings) {
            PmVertexShader<> vs{textures, {*constants, 3, "ring_constants"}};
            return std::shared_ptr<VertexProgram const>(make_vertex_program(vs, settings.machine));
        };
        return make_ring_patch_mesh(topology, std::move(s));
    }
};

} // namespace

std::unique_ptr<Technique> make_pm_technique()
{
    return std::make_unique<PmTechnique>();
}

} // namespace tessemu
