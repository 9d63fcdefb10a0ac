// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/isolated/nets.h"

#include "pipeline/schemes/isolated/programs.h"
#include "pipeline/schemes/stam/eigen.h"

#include <algorithm>
#include <set>

namespace tessemu {

namespace {

constexpr int kRimPoints = 12; // p, e+, e-

// The corner of a face where a vertex is not of four edges; 4: none.
int extraordinary_corner(Topology const& topology, std::uint32_t face)
{
    auto const corners = topology.mesh().face(face);
    for (int i = 0; i < 4; ++i)
        if (topology.valence(corners[std::size_t(i)]) != 4) return i;
    return 4;
}

// Of its extraordinary vertex, or 4.
int valence_of_face(Topology const& topology, std::uint32_t face)
{
    int const corner = extraordinary_corner(topology, face);
    return corner == 4 ? 4 : int(topology.valence(topology.mesh().face(face)[std::size_t(corner)]));
}

bool is_at_boundary(Topology const& topology, std::uint32_t face)
{
    auto const corners = topology.mesh().face(face);
    return std::any_of(corners.begin(), corners.end(),
                       [&](std::uint32_t v) { return topology.is_boundary(v); });
}

std::vector<int> valences_of(Topology const& topology, int most)
{
    std::set<int> out;
    for (std::uint32_t f = 0; f < topology.mesh().faces(); ++f)
        if (int const n = valence_of_face(topology, f);
            n != 4 && n >= 3 && n <= most && !is_at_boundary(topology, f))
            out.insert(n);
    return {out.begin(), out.end()};
}

std::vector<PatchKind> kinds_of(std::string const& name, std::vector<int> const& valences)
{
    std::vector<PatchKind> out{{"regular quad", PatchClass::RegularQuad},
                               {"Gregory quad", PatchClass::Other}};
    for (int n : valences)
        out.push_back({name + " of valence " + std::to_string(n),
                       PatchClass::IrregularQuad,
                       {"spoke", "outer edge", "outer edge", "spoke"}});
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

// Behind the control points that are there.
void insert_points(PatchStencils& s, std::vector<StencilRow> const& points)
{
    s.rows.insert(s.rows.begin() + s.control_points, points.begin(), points.end());
    for (int& row : s.corner_row) row += int(points.size());
    s.control_points += int(points.size());
}

} // namespace

MeshRequirements IsolatedNets::requirements()
{
    MeshRequirements takes;
    takes.steps = 1;
    takes.steps_with_triangles = takes.steps_with_polygons = 2;
    return takes;
}

std::vector<SchemeParameter> IsolatedNets::parameters()
{
    auto const words = [](char const* name, char const* meaning, std::vector<std::string> allowed) {
        return SchemeParameter{name, meaning, 0, 0, 0, std::move(allowed)};
    };
    return {words("edges", "points on edges: each patch alone, or with equal bits in all",
                  {"paper", "shared"}),
            words("regular", "regular patches: a Bezier hull shader, or a B-spline domain shader",
                  {"bezier", "bspline"})};
}

std::vector<std::pair<std::string, std::string>> IsolatedNets::watertight_with()
{
    return {{"edges", "shared"}};
}

IsolatedNets::IsolatedNets(std::shared_ptr<RefinedMesh const> refined, Net net,
                           Parameters const& parameters)
    : IsolatedNets(refined, net, parameters, valences_of(refined->topology(), net.max_valence))
{
}

IsolatedNets::IsolatedNets(std::shared_ptr<RefinedMesh const> refined, Net net,
                           Parameters const& parameters, std::vector<int> valences)
    : StencilForm(std::move(refined), kinds_of(net.name, valences)),
      net_(std::move(net)),
      shared_edges_(parameters.word("edges") == "shared"),
      bspline_(parameters.word("regular") == "bspline"),
      valences_(std::move(valences))
{
    gregory_.smooth_corners = mesh().base().smooth_corners();
}

void IsolatedNets::make_nets(ThreadPool const* threads)
{
    make_tables(threads);
    say_gregory(at_boundary_, "at the boundary", net_.boundary);
    say_gregory(at_two_edges_, "at a vertex of 2 edges", net_.valence);
    say_gregory(at_many_edges_,
                "at a vertex of more than " + std::to_string(net_.max_valence) + " edges",
                net_.valence);
}

void IsolatedNets::say_gregory(Gregory const& faces, std::string const& where,
                               std::string const& why)
{
    if (faces.count == 0) return;
    draws_another_way({faces.first, (faces.count == 1 ? "1 patch " + where + " is a Gregory patch"
                                                      : std::to_string(faces.count) + " patches " +
                                                            where + " are Gregory patches") +
                                        ", not " + net_.promise + ": " + why});
}

std::size_t IsolatedNets::kind_of(std::uint32_t face) const
{
    Topology const& topology = mesh().topology();
    if (is_at_boundary(topology, face)) return kGregoryQuad;
    int const n = valence_of_face(topology, face);
    if (n == 4) return kRegularQuad;
    auto const at = std::find(valences_.begin(), valences_.end(), n);
    return at == valences_.end() ? kGregoryQuad : kFirstNet + std::size_t(at - valences_.begin());
}

void IsolatedNets::turn_to(Neighbourhood& n, int rotation)
{
    int const turns = (rotation - n.rotation + 4) % 4;
    n.rotation = rotation;
    std::rotate(n.corner, n.corner + turns, n.corner + 4);
    std::rotate(n.ring_shift, n.ring_shift + turns, n.ring_shift + 4);
}

std::vector<int> IsolatedNets::net_of(Neighbourhood const& patch)
{
    std::vector<int> out{patch.corner[0].vertex()};
    auto const& ring = patch.corner[0].faces;
    for (auto const& face : ring) {
        out.push_back(face.vertices[1]);
        out.push_back(face.vertices[2]);
    }
    // Face j of a regular corner's ring lies j quarters counter-clockwise from the patch.
    auto const at = [&](std::size_t corner, std::size_t face, std::size_t vertex) {
        out.push_back(patch.corner[corner].faces[face].vertices[vertex]);
    };
    at(2, 2, 2), at(1, 3, 2), at(1, 3, 1), at(1, 2, 2); // (2,2) (2,1) (2,0) (2,-1)
    at(2, 3, 1), at(3, 2, 1), at(3, 2, 2);              // (1,2) (0,2) (-1,2)
    return out;
}

namespace {

// The net of a regular patch, in the order of RegularNet.
std::vector<int> grid_of(std::vector<int> const& net)
{
    std::vector<int> out;
    for (int x = -1; x <= 2; ++x)
        for (int y = -1; y <= 2; ++y) out.push_back(net[std::size_t(stam_net_point(4, x, y))]);
    return out;
}

} // namespace

void IsolatedNets::arrange(std::uint32_t face, Neighbourhood& n) const
{
    std::size_t const kind = kind_of(face);
    if (kind == kGregoryQuad) return;
    if (kind != kRegularQuad) turn_to(n, extraordinary_corner(mesh().topology(), face));
    if (shared_edges_) return;
    std::vector<int> net = net_of(n);
    if (kind == kRegularQuad)
        net = grid_of(net);
    else if (takes_corners_alone(kind))
        net.resize(4);
    set_inputs(n, net);
}

void IsolatedNets::added(std::size_t kind, std::uint32_t face, Neighbourhood const& n)
{
    if (kind >= kFirstNet) return net_added(kind, face, n);
    if (kind != kGregoryQuad) return;
    Topology const& topology = mesh().topology();
    Gregory& faces = is_at_boundary(topology, face)         ? at_boundary_
                     : valence_of_face(topology, face) == 2 ? at_two_edges_
                                                            : at_many_edges_;
    ++faces.count;
    faces.first = std::min(faces.first, mesh().base().file_face(mesh().place(face).face));
}

PatchStencils IsolatedNets::rim_stencils(Neighbourhood const& patch,
                                         std::vector<StencilRow> const& points) const
{
    PatchStencils out = make_gregory_stencils(patch, true, gregory_);
    out.rows.erase(out.rows.begin() + kRimPoints, out.rows.begin() + out.control_points);
    for (int& row : out.corner_row) row -= out.control_points - kRimPoints;
    out.control_points = kRimPoints;
    insert_points(out, points);
    return out;
}

PatchStencils IsolatedNets::stencils(std::size_t kind, Neighbourhood const& patch) const
{
    if (kind >= kFirstNet) return net_stencils(kind, patch);
    if (kind == kGregoryQuad) {
        PatchStencils out = make_gregory_stencils(patch, false, gregory_);
        if (shared_edges_) return out;
        std::vector<StencilRow> corners; // for tess factors
        for (CornerNeighbourhood const& c : patch.corner)
            corners.push_back(unit_row(out.inputs, c.vertex()));
        insert_points(out, corners);
        return out;
    }
    if (!shared_edges_) { // no row: its hull shader knows the net
        PatchStencils out;
        out.inputs = int(patch.inputs.size());
        return out;
    }
    if (!bspline_) return make_gregory_stencils(patch, true, gregory_);
    std::vector<StencilRow> grid;
    for (int i : grid_of(net_of(patch))) grid.push_back(unit_row(int(patch.inputs.size()), i));
    return rim_stencils(patch, grid);
}

HullShader IsolatedNets::hull_shader(std::size_t kind, RowBuffers const& buffers,
                                     SurfaceSettings const& s) const
{
    if (kind >= kFirstNet) return net_hull_shader(kind, buffers, s);
    if (shared_edges_) {
        int const points = kind == kGregoryQuad ? GregoryQuadInside::kControlPoints
                           : bspline_           ? BsplineRowsInside::kControlPoints
                                                : RegularQuadInside::kControlPoints;
        return stencil_hull_shader<StencilQuadHullShader, 4>(buffers, points, s);
    }
    if (kind == kGregoryQuad)
        return stencil_hull_shader<CagedStencilHullShader, 4>(
            buffers, CagedGregoryInside::kControlPoints, s);
    if (bspline_) return bind_hull_shader(BsplineQuadHullShader{s.factor_rule()}, s.machine);
    return bind_hull_shader(BezierHullShader{{s.factor_rule()}}, s.machine);
}

DomainShader IsolatedNets::domain_shader(std::size_t kind, SurfaceSettings const& s) const
{
    if (kind >= kFirstNet) return net_domain_shader(kind, s);
    if (shared_edges_) {
        if (kind == kGregoryQuad) return surface_shader<GregoryQuadDomainShader>(s);
        if (bspline_) return surface_shader<BsplineRowsDomainShader>(s);
        return surface_shader<RegularQuadDomainShader>(s);
    }
    if (kind == kGregoryQuad) return surface_shader<CagedGregoryDomainShader>(s);
    if (bspline_) return bind_surface(BsplineQuadDomainShader{}, s);
    return bind_surface(BezierQuadDomainShader{}, s);
}

} // namespace tessemu
