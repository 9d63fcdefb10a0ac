// stam: exact evaluation of the Catmull-Clark surface (Stam 1998), as LOOP10 4.2 draws it after the
// steps of subdivision that leave every face one extraordinary vertex at most. Regular faces are
// bicubics (4.1); faces at a boundary, of which the paper says nothing, and at a vertex of two
// edges are those of gregory-stencil.
//
// edges=paper evaluates each patch alone; edges=shared gives shared points equal bits
// (docs/stam.md).
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/stencil_form.h"
#include "pipeline/schemes/gregory/stencils.h"
#include "pipeline/schemes/scheme.h"
#include "pipeline/schemes/stam/eigen.h"
#include "pipeline/schemes/stam/programs.h"

#include <algorithm>
#include <set>

namespace tessemu {

namespace {

enum Kind : std::size_t { kRegularQuad, kGregoryQuad, kFirstStamQuad };

// The most points of a net in and out of a hull shader are those of valence 12.
constexpr int kMostInHullShader = (kMaxControlPoints - 8) / 2;

struct Choices {
    bool shared_edges, bspline;
};

// The corner of a face where a vertex is not of four edges; 4: none.
int extraordinary_corner(Topology const& topology, std::uint32_t face)
{
    auto const corners = topology.mesh().face(face);
    for (int i = 0; i < 4; ++i)
        if (topology.valence(corners[std::size_t(i)]) != 4) return i;
    return 4;
}

// Faces without a net: at the boundary, or at a vertex of two edges.
bool has_net(Topology const& topology, std::uint32_t face)
{
    for (std::uint32_t v : topology.mesh().face(face))
        if (topology.is_boundary(v) || topology.valence(v) < 3) return false;
    return true;
}

// Valences of the extraordinary vertices of faces with a net, ascending.
std::vector<int> valences_of(Topology const& topology)
{
    std::set<int> out;
    for (std::uint32_t f = 0; f < topology.mesh().faces(); ++f) {
        int const corner = extraordinary_corner(topology, f);
        if (corner < 4 && has_net(topology, f))
            out.insert(int(topology.valence(topology.mesh().face(f)[std::size_t(corner)])));
    }
    return {out.begin(), out.end()};
}

std::vector<PatchKind> kinds_of(std::vector<int> const& valences)
{
    std::vector<PatchKind> out{{"regular quad", PatchClass::RegularQuad},
                               {"Gregory quad", PatchClass::IrregularQuad}};
    for (int n : valences)
        out.push_back({"Stam quad of valence " + std::to_string(n),
                       PatchClass::IrregularQuad,
                       {"spoke", "outer edge", "outer edge", "spoke"}});
    return out;
}

// Corner 0 becomes corner `turns`.
void turn(Neighbourhood& n, int turns)
{
    n.rotation = (n.rotation + turns) % 4;
    std::rotate(n.corner, n.corner + turns, n.corner + 4);
    std::rotate(n.ring_shift, n.ring_shift + turns, n.ring_shift + 4);
}

// Local numbers of a net's points, in the order of eigen.h; of valence 4 (-1,-1) is f_2.
std::vector<int> net_of(Neighbourhood const& patch)
{
    std::vector<int> out{patch.corner[0].vertex()};
    auto const& ring = patch.corner[0].faces;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        out.push_back(ring[i].vertices[1]);
        out.push_back(ring[i].vertices[2]);
    }
    // Face j of a regular corner's ring lies j quarters counter-clockwise from the patch.
    auto const at = [&](std::size_t corner, std::size_t face, std::size_t vertex) {
        out.push_back(patch.corner[corner].faces[face].vertices[vertex]);
    };
    at(2, 2, 2), at(1, 3, 2), at(1, 3, 1), at(1, 2, 2); // (2,2) (2,1) (2,0) (2,-1)
    at(2, 3, 1), at(3, 2, 1), at(3, 2, 2);              // (1,2) (0,2) (-1,2)
    return out;
}

// The same of a regular patch, in the order of RegularNet.
std::vector<int> grid_of(Neighbourhood const& patch)
{
    std::vector<int> const net = net_of(patch);
    std::vector<int> out;
    for (int x = -1; x <= 2; ++x)
        for (int y = -1; y <= 2; ++y) out.push_back(net[std::size_t(stam_net_point(4, x, y))]);
    return out;
}

// The inputs become those of these local numbers, which may repeat.
void set_inputs(Neighbourhood& n, std::vector<int> const& numbers)
{
    std::vector<std::uint32_t> inputs;
    for (int i : numbers) inputs.push_back(n.inputs[std::size_t(i)]);
    for (int c = 0; c < 4; ++c)
        for (auto& face : n.corner[c].faces)
            for (int k = 0; k < face.sides; ++k) {
                auto const at = std::find(numbers.begin(), numbers.end(), face.vertices[k]);
                face.vertices[k] = int(at - numbers.begin()); // past the end: no input
            }
    n.inputs = std::move(inputs);
    n.numbers.clear();
}

StencilRow unit_row(int inputs, int at)
{
    StencilRow row(static_cast<std::size_t>(inputs));
    row[std::size_t(at)] = 1;
    return row;
}

// What a valence's draws read.
struct Valence {
    int valence = 0, functions = 0;
    std::vector<double> inverse;                 // [function][point]
    std::vector<float> by_point;                 // the same, [point][function]
    std::vector<float> splines, powers;          // see StamTables
    std::vector<std::uint32_t> nets;             // [patch][point], where a dispatch projects them
    std::vector<std::uint32_t> faces, rotations; // by patch
    std::vector<std::uint32_t> words;            // StamPatchWords

