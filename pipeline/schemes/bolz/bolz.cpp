// bolz: Bolz and Schroeder's tessellation by basis-function tables and pixel shaders, 2003.
//
//     control points as constants ─> positions, a quad a patch ─┐  float targets
//                                 ─> normals, a quad a patch   ─┴─> vertices of an indexed draw
//
// The surface is the limit surface of the mesh's own rules, creases, darts and corners included
// (docs/bolz03.md).
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/commands/displacement.h"
#include "pipeline/mesh/biermann.h"
#include "pipeline/schemes/bolz/adaptive.h"
#include "pipeline/schemes/bolz/passes.h"
#include "pipeline/schemes/scheme.h"
#include "shaders_cpp/bolz/table_vertex_shader.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace tessemu {

namespace {

/// Normals at the patches' own corners.
struct Corners {
    std::span<float const> normals, shared, poles;
};

Corners add_corners(CommandList& list, TablePatches const& t, VertexSource const& positions,
                    Machine const& machine)
{
    Corners out;
    out.poles = add_pole_normals(list, t.poles, positions, machine);
    std::size_t const corners = t.corners.size() / 3 - 1;
    auto const normals = std::make_shared<std::vector<float>>(3 * corners);
    list.memory.push_back(normals);
    CornerNormalShader cs;
    cs.corners = {t.corners, 0, "corners"};
    cs.vertices = {t.corner_vertices, 1, "corner_vertices"};
    cs.weights = {t.corner_weights, 2, "corner_weights"};
    cs.positions = {positions.floats, 3, "positions"};
    cs.faces = {{out.poles, 4, "pole_normals"}};
    cs.normals = {*normals, 5, "corner_normals"};
    cs.stride = positions.stride;
    list.commands.emplace_back(
        Dispatch{"corner normals", bind_compute_shader(cs, machine), groups_for(corners, 64)});
    out.normals = *normals;
    std::size_t const vertices = t.shared_first.size() - 1;
    if (vertices == 0) return out;
    auto const shared = std::make_shared<std::vector<float>>(3 * vertices);
    list.memory.push_back(shared);
    SharedNormalShader mean;
    mean.first = {t.shared_first, 0, "first_sides"};
    mean.corners = {t.shared_corners, 1, "sides"};
    mean.normals = {*normals, 2, "corner_normals"};
    mean.shared = {*shared, 3, "shared_normals"};
    list.commands.emplace_back(
        Dispatch{"shared normals", bind_compute_shader(mean, machine), groups_for(vertices, 64)});
    out.shared = *shared;
    return out;
}

/// Patches of one kind and one grid, which one draw shows.
struct ShownPatches {
    std::vector<PatchPlace> places;
    std::vector<std::uint32_t> words; ///< [patch][TablePatchWords]
};

std::vector<std::uint32_t> words_of(TablePatches const& t, std::size_t patch, Passes const& frame)
{
    using W = TablePatchWords;
    TablePatches::Patch const& p = t.patches[patch];
    std::vector<std::uint32_t> out(W::kCount, W::kNone);
    Cells::Cell const cell = frame.cells.of_patch[patch];
    out[W::kX] = std::uint32_t(cell.x);
    out[W::kY] = std::uint32_t(cell.y);
    out[W::kCorner] = p.corner;
    for (std::size_t k = 0; k < 4; ++k) out[std::size_t(W::kPole) + k] = p.poles[k];
    out[W::kShared] = p.shared;
    for (std::size_t e = 0; e < 2; ++e) {
        if (p.across[e] == TablePatches::kNone) continue;
        Cells::Cell const other = frame.cells.of_patch[p.across[e]];
        std::size_t const at = std::size_t(W::kAcross) + 3 * e;
        out[at] = std::uint32_t(other.x);
        out[at + 1] = std::uint32_t(other.y);
        out[at + 2] = 1u << frame.levels[p.across[e]].inside;
    }
    return out;
}

// Near the middle of a mesh, a multiple of an eighth of its size and a power of two: sums round in
// units of what they add, and of a point near 0 a difference to it loses less than they do.
std::array<float, 3> origin_of(ControlMesh const& mesh)
{
    glm::vec3 low(INFINITY), high(-INFINITY);
    for (glm::vec3 const& p : mesh.positions) low = min(low, p), high = max(high, p);
    float const size = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    std::array<float, 3> out{};
    if (!(size > 0)) return out;
    float const step = std::ldexp(1.0f, std::ilogb(size) - 3);
    for (int k = 0; k < 3; ++k)
        out[std::size_t(k)] = std::floor((low[k] + high[k]) / 2 / step + 0.5f) * step + 0.0f;
    return out;
}

class BolzPatches final : public PatchMesh {
public:
    BolzPatches(std::shared_ptr<RefinedMesh const> refined, Parameters const& parameters,
                BuildServices const& services)
        : PatchMesh(std::move(refined)),
          order_(parameters.word("order") == "global" ? TableOrder::Global : TableOrder::Table),
          origin_(origin_of(mesh().base())),
          hidden_(hidden_faces(mesh(), warnings_)),
          basis_(mesh(), services.tables, {.enforced = parameters.word("tables") == "enforced"},
                 services.progress),
          tables_(mesh(), basis_, order_, hidden_)
    {
        if (auto const distance = parameters.number_if_given("adapt")) adapt(*distance);
    }

