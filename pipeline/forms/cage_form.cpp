// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/cage_form.h"

#include <glm/geometric.hpp>

namespace tessemu {

std::vector<glm::vec3> vertex_normals(ControlMesh const& mesh)
{
    std::vector<std::uint32_t> const point = points_of(mesh);
    std::vector<glm::dvec3> sum(mesh.positions.size(), glm::dvec3(0));
    for (std::size_t f = 0; f < mesh.faces(); ++f) {
        auto const face = mesh.face(f);
        glm::dvec3 const origin(mesh.positions[face[0]]);
        glm::dvec3 area(0);
        for (std::size_t i = 1; i + 1 < face.size(); ++i)
            area += cross(glm::dvec3(mesh.positions[face[i]]) - origin,
                          glm::dvec3(mesh.positions[face[i + 1]]) - origin);
        for (std::size_t i = 0; i < face.size(); ++i) {
            bool first = true; // a face counts once at a point
            for (std::size_t k = 0; k < i; ++k) first = first && point[face[k]] != point[face[i]];
            if (first) sum[point[face[i]]] += area;
        }
    }
    std::vector<glm::vec3> out;
    for (std::uint32_t p : point) {
        double const length = glm::length(sum[p]);
        out.emplace_back(length > 0 ? sum[p] / length : glm::dvec3(0, 0, 1));
    }
    return out;
}

namespace {

VertexShader vertex_shader(SurfaceSettings const& s, bool at_rest)
{
    if (!s.pose || !at_rest) return bind_vertex_shader(NormalVertexShader{}, s.machine);
    return bind_vertex_shader(SkinnedNormalVertexShader{skin_of(*s.pose)}, s.machine);
}

} // namespace

CageForm::CageForm(std::shared_ptr<RefinedMesh const> refined, CageNormals whose)
    : PatchMesh(std::move(refined)),
      face_normals_(whose == CageNormals::Faces),
      groups_{{{"triangle", PatchClass::Triangle}, 3, {}, {}},
              {{"quad", PatchClass::IrregularQuad}, 4, {}, {}}}
{
    ControlMesh const& control = mesh().mesh();
    if (mesh().steps() > 0) {
        normals_ = vertices_as_poles(control);
    } else {
        std::vector<glm::vec3> const normals = vertex_normals(control);
        for (std::size_t v = 0; v < normals.size(); ++v)
            for (glm::vec3 const& part : {control.positions[v], normals[v]})
                for (int k = 0; k < 3; ++k) // + 0: no -0, whose sign a sum may or may not keep
                    vertices_.push_back(part[k] + 0.0f);
    }
    std::vector<char> const hidden = hidden_faces(mesh(), warnings_);
    for (std::uint32_t f = 0; f < control.faces(); ++f) {
        if (hidden[f]) continue;
        auto const face = control.face(f);
        Group& g = groups_[face.size() - 3];
        g.patches.push_back(mesh().place(f));
        g.indices.insert(g.indices.end(), face.begin(), face.end());
    }
}

VertexSource CageForm::vertices(CommandList& list, SurfaceSettings const& s) const
{
    if (mesh().steps() == 0) return {vertices_, 6, 6};
    VertexSource out = add_vertices(list, mesh(), s);
    out.normals = add_pole_normals(list, normals_, out, s.machine, "vertex normals");
    return out;
}

HullShader CageForm::hull_shader(int sides, SurfaceSettings const& s) const
{
    if (sides == 3) return bind_hull_shader(cage_hull_shader<TessellatorDomain::Tri>(s), s.machine);
    return bind_hull_shader(cage_hull_shader<TessellatorDomain::Quad>(s), s.machine);
}

CommandList CageForm::commands(SurfaceSettings const& s) const
{
    CommandList list;
    VertexSource const source = vertices(list, s);
    for (Group const& g : groups_) {
        if (g.patches.empty()) continue;
        add_patch_draw(list,
                       {g.kind, source, g.sides, g.indices, g.patches,
                        vertex_shader(s, mesh().steps() == 0), hull_shader(g.sides, s),
                        domain_shader(g.sides, s)},
                       s);
    }
    return list;
}

std::vector<PatchCount> CageForm::patch_counts() const
{
    std::vector<PatchCount> out;
    for (Group const& g : groups_)
        if (!g.patches.empty()) out.push_back({g.kind, g.patches.size(), 1, g.sides, g.sides});
    return out;
}

} // namespace tessemu