    explicit Valence(int n) : valence(n), functions(2 * n + 8)
    {
        StamEigen eigen = stam_eigen(n);
        auto const size = std::size_t(functions);
        for (std::vector<double> const& spline : eigen.splines)
            for (std::size_t f = 0; f < size; ++f)
                for (std::size_t p = 0; p < 16; ++p) splines.push_back(float(spline[p * size + f]));
        std::vector<double> power(size, 1); // 0^0 is 1
        for (int k = 0; k < kStamRings; ++k)
            for (std::size_t f = 0; f < size; ++f) {
                powers.push_back(float(power[f]));
                power[f] *= eigen.eigenvalues[f];
            }
        inverse = std::move(eigen.inverse);
        for (std::size_t p = 0; p < size; ++p)
            for (std::size_t f = 0; f < size; ++f) by_point.push_back(float(inverse[f * size + p]));
    }
    StamTables<> tables() const
    {
        return {functions, {splines, 0, "eigen_functions"}, {powers, 1, "eigenvalue_powers"}};
    }
};

// Faces that take gregory-stencil's patches.
struct Gregory {
    std::size_t count = 0;
    std::uint32_t first = 0xffffffffu; ///< by its number in the file

    void add(RefinedMesh const& mesh, std::uint32_t face)
    {
        ++count;
        first = std::min(first, mesh.base().file_face(mesh.place(face).face));
    }
};

class StamPatches final : public StencilForm {
public:
    StamPatches(std::shared_ptr<RefinedMesh const> refined, std::vector<int> const& valences,
                Choices choices)
        : StencilForm(std::move(refined), kinds_of(valences)),
          choices_(choices)
    {
        gregory_.smooth_corners = mesh().base().smooth_corners();
        for (int n : valences) valences_.emplace_back(n);
        make_tables();
        if (choices_.shared_edges) find_owners();
        say_what_is_different();
    }