    CommandList commands(SurfaceSettings const& s) const override
    {
        if (s.adaptive_rule.kind != TessFactorRule::Kind::Uniform)
            throw Error("bolz has no tessellator: its patches have one number of segments, or by "
                        "adapt=D each its own");
        CommandList list;
        if (tables_.patches.empty()) return list;
        VertexSource const positions = add_vertices(list, mesh(), s, 0, origin_);
        auto const frame = std::make_shared<Passes>(tables_, s.machine, levels(s));
        auto const constants = std::make_shared<std::vector<float>>(4 * tables_.vertices.size());
        list.memory.push_back(frame);
        list.memory.push_back(constants);
        frame->constants = *constants;
        PatchConstantsShader cs;
        cs.vertices = {tables_.vertices, 0, "patch_vertices"};
        cs.positions = {positions.floats, 1, "positions"};
        cs.constants = {*constants, 2, "patch_constants"};
        cs.stride = positions.stride;
        list.commands.emplace_back(Dispatch{"patch constants", bind_compute_shader(cs, s.machine),
                                            groups_for(tables_.vertices.size(), 64)});
        Corners const corners = add_corners(list, tables_, positions, s.machine);
        add_passes(list, frame, order_);
        for (TablePatches::Kind const& k : tables_.kinds) add_surface(list, k, frame, corners, s);
        list.memory.push_back(s.pose);
        return list;
    }

    std::vector<PatchCount> patch_counts() const override
    {
        std::vector<PatchCount> out;
        for (TablePatches::Kind const& k : tables_.kinds) {
            PatchCount c{k.kind, k.count, 0, 0, 0};
            std::vector<std::uint32_t> types;
            for (std::uint32_t p = k.first; p < k.first + k.count; ++p)
                types.push_back(tables_.patches[p].type);
            std::sort(types.begin(), types.end());
            types.erase(std::unique(types.begin(), types.end()), types.end());
            c.types = types.size();
            c.min_inputs = INT32_MAX;
            for (std::uint32_t t : types) {
                c.min_inputs = std::min(c.min_inputs, basis_.types()[t].points);
                c.max_inputs = std::max(c.max_inputs, basis_.types()[t].points);
            }
            out.push_back(c);
        }
        return out;
    }
    std::vector<std::string> warnings() const override { return warnings_; }
    bool has_creases() const override { return tables_.has_creases; }
    std::vector<std::uint64_t> level_counts() const override
    {
        std::vector<std::uint64_t> out;
        if (!adaptive_.empty()) out.assign(kTableSteps + 1, 0);
        for (GridLevels const& l : adaptive_) ++out[l.inside];
        return out;
    }

private:
    // From the mesh at rest, so that levels do not change while it moves.
    void adapt(double distance)
    {
        std::vector<DrawnPatch> drawn;
        for (TablePatches::Patch const& p : tables_.patches)
            drawn.push_back({p.face, p.neighbours});
        double const diagonal = bounding_box_diagonal(mesh().base());
        AdaptiveLevels found = adaptive_levels(drawn, basis_, mesh().mesh(), distance * diagonal,
                                               {origin_[0], origin_[1], origin_[2]});
        adaptive_ = std::move(found.patches);
        if (found.beyond == 0) return;
        warnings_.push_back(fmt::format(
            "adapt={}: {} of {} patches may lie further from the surface than that with 32 "
            "segments, by the bound up to {:.4g} diagonals: {}",
            distance, found.beyond, drawn.size(), found.largest / diagonal,
            found.rounding > distance * diagonal
                ? fmt::format("{:.2g} of it is what single precision may add",
                              found.rounding / diagonal)
                : "a step of subdivision before (--subdivide) halves patches"));
    }
    std::vector<GridLevels> levels(SurfaceSettings const& s) const
    {
        if (!adaptive_.empty()) return adaptive_;
        int level = 0;
        while (level <= kTableSteps && float(1 << level) < s.tess_factor) ++level;
        if (level > kTableSteps)
            throw Error("bolz: " + std::to_string(int(std::ceil(s.tess_factor))) +
                        " segments along an edge of a patch, its tables have 32: a step of "
                        "subdivision before it (--subdivide) doubles them");
        auto const l = std::uint8_t(level);
        return std::vector<GridLevels>(tables_.patches.size(), {l, {l, l, l, l}});
    }

