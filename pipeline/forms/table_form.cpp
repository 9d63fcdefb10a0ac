// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/table_form.h"

#include "pipeline/commands/refinement_pattern.h"
#include "pipeline/commands/subdivision.h"
#include "pipeline/forms/table_shaders.h"
#include "shaders_cpp/bolz/patch_constants_shader.h"
#include "shaders_cpp/gradient_points_shader.h"
#include "shaders_cpp/pass_through.h"

#include <algorithm>
#include <cmath>

namespace tessemu {

namespace {

// Inside a mesh a patch's corner is regular with six triangles, or four quads.
PatchKind kind_of(LocalMesh const& type)
{
    ControlMesh const mesh = type.mesh();
    Topology const topology(mesh);
    bool const is_triangle = type.sides() == 3;
    bool is_regular = true, is_tagged = !type.creases.empty() || !type.corners.empty();
    for (std::uint32_t v = 0; v < std::uint32_t(type.sides()); ++v) {
        is_tagged = is_tagged || topology.is_boundary(v);
        is_regular = is_regular && topology.ring(v).size() == (is_triangle ? 6 : 4);
    }
    if (is_tagged) return {"crease or boundary", PatchClass::Crease};
    if (is_triangle)
        return is_regular ? PatchKind{"regular triangle", PatchClass::Triangle}
                          : PatchKind{"irregular triangle", PatchClass::Other};
    return is_regular ? PatchKind{"regular quad", PatchClass::RegularQuad}
                      : PatchKind{"irregular quad", PatchClass::IrregularQuad};
}

} // namespace

int TableForm::more_steps(Parameters const& parameters, int steps)
{
    return std::max(0, std::stoi(parameters.word("shading")) - steps);
}

std::vector<SchemeParameter> TableForm::parameters(bool has_tangents, int steps)
{
    std::vector<SchemeParameter> out{
        {"mesher",
         "points of a patch: Direct3D 11's, linear between samples, or those of a refinement "
         "pattern, all of them samples",
         0,
         0,
         0,
         {"tessellator", "pattern"}},
        {"tables",
         "weights of shared points: made equal (BOLZ03 2.1.1), or as a generator in single "
         "precision makes them for each patch",
         0,
         0,
         0,
         {"enforced", "unenforced"}}};
    // Of the mesh that the tables start from, of the file's, or a step later.
    SchemeParameter shading{"shading",
                            "steps of subdivision after which normals are taken of the faces; "
                            "from there on they are subdivided as positions are",
                            0,
                            0,
                            0,
                            {std::to_string(steps), "0"}};
    if (steps < 2) shading.words.push_back("2");
    out.insert(out.begin() + 1, std::move(shading));
    if (!has_tangents) return out;
    out.insert(out.begin() + 1,
               {"normals",
                "summed by the weights of positions (subdivision shading), or of the surface, from "
                "tables of tangents",
                0,
                0,
                0,
                {"shading", "tangents"}});
    out.push_back({"initial",
                   "passes before the patches: the steps, then normals of the faces around, or one "
                   "for all, with normals of the surface by gradient masks",
                   0,
                   0,
                   0,
                   {"passes", "gradients"}});
    return out;
}

TableForm::TableForm(std::shared_ptr<RefinedMesh const> refined, Rules const& rules,
                     Parameters const& parameters, BuildServices const& services)
    : PatchMesh(std::move(refined)),
      mesher_(parameters.word("mesher") == "pattern" ? Mesher::Pattern : Mesher::Tessellator),
      normals_(rules.gradients && parameters.word("normals") == "tangents" ? Normals::Tangents
               : parameters.word("shading") == "0"                         ? Normals::Carried
                                                                           : Normals::Shading),
      tables_(
          mesh().topology(), rules.make,
          {.enforced = parameters.word("tables") == "enforced",
           .rings = std::max(rules.rings,
                             mesh().mesh().rules.crease_method == CreaseMethod::Chaikin ? 2 : 1)},
          services.progress),
      sectors_(entries(tables_.vertices())),
      wholes_(entries(tables_.whole_vertices()))
{
    for (MeshTables::Point const& p : tables_.points()) {
        points_.push_back(p.vertex);
        points_.push_back(p.column);
    }
    add_kinds();
    if (rules.gradients && parameters.word("initial") == "gradients") add_gradients(rules);
    if (normals_ == Normals::Tangents) add_corner_terms();
    if (normals_ != Normals::Carried) return;
    Topology const& base = mesh().base_topology();
    std::vector<TableVertex> vertices;
    for (std::uint32_t v = 0; v < mesh().base().positions.size(); ++v)
        vertices.push_back(make_table_vertex(base, v, 0, base.ring(v).size(),
                                             base.ring(v).empty() || base.is_boundary(v),
                                             file_rings_));
    file_entries_ = entries(vertices);
}

void TableForm::add_gradients(Rules const& rules)
{
    if (normals_ == Normals::Tangents)
        throw Error("initial=gradients makes normals that normals=tangents does not read");
    if (normals_ == Normals::Carried)
        throw Error("initial=gradients makes normals of the surface, shading=0 carries along those "
                    "of the file's mesh: take one of them");
    if (mesh().mesh().rules.sectors == SectorRules::Biermann)
        throw Error("initial=gradients has no masks by Biermann's rules: initial=passes does");
    gradients_.emplace(rules.gradients(mesh(), tables_.vertices(), tables_.rings()));
    if (tables_.has_creases())
        whole_gradients_.emplace(
            rules.gradients(mesh(), tables_.whole_vertices(), tables_.rings()));
    // The pass makes no other positions, so factors too are of these.
    std::vector<std::uint32_t> one_of(mesh().mesh().positions.size());
    for (std::uint32_t i = 0; i < tables_.vertices().size(); ++i)
        one_of[tables_.vertices()[i].vertex] = i;
    for (Kind& k : kinds_)
        for (std::uint32_t& corner : k.corners) corner = one_of[corner];
}

std::vector<std::uint32_t> TableForm::entries(std::span<TableVertex const> vertices)
{
    std::vector<std::uint32_t> out;
    for (TableVertex const& v : vertices)
        out.insert(out.end(), {v.vertex, v.first_ring, 2 * v.ring + (v.is_open ? 1u : 0u)});
    return out;
}

HalfEdge TableForm::half_edge(MeshTables::Patch const& p, int corner) const
{
    ControlMesh const& m = mesh().mesh();
    return m.face_start[p.face] + HalfEdge(corner + p.rotation) % HalfEdge(m.face(p.face).size());
}

// Tangents of a sector of a vertex, of the first patch that has it at a corner.
void TableForm::add_corner_terms()
{
    std::vector<std::pair<MeshTables::Patch const*, int>> owner(tables_.sectors());
    for (MeshTables::Patch const& p : tables_.patches())
        for (int k = 0; k < tables_.types()[p.type].grid.sides; ++k) {
            auto& of = owner[tables_.sector(half_edge(p, k))];
            if (!of.first) of = {&p, k};
        }
    for (auto const& [p, corner] : owner) {
        corners_.insert(corners_.end(), {std::uint32_t(corner_terms_.size()),
                                         std::uint32_t(CornerNormalShader::Faces::None), 0u});
        TypeOfTables const& t = tables_.types()[p->type];
        auto const samples = std::size_t(t.grid.samples());
        auto const at = std::size_t(t.grid.on_side(corner, 0));
        for (MeshTables::Point const& x :
             tables_.points().subspan(p->first_point, std::size_t(t.points))) {
            float const a = t.tangents[0][x.column * samples + at],
                        b = t.tangents[1][x.column * samples + at];
            if (a == 0 && b == 0) continue;
            corner_terms_.push_back(tables_.vertices()[x.vertex].vertex);
            corner_weights_.insert(corner_weights_.end(), {a, b});
        }
    }
    corners_.insert(corners_.end(), {std::uint32_t(corner_terms_.size()), 0u, 0u});
}

std::span<float const> TableForm::add_corner_normals(CommandList& list,
                                                     VertexSource const& positions,
                                                     Machine const& machine) const
{
    std::size_t const corners = tables_.sectors();
    auto const normals = std::make_shared<std::vector<float>>(3 * corners);
    list.memory.push_back(normals);
    CornerNormalShader cs;
    cs.corners = {corners_, 0, "corners"};
    cs.vertices = {corner_terms_, 1, "corner_vertices"};
    cs.weights = {corner_weights_, 2, "corner_weights"};
    cs.positions = {positions.floats, 3, "positions"};
    cs.faces = {{{}, 4, "pole_normals"}};
    cs.normals = {*normals, 5, "corner_normals"};
    cs.stride = positions.stride;
    list.commands.emplace_back(
        Dispatch{"corner normals", bind_compute_shader(cs, machine), groups_for(corners, 64)});
    return *normals;
}

void TableForm::add_kinds()
{
    std::vector<std::uint32_t> first_entry;
    std::vector<std::size_t> kind_of_type;
    for (TypeOfTables const& t : tables_.types()) {
        constexpr std::uint64_t kMost = 0x7fffffff;
        if (entries_of_tables_.size() + t.position.size() > kMost)
            throw LimitError("entries of basis-function tables",
                             entries_of_tables_.size() + t.position.size(), kMost);
        first_entry.push_back(std::uint32_t(entries_of_tables_.size()));
        entries_of_tables_.insert(entries_of_tables_.end(), t.position.begin(), t.position.end());
        if (normals_ == Normals::Tangents)
            for (int i : {0, 1})
                entries_of_tangents_[i].insert(entries_of_tangents_[i].end(), t.tangents[i].begin(),
                                               t.tangents[i].end());
        PatchKind kind = kind_of(t.type);
        auto const same = std::find_if(kinds_.begin(), kinds_.end(), [&](Kind const& k) {
            return k.kind.name == kind.name && k.sides == t.grid.sides;
        });
        kind_of_type.push_back(std::size_t(same - kinds_.begin()));
        if (same == kinds_.end())
            kinds_.push_back({std::move(kind), t.grid.sides, {}, {}, {}, {}, {}});
    }
    std::vector<char> const hidden = hidden_faces(mesh(), warnings_);
    for (MeshTables::Patch const& p : tables_.patches()) {
        if (hidden[p.face]) continue;
        Kind& kind = kinds_[kind_of_type[p.type]];
        kind.places.push_back(mesh().place(p.face, p.rotation));
        kind.patches.insert(
            kind.patches.end(),
            {p.first_point, std::uint32_t(tables_.types()[p.type].points), first_entry[p.type]});
        kind.types.push_back(p.type);
        auto const face = mesh().mesh().face(p.face);
        for (int k = 0; k < int(face.size()); ++k) {
            HalfEdge const h = half_edge(p, k);
            kind.corners.push_back(mesh().topology().vertex_of(h));
            kind.sectors.push_back(tables_.sector(h));
        }
    }
    std::erase_if(kinds_, [](Kind const& k) { return k.places.empty(); });
}

std::span<float const> TableForm::add_table_vertices(CommandList& list,
                                                     VertexSource const& positions,
                                                     SurfaceSettings const& s) const
{
    std::size_t const count = tables_.vertices().size();
    auto const vertices =
        std::make_shared<std::vector<float>>(count * std::size_t(TableVertices::kFloats));
    list.memory.push_back(vertices);
    auto const add = [&](char const* name, auto const& shader, std::size_t threads) {
        list.commands.emplace_back(
            Dispatch{name, bind_compute_shader(shader, s.machine), groups_for(threads, 64)});
    };
    if (normals_ != Normals::Carried) {
        TableVerticesShader cs;
        // Displaced, both sides of a crease have to move along one normal.
        cs.mesh = {{s.displacement ? wholes_ : sectors_, 0, "vertex_entries"},
                   {tables_.rings(), 1, "rings"},
                   {positions.floats, 2, "positions"},
                   positions.stride};
        cs.vertices.floats = {*vertices, 3, "table_vertices"};
        add("vertex normals", cs, count);
        return *vertices;
    }
    VertexSource const file = file_vertices(mesh(), positions);
    std::size_t const file_count = mesh().base().positions.size(),
                      first = mesh().tables().back().first_face_point();
    auto const normals = std::make_shared<std::vector<float>>(
        (first + mesh().mesh().positions.size()) * RWVectorBuffer::kStride);
    list.memory.push_back(normals);
    MeshNormalsShader cs;
    cs.mesh = {{file_entries_, 0, "vertex_entries"},
               {file_rings_, 1, "rings"},
               {file.floats, 2, "positions"},
               file.stride};
    cs.normals = {std::span(*normals).first(file.floats.size()), 3, "normals"};
    add("vertex normals", cs, file_count);
    add_subdivision(list, mesh().tables(), *normals, s.machine);
    CarriedVerticesShader carried;
    carried.entries = {sectors_, 0, "vertex_entries"};
    carried.positions = {positions.floats, 1, "positions"};
    carried.normals = {std::span<float const>(*normals).subspan(first * RWVectorBuffer::kStride), 2,
                       "normals"};
    carried.vertices.floats = {*vertices, 3, "table_vertices"};
    carried.stride = positions.stride;
    add("vertices", carried, count);
    return *vertices;
}

TableForm::Sources TableForm::add_initial_pass(CommandList& list, SurfaceSettings const& s) const
{
    using Shader = GradientPointsShader;
    std::size_t const count = tables_.vertices().size();
    auto const vertices =
        std::make_shared<std::vector<float>>(count * std::size_t(Shader::kFloats));
    list.memory.push_back(vertices);
    VertexSource const file = add_file_vertices(list, mesh().base(), s);
    // Displaced, both sides of a crease have to move along one normal.
    Gradients const& of = s.displacement && whole_gradients_ ? *whole_gradients_ : *gradients_;
    Shader cs;
    cs.first = {of.first, 0, "first_terms"};
    cs.vertices = {of.vertices, 1, "term_vertices"};
    cs.weights = {of.weights, 2, "term_weights"};
    cs.positions = {file.floats, 3, "positions"};
    cs.points = {*vertices, 4, "table_vertices"};
    cs.stride = file.stride;
    list.commands.emplace_back(
        Dispatch{"initial pass", bind_compute_shader(cs, s.machine), groups_for(count, 64)});
    return {{*vertices, 3, Shader::kFloats}, *vertices, {}, 0};
}

CommandList TableForm::commands(SurfaceSettings const& s) const
{
    CommandList list;
    if (kinds_.empty()) return list;
    Sources from;
    if (gradients_) {
        from = add_initial_pass(list, s);
    } else {
        from.positions = add_vertices(list, mesh(), s);
        from.vertices = add_table_vertices(list, from.positions, s);
    }
    if (mesher_ == Mesher::Pattern) {
        if (s.adaptive_rule.kind != TessFactorRule::Kind::Uniform)
            throw Error("mesher=pattern refines every patch alike: it takes no factors by edge "
                        "(--tess-edge); mesher=tessellator does");
        constexpr int kMost = 1 << MeshTables::kSteps;
        if (s.tess_factor > float(kMost))
            throw Error("mesher=pattern: " + std::to_string(int(std::ceil(s.tess_factor))) +
                        " segments along an edge of a patch, its tables have " +
                        std::to_string(kMost) +
                        ": a step of subdivision before it (--subdivide) doubles them");
        from.pattern = uniform_segments(s.tess_factor);
    }
    // Displaced, both sides of a crease have to move along one normal, which tangents do not give.
    if (normals_ == Normals::Tangents && !(s.displacement && tables_.has_sharp_edges()))
        from.corner_normals = add_corner_normals(list, from.positions, s.machine);
    for (Kind const& k : kinds_)
        if (k.sides == 3)
            add_draw<TriangleSamples>(list, k, from, s);
        else
            add_draw<QuadSamples>(list, k, from, s);
    list.memory.push_back(s.pose);
    return list;
}

template <class Samples>
void TableForm::add_draw(CommandList& list, Kind const& k, Sources const& from,
                         SurfaceSettings const& s) const
{
    using Shaders = TableShaders<Samples>;
    Samples const samples{1 << MeshTables::kSteps};
    TableGrid const grid{Samples::kCorners, samples.segments};
    TableBuffers buffers;
    buffers.patches = {k.patches, 0, "patches"};
    buffers.points = {points_, 1, "patch_points"};
    buffers.vertices = {from.vertices, 2, "table_vertices"};
    buffers.tables = {entries_of_tables_, 3, "tables"};
    buffers.samples = grid.samples();
    typename Shaders::Patch patch = TablePatch{buffers};
    if (!from.corner_normals.empty()) {
        TangentTablePatch<Samples::kCorners> of_tangents;
        of_tangents.buffers = buffers;
        of_tangents.tangents = {Buffer<float>{entries_of_tangents_[0], 4, "tangent_tables_0"},
                                Buffer<float>{entries_of_tangents_[1], 5, "tangent_tables_1"}};
        of_tangents.corners = {k.sectors, 6, "patch_corners"};
        of_tangents.corner_normals = {from.corner_normals, 7, "corner_normals"};
        for (int c = 0; c < grid.sides; ++c)
            of_tangents.corner_samples[std::size_t(c)] = grid.on_side(c, 0);
        patch = of_tangents;
    }
    if (!from.pattern) {
        add_patch_draw(list,
                       {k.kind, from.positions, Samples::kCorners, k.corners, k.places,
                        bind_vertex_shader(PassThroughVertexShader{}, s.machine),
                        Shaders::hull(s.factor_rule(), s.machine),
                        Shaders::domain(patch, samples, s.machine)},
                       s);
        return;
    }
    Draw out;
    out.name = k.kind.name;
    out.kind = k.kind;
    out.patches = k.places;
    out.grid = uniform_pattern(Samples::kDomain, from.pattern);
    auto const points = std::make_shared<std::vector<float>>();
    for (std::size_t i = 0; i < out.grid->u.size(); ++i)
        points->insert(points->end(), {out.grid->u[i], out.grid->v[i]});
    list.memory.push_back(points);
    SurfaceEpilog const epilog = make_surface_epilog(k.places, s);
    list.memory.push_back(epilog.memory);
    out.pipeline.vertex_shader = Shaders::pattern(patch, samples, epilog, s.machine);
    out.call.topology = PrimitiveTopology::TriangleList;
    out.call.set_vertices(std::span<float const>(*points), 2);
    out.call.indices = std::span<std::uint32_t const>(out.grid->patch.indices);
    out.call.instance_count = std::uint32_t(k.places.size());
    list.commands.emplace_back(std::move(out));
}

std::vector<PatchCount> TableForm::patch_counts() const
{
    std::vector<PatchCount> out;
    for (Kind const& k : kinds_) {
        PatchCount c{k.kind, k.places.size(), 0, INT32_MAX, 0};
        std::vector<std::uint32_t> types = k.types;
        std::sort(types.begin(), types.end());
        types.erase(std::unique(types.begin(), types.end()), types.end());
        c.types = types.size();
        for (std::uint32_t t : types) {
            c.min_inputs = std::min(c.min_inputs, tables_.types()[t].points);
            c.max_inputs = std::max(c.max_inputs, tables_.types()[t].points);
        }
        out.push_back(c);
    }
    return out;
}

} // namespace tessemu