    bool has_shared_edges() const override { return choices_.shared_edges; }

private:
    std::size_t kind_of(std::uint32_t face) const override
    {
        Topology const& topology = mesh().topology();
        if (!has_net(topology, face)) return kGregoryQuad;
        int const corner = extraordinary_corner(topology, face);
        if (corner == 4) return kRegularQuad;
        auto const n = int(topology.valence(topology.mesh().face(face)[std::size_t(corner)]));
        auto const at = std::find_if(valences_.begin(), valences_.end(),
                                     [&](Valence const& v) { return v.valence == n; });
        return kFirstStamQuad + std::size_t(at - valences_.begin());
    }
    Valence const& valence(std::size_t kind) const { return valences_[kind - kFirstStamQuad]; }
    /// Whether a dispatch projects a kind's nets.
    bool is_dispatched(std::size_t kind) const
    {
        return kind >= kFirstStamQuad &&
               (choices_.shared_edges || valence(kind).valence > kMostInHullShader);
    }

    void arrange(std::uint32_t face, Neighbourhood& n) const override
    {
        std::size_t const kind = kind_of(face);
        if (kind == kGregoryQuad) return;
        if (kind != kRegularQuad) {
            int const corner = extraordinary_corner(mesh().topology(), face);
            turn(n, (corner - n.rotation + 4) % 4);
        }
        if (choices_.shared_edges) return;
        if (kind == kRegularQuad) return set_inputs(n, grid_of(n));
        std::vector<int> net = net_of(n);
        if (is_dispatched(kind)) net = {net[0], net[1], net[2], net[3]}; // the corners
        set_inputs(n, net);
    }
    void added(std::size_t kind, std::uint32_t face, Neighbourhood const& n) override
    {
        if (kind == kGregoryQuad) {
            Topology const& topology = mesh().topology();
            bool boundary = false;
            for (std::uint32_t v : topology.mesh().face(face))
                boundary = boundary || topology.is_boundary(v);
            (boundary ? at_boundary_ : at_two_edges_).add(mesh(), face);
        }
        if (!is_dispatched(kind)) return;
        Valence& v = valences_[kind - kFirstStamQuad];
        Neighbourhood whole;
        Neighbourhood const* net = &n;
        if (!choices_.shared_edges) { // whose inputs are the corners alone
            find_neighbourhood(mesh().topology(), face, whole);
            turn(whole, (n.rotation - whole.rotation + 4) % 4);
            net = &whole;
        }
        for (int i : net_of(*net)) v.nets.push_back(net->inputs[std::size_t(i)]);
        v.faces.push_back(face);
        v.rotations.push_back(std::uint32_t(n.rotation));
        std::uint32_t const collapsed = collapsed_edges(n);
        v.words.insert(v.words.end(),
                       {StamPatchWords::kNone, (collapsed & 1) | (collapsed >> 3 & 1) << 1});
    }
    /// Where edge 3 of a patch is edge 0 of another one that is drawn.
    void find_owners()
    {
        Topology const& topology = mesh().topology();
        std::vector<std::uint32_t> patch_of(topology.mesh().faces(), StamPatchWords::kNone);
        for (Valence const& v : valences_)
            for (std::size_t p = 0; p < v.faces.size(); ++p)
                patch_of[v.faces[p]] = std::uint32_t(p);
        for (Valence& v : valences_)
            for (std::size_t p = 0; p < v.faces.size(); ++p) {
                HalfEdge const edge3 =
                    topology.mesh().face_start[v.faces[p]] + (v.rotations[p] + 3) % 4;
                v.words[StamPatchWords::kCount * p + StamPatchWords::kOwner] =
                    patch_of[topology.face_of(topology.twin(edge3))];
            }
    }
    void say_what_is_different()
    {
        auto const say = [&](Gregory const& faces, std::string const& where, char const* why) {
            if (faces.count == 0) return;
            draws_another_way(
                {faces.first, (faces.count == 1 ? "1 face " + where + " is a Gregory patch"
                                                : std::to_string(faces.count) + " faces " + where +
                                                      " are Gregory patches") +
                                  ", not exact: " + why});
        };
        say(at_boundary_, "at the boundary",
            "the paper says nothing of boundaries in its tessellation stage");
        say(at_two_edges_, "at a vertex of 2 edges",
            "Stam's evaluation is for vertices of 3 edges and more");
        if (choices_.shared_edges) return; // where the form says it of its rows
        std::size_t wide = 0;
        int most = 0;
        std::uint32_t first = 0xffffffffu;
        for (Valence const& v : valences_)
            if (v.valence > kMostInHullShader && !v.faces.empty()) {
                wide += v.faces.size();
                most = std::max(most, v.valence);
                for (std::uint32_t f : v.faces)
                    first = std::min(first, mesh().base().file_face(mesh().place(f).face));
            }
        if (wide)
            draws_another_way(another_way_of(
                wide, first,
                "a vertex of more than " + std::to_string(kMostInHullShader) + " edges (up to " +
                    std::to_string(most) + "): a dispatch projects their nets before the draw"));
    }