    void add_surface(CommandList& list, TablePatches::Kind const& kind,
                     std::shared_ptr<Passes> const& frame, Corners const& corners,
                     SurfaceSettings const& s) const
    {
        std::map<GridLevels, ShownPatches> by_grid;
        for (std::uint32_t p = kind.first; p < kind.first + kind.count; ++p) {
            ShownPatches& shown = by_grid[frame->levels[p]];
            TablePatches::Patch const& patch = tables_.patches[p];
            shown.places.push_back(mesh().place(patch.face, int(patch.rotation)));
            std::vector<std::uint32_t> const words = words_of(tables_, p, *frame);
            shown.words.insert(shown.words.end(), words.begin(), words.end());
        }
        for (auto& by : by_grid) { // no binding: clang 14 captures none
            GridLevels const& levels = by.first;
            ShownPatches& patches = by.second;
            auto const shown = std::make_shared<ShownPatches>(std::move(patches));
            auto const grid = std::make_shared<PatchGrid const>(make_patch_grid(levels));
            list.memory.push_back(shown);
            list.memory.push_back(grid);
            Draw out;
            out.name = kind.kind.name;
            out.kind = kind.kind;
            out.patches = shown->places;
            out.grid = {grid, &grid->points};
            SurfaceEpilog const epilog = make_surface_epilog(shown->places, s);
            list.memory.push_back(epilog.memory);
            std::visit(
                [&](auto const& e) {
                    TableVertexShader<std::remove_cvref_t<decltype(e)>> vs;
                    vs.positions = texture_of(frame->positions, 0, "positions");
                    vs.normals = texture_of(frame->normals, 1, "normals");
                    vs.corner_normals = {corners.normals, 2, "corner_normals"};
                    vs.shared_normals = {corners.shared, 3, "shared_normals"};
                    vs.poles = {{corners.poles, 4, "pole_normals"}};
                    vs.patches = {shown->words, 5, "patches"};
                    vs.places = {grid->places, 6, "grid_places"};
                    vs.level = levels.inside;
                    vs.origin = origin_;
                    vs.has_poles = tables_.has_poles;
                    vs.has_creases = tables_.has_creases;
                    vs.epilog = e;
                    out.pipeline.vertex_shader = bind_vertex_shader(vs, s.machine);
                },
                epilog.shader);
            out.call.topology = PrimitiveTopology::TriangleList;
            out.call.indices = std::span<std::uint32_t const>(grid->points.patch.indices);
            out.call.instance_count = std::uint32_t(shown->places.size());
            list.commands.emplace_back(std::move(out));
        }
    }

    TableOrder order_;
    std::array<float, 3> origin_;
    std::vector<std::string> warnings_;
    std::vector<char> hidden_;
    MeshBasis basis_;
    TablePatches tables_;
    std::vector<GridLevels> adaptive_; // by patch; empty: by the tess factor
};

class Bolz final : public Scheme {
public:
    SchemeInfo info() const override
    {
        SchemeInfo info{"bolz", "BOLZ03", "2, 2.1, 3",
                        "the limit surface with all its tags, from tables of basis functions by "
                        "pixel shaders, up to 32 segments along an edge of a patch"};
        info.takes.steps = 1;
        info.takes.steps_with_triangles = info.takes.steps_with_polygons = 2;
        info.takes.creases = info.takes.corners = true;
        info.takes.edges = PatchType::kMostFaces;
        auto const words = [](char const* name, char const* meaning,
                              std::vector<std::string> allowed) {
            return SchemeParameter{name, meaning, 0, 0, 0, std::move(allowed)};
        };
        info.parameters = {
            words("rules", "of subdivision beside tags", {"opensubdiv", "biermann"}),
            {"flatness",
             "with rules=biermann, how far a step draws rings of tagged and extraordinary vertices "
             "into their tangent planes; where it is not given, as far as concave corners need",
             {},
             0,
             1},
            words("order", "of a patch's sums: one for the mesh, bit-exact, or that of its tables",
                  {"global", "table"}),
            words("tables", "weights of shared points: made equal (2.1.1), or as they were made",
                  {"enforced", "unenforced"}),
            {"adapt",
             "each patch has its own segments, 1 to 32, so that its triangles lie within so many "
             "diagonals of the model's box of the surface",
             {},
             1e-9,
             1}};
        info.watertight_with = {{"order", "global"}, {"tables", "enforced"}};
        info.tessellator = false;
        info.no_curvature = "its tables have no second derivatives";
        return info;
    }
    void set_rules(ControlMesh& mesh, Parameters const& parameters,
                   WarningSink const& warn) const override
    {
        std::optional<double> const flatness = parameters.number_if_given("flatness");
        if (parameters.word("rules") != "biermann") {
            if (flatness)
                throw Error("bolz: flatness is a part of rules=biermann, and rules is " +
                            parameters.word("rules"));
            return;
        }
        mesh.rules.flatness = flatness;
        check_sharpness_for_biermann(mesh);
        mesh.rules.sectors = SectorRules::Biermann;
        for (std::string const& w : in_words(mark_concave_sectors(mesh), mesh)) warn(w);
    }
    std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const> mesh,
                                     Parameters const& parameters,
                                     BuildServices const& services) const override
    {
        return std::make_unique<BolzPatches>(std::move(mesh), parameters, services);
    }
};

} // namespace

std::unique_ptr<Scheme> make_bolz()
{
    return std::make_unique<Bolz>();
}

} // namespace tessemu
