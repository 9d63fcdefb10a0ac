// stam: exact evaluation of the Catmull-Clark surface (Stam 1998), as LOOP10 4.2 draws it after the
// steps of subdivision that leave every face one extraordinary vertex at most.
//
// edges=paper evaluates each patch alone; edges=shared gives shared points equal bits
// (docs/stam.md).
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/isolated/nets.h"
#include "pipeline/schemes/stam/eigen.h"
#include "pipeline/schemes/stam/programs.h"

#include <algorithm>

namespace tessemu {

namespace {

// The most points of a net in and out of a hull shader are those of valence 12.
constexpr int kMostInHullShader = (kMaxControlPoints - 8) / 2;
// A net has 2n + 8 rows of as many terms, and a vertex n nets; sums of so many floats are still
// within 2e-6 of the diagonal (docs/stam.md).
constexpr std::uint32_t kMostEdges = 512;

// What a valence's draws read.
struct Valence {
    int valence = 0, functions = 0;
    std::vector<double> inverse;                 // [function][point]
    std::vector<float> by_point;                 // the same, [point][function]
    std::vector<float> splines, powers;          // see StamTables
    std::vector<std::uint32_t> nets;             // [patch][point], where a dispatch projects them
    std::vector<std::uint32_t> faces, rotations; // by patch
    std::vector<std::uint32_t> owners;           // see StamSharedInside

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

class StamPatches final : public IsolatedNets {
public:
    StamPatches(std::shared_ptr<RefinedMesh const> refined, Parameters const& parameters,
                ThreadPool const* threads)
        : IsolatedNets(std::move(refined),
                       {"Stam quad", "exact", int(kMostEdges),
                        "the paper says nothing of boundaries in its tessellation stage",
                        "Stam's evaluation is for vertices of 3 edges and more"},
                       parameters)
    {
        for (int n : valences()) valences_.emplace_back(n);
        make_nets(threads);
        if (has_shared_edges())
            find_owners();
        else
            say_wide(); // the form says it of its rows
    }

private:
    Valence const& valence(std::size_t kind) const { return valences_[kind - kFirstNet]; }
    /// Whether a dispatch projects a kind's nets.
    bool is_dispatched(std::size_t kind) const
    {
        return has_shared_edges() || valence_of(kind) > kMostInHullShader;
    }
    bool takes_corners_alone(std::size_t kind) const override { return is_dispatched(kind); }

    void net_added(std::size_t kind, std::uint32_t face, Neighbourhood const& n) override
    {
        if (!is_dispatched(kind)) return;
        Valence& v = valences_[kind - kFirstNet];
        Neighbourhood whole;
        Neighbourhood const* net = &n;
        if (!has_shared_edges()) { // whose inputs are the corners alone
            find_neighbourhood(mesh().topology(), face, whole);
            turn_to(whole, n.rotation);
            net = &whole;
        }
        for (int i : net_of(*net)) v.nets.push_back(net->inputs[std::size_t(i)]);
        v.faces.push_back(face);
        v.rotations.push_back(std::uint32_t(n.rotation));
        v.owners.push_back(StamSharedInside::kNoOwner);
    }
    /// Where edge 3 of a patch is edge 0 of another one that is drawn.
    void find_owners()
    {
        Topology const& topology = mesh().topology();
        std::vector<std::uint32_t> patch_of(topology.mesh().faces(), StamSharedInside::kNoOwner);
        for (Valence const& v : valences_)
            for (std::size_t p = 0; p < v.faces.size(); ++p)
                patch_of[v.faces[p]] = std::uint32_t(p);
        for (Valence& v : valences_)
            for (std::size_t p = 0; p < v.faces.size(); ++p) {
                HalfEdge const edge3 =
                    topology.mesh().face_start[v.faces[p]] + (v.rotations[p] + 3) % 4;
                v.owners[p] = patch_of[topology.face_of(topology.twin(edge3))];
            }
    }
    void say_wide()
    {
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

    PatchStencils net_stencils(std::size_t kind, Neighbourhood const& patch) const override
    {
        if (has_shared_edges()) return rim_stencils(patch, {});
        PatchStencils out;
        out.inputs = int(patch.inputs.size());
        if (is_dispatched(kind)) return out; // no row
        Valence const& v = valence(kind);
        out.control_points = v.functions;
        out.dense = true;
        for (int f = 0; f < v.functions; ++f)
            out.rows.emplace_back(v.inverse.begin() + f * v.functions,
                                  v.inverse.begin() + (f + 1) * v.functions);
        return out;
    }
    HullShader net_hull_shader(std::size_t kind, RowBuffers const& buffers,
                               SurfaceSettings const& s) const override
    {
        if (has_shared_edges())
            return stencil_hull_shader<StencilQuadHullShader, 4>(
                buffers, StamSharedDomainShader::kControlPoints, s);
        if (is_dispatched(kind))
            return bind_hull_shader(NetHullShader<CornersAlone>{s.factor_rule()}, s.machine);
        return summed_hull_shader<DenseNetHullShader<SummedRows<4>>>(
            std::get<StencilBuffers>(buffers), valence(kind).functions, s);
    }
    DomainShader net_domain_shader(std::size_t kind, SurfaceSettings const& s) const override
    {
        return bind_surface(StamPointsDomainShader{{valence(kind).tables()}}, s);
    }
    bool reads_positions() const override { return true; } // of nets that are projected
    DomainShader prepared_domain_shader(CommandList& list, VertexSource const& positions,
                                        std::size_t kind, SurfaceSettings const& s) const override
    {
        if (kind < kFirstNet || !is_dispatched(kind))
            return IsolatedNets::prepared_domain_shader(list, positions, kind, s);
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
        if (!has_shared_edges()) return bind_surface(StamBufferDomainShader{inside}, s);
        return bind_surface(
            StamSharedDomainShader{s.true_normals, {{}, inside, {v.owners, 3, "spoke_owners"}}}, s);
    }

    std::vector<Valence> valences_; // by kind
};

class Stam final : public Scheme {
public:
    SchemeInfo info() const override
    {
        SchemeInfo info{"stam",
                        "LOOP10",
                        "4.1, 4.2 (Stam 1998)",
                        "exact Catmull-Clark surface: eigen functions at extraordinary vertices, "
                        "regular quads as bicubics",
                        IsolatedNets::requirements(),
                        IsolatedNets::parameters(),
                        IsolatedNets::watertight_with()};
        info.takes.edges = kMostEdges;
        info.no_curvature = {};
        return info;
    }
    std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const> mesh,
                                     Parameters const& parameters,
                                     BuildServices const& services) const override
    {
        return std::make_unique<StamPatches>(std::move(mesh), parameters, services.threads);
    }
};

} // namespace

std::unique_ptr<Scheme> make_stam()
{
    return std::make_unique<Stam>();
}

} // namespace tessemu