    PatchStencils stencils(std::size_t kind, Neighbourhood const& patch) const override
    {
        if (kind == kGregoryQuad) {
            PatchStencils out = make_gregory_stencils(patch, false, gregory_);
            if (!choices_.shared_edges) {
                std::vector<StencilRow> corners;
                for (CornerNeighbourhood const& c : patch.corner)
                    corners.push_back(unit_row(out.inputs, c.vertex()));
                insert_points(out, corners);
            }
            return out;
        }
        if (choices_.shared_edges) {
            PatchStencils out = make_gregory_stencils(patch, true, gregory_);
            if (kind == kRegularQuad && !choices_.bspline) return out;
            // p, e+, e- are what edges are made of.
            erase_points(out, 12);
            std::vector<StencilRow> grid;
            if (kind == kRegularQuad)
                for (int i : grid_of(patch)) grid.push_back(unit_row(out.inputs, i));
            insert_points(out, grid);
            return out;
        }
        PatchStencils out;
        out.inputs = int(patch.inputs.size());
        if (kind == kRegularQuad || is_dispatched(kind)) return out; // no row
        Valence const& v = valence(kind);
        out.control_points = v.functions;
        out.dense = true;
        for (int f = 0; f < v.functions; ++f)
            out.rows.emplace_back(v.inverse.begin() + f * v.functions,
                                  v.inverse.begin() + (f + 1) * v.functions);
        return out;
    }
    HullShader hull_shader(std::size_t kind, RowBuffers const& buffers,
                           SurfaceSettings const& s) const override
    {
        if (choices_.shared_edges) {
            int const points = kind == kGregoryQuad   ? 20
                               : kind != kRegularQuad ? 12
                               : choices_.bspline     ? BsplineRowsInside::kControlPoints
                                                      : 16;
            return stencil_hull_shader<StencilQuadHullShader, 4>(buffers, points, s);
        }
        if (kind == kGregoryQuad)
            return stencil_hull_shader<CagedStencilHullShader, 4>(
                buffers, CagedGregoryInside::kControlPoints, s);
        if (kind == kRegularQuad) {
            if (choices_.bspline)
                return bind_hull_shader(BsplineQuadHullShader{s.factor_rule()}, s.machine);
            return bind_hull_shader(BezierHullShader{{s.factor_rule()}}, s.machine);
        }
        if (is_dispatched(kind))
            return bind_hull_shader(NetHullShader<StamCorners>{s.factor_rule()}, s.machine);
        StamHullShader<SummedRows<4>> hs;
        hs.points = valence(kind).functions;
        hs.rows = summed_rows<4>(std::get<StencilBuffers>(buffers));
        hs.factors = s.factor_rule();
        return bind_hull_shader(hs, s.machine);
    }
    DomainShader domain_shader(std::size_t kind, SurfaceSettings const& s) const override
    {
        if (choices_.shared_edges) {
            if (kind == kGregoryQuad) return surface_shader<GregoryQuadDomainShader>(s);
            if (choices_.bspline) return surface_shader<BsplineRowsDomainShader>(s);
            return surface_shader<RegularQuadDomainShader>(s);
        }
        if (kind == kGregoryQuad) return surface_shader<CagedGregoryDomainShader>(s);
        if (kind != kRegularQuad)
            return bind_surface(StamPointsDomainShader{{valence(kind).tables()}}, s);
        if (choices_.bspline) return bind_surface(BsplineQuadDomainShader{}, s);
        return bind_surface(BezierQuadDomainShader{}, s);
    }
    bool reads_positions() const override { return true; } // of nets that are projected
    DomainShader prepared_domain_shader(CommandList& list, VertexSource const& positions,
                                        std::size_t kind, SurfaceSettings const& s) const override
    {
        if (!is_dispatched(kind)) return domain_shader(kind, s);
        Valence const& v = valence(kind);
        auto const projected = std::make_shared<std::vector<float>>(3 * v.nets.size());
        list.memory.push_back(projected);
        StamProjectionShader cs;
        cs.inverse = {v.by_point, 0, "inverse_eigenvectors"};
        cs.nets = {v.nets, 1, "nets"};
        cs.positions = {positions.floats, 2, "positions"};
        cs.projected = {*projected, 3, "projected_nets"};
        cs.functions = v.functions;
        cs.stride = positions.stride;
        list.commands.emplace_back(Dispatch{
            "projection, valence " + std::to_string(v.valence), bind_compute_shader(cs, s.machine),
            groups_for(cs.threads(v.faces.size(), v.functions), cs.kThreads[0])});
        StamBufferInside const inside{v.tables(), {*projected, 2, "projected_nets"}};
        if (!choices_.shared_edges) return bind_surface(StamBufferDomainShader{inside}, s);
        return bind_surface(StamSharedDomainShader{inside, {v.words, 3, "patch_words"}}, s);
    }

    static void erase_points(PatchStencils& s, int keep)
    {
        s.rows.erase(s.rows.begin() + keep, s.rows.begin() + s.control_points);
        for (int& row : s.corner_row) row -= s.control_points - keep;
        s.control_points = keep;
    }
    static void insert_points(PatchStencils& s, std::vector<StencilRow> const& points)
    {
        s.rows.insert(s.rows.begin() + s.control_points, points.begin(), points.end());
        for (int& row : s.corner_row) row += int(points.size());
        s.control_points += int(points.size());
    }

    Choices choices_;
    GregoryParameters gregory_;
    std::vector<Valence> valences_; // by kind
    Gregory at_boundary_, at_two_edges_;
};

class Stam final : public Scheme {
public:
    SchemeInfo info() const override
    {
        SchemeInfo info{"stam", "LOOP10", "4.1, 4.2 (Stam 1998)",
                        "exact Catmull-Clark surface: eigen functions at extraordinary vertices, "
                        "regular quads as bicubics"};
        info.takes.steps = 1;
        info.takes.steps_with_triangles = info.takes.steps_with_polygons = 2;
        info.takes.edges = kMostEdges;
        info.parameters = {{"edges",
                            "points on edges: each patch alone, or with equal bits in all",
                            0,
                            0,
                            0,
                            {"paper", "shared"}},
                           {"regular",
                            "regular patches: a Bezier hull shader, or a B-spline domain shader",
                            0,
                            0,
                            0,
                            {"bezier", "bspline"}}};
        info.watertight_with = {{"edges", "shared"}};
        info.no_curvature = {};
        return info;
    }
    std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const> mesh,
                                     Parameters const& parameters) const override
    {
        Choices const choices{parameters.word("edges") == "shared",
                              parameters.word("regular") == "bspline"};
        std::vector<int> const valences = valences_of(mesh->topology());
        return std::make_unique<StamPatches>(std::move(mesh), valences, choices);
    }

private:
    // A net has 2n + 8 rows of as many terms, and a vertex n nets; sums of so many floats are still
    // within 2e-6 of the diagonal (docs/stam.md).
    static constexpr std::uint32_t kMostEdges = 512;
};

} // namespace

std::unique_ptr<Scheme> make_stam()
{
    return std::make_unique<Stam>();
}

} // namespace tessemu
