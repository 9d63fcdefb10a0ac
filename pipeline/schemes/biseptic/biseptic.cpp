// biseptic: patches of degree 7 that meet with one curvature at an extraordinary vertex, LOOP10
// 4.3. The basis is derived, not the one that Loop and Schaefer published (basis.h).
//
// edges=paper evaluates each patch alone; edges=shared gives shared points equal bits
// (docs/biseptic.md).
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/biseptic/basis.h"
#include "pipeline/schemes/biseptic/programs.h"
#include "pipeline/schemes/isolated/nets.h"

#include <algorithm>

namespace tessemu {

namespace {

// Weights of a net's points as a row of a patch's inputs. Of an input that is two of its points
// both weights are added in ascending order, which no patch's numbers change.
StencilRow row_of(std::vector<std::pair<int, double>> terms, int inputs)
{
    std::sort(terms.begin(), terms.end());
    StencilRow row(std::size_t(inputs), 0);
    for (auto const& [input, weight] : terms) row[std::size_t(input)] += weight;
    return row;
}

class BisepticPatches final : public IsolatedNets {
public:
    BisepticPatches(std::shared_ptr<RefinedMesh const> mesh, Parameters const& parameters,
                    ThreadPool const* threads)
        : IsolatedNets(std::move(mesh),
                       {"biseptic quad", "of one curvature at the vertex", kMaxBisepticValence,
                        "the derived basis is of vertices inside",
                        "the derived basis is for vertices of " +
                            std::to_string(kMinBisepticValence) + " to " +
                            std::to_string(kMaxBisepticValence) + " edges"},
                       parameters)
    {
        for (int n : valences()) bases_.emplace_back(n);
        make_nets(threads);
    }

private:
    PatchStencils net_stencils(std::size_t kind, Neighbourhood const& patch) const override
    {
        BisepticBasis const& basis = bases_[kind - kFirstNet];
        auto const inputs = int(patch.inputs.size());
        // Weights of some points of the net, by the input that each is.
        auto const row = [&](std::vector<int> const& at, auto const& weight) {
            std::vector<std::pair<int, double>> terms;
            for (std::size_t k = 0; k < at.size(); ++k) terms.emplace_back(at[k], weight(k));
            return row_of(std::move(terms), inputs);
        };
        std::vector<int> net(std::size_t(basis.points()), 0); // edges=paper: in their order
        for (std::size_t p = 0; p < net.size(); ++p) net[p] = int(p);
        if (has_shared_edges()) net = net_of(patch);
        std::vector<StencilRow> points;
        for (int i = 0; i < kBisepticSide; ++i)
            for (int j = 0; j < kBisepticSide; ++j)
                points.push_back(row(net, [&](std::size_t p) { return basis.weights(i, j)[p]; }));
        if (!has_shared_edges()) {
            PatchStencils out;
            out.inputs = inputs;
            out.control_points = int(points.size());
            out.dense = true;
            out.rows = std::move(points);
            return out;
        }
        // The other patch at edge 3 has it as edge 0.
        std::vector<int> const spoke = basis.spoke();
        for (std::vector<int> at : {spoke, basis.next_spoke()}) {
            for (int& p : at) p = net[std::size_t(p)];
            for (int i = 0; i < kBisepticSide; ++i)
                points.push_back(row(at, [&](std::size_t k) {
                    auto const p = std::size_t(spoke[k]);
                    return basis.weights(i, 1)[p] - basis.weights(i, 0)[p];
                }));
        }
        points.emplace_back(std::size_t(inputs), 0.0); // nothing: it fills the last record
        PatchStencils out = rim_stencils(patch, points);
        // At EV the surface's own tangents, along ring edges s and s + 1.
        int const n = basis.valence();
        std::vector<int> ring = net;
        ring.resize(std::size_t(2 * n + 1));
        auto const tangent = [&](int s) {
            return row(ring, [&](std::size_t p) {
                std::size_t const q =
                    p == 0 ? 0 : 1 + (p - 1 + std::size_t(2 * (n - s))) % std::size_t(2 * n);
                return basis.weights(1, 0)[q] - basis.weights(0, 0)[q];
            });
        };
        for (int s = 0; s < n; ++s) {
            auto const first = std::size_t(out.corner_row[0] + 2 * s);
            out.rows[first] = tangent(s);
            out.rows[first + 1] = tangent((s + 1) % n);
        }
        return out;
    }
    HullShader net_hull_shader(std::size_t, RowBuffers const& buffers,
                               SurfaceSettings const& s) const override
    {
        StencilBuffers const& rows = std::get<StencilBuffers>(buffers); // of 32 inputs at most
        if (has_shared_edges())
            return summed_hull_shader<BisepticRowsHullShader>(rows, BisepticRowsInside::kRows, s);
        return summed_hull_shader<BisepticHullShader>(rows, BisepticInside::kPoints, s);
    }
    DomainShader net_domain_shader(std::size_t, SurfaceSettings const& s) const override
    {
        if (has_shared_edges()) return surface_shader<BisepticRowsDomainShader>(s);
        return bind_surface(BisepticDomainShader{}, s);
    }

    std::vector<BisepticBasis> bases_; // by kind
};

class Biseptic final : public Scheme {
public:
    SchemeInfo info() const override
    {
        SchemeInfo info{"biseptic",
                        "LOOP10",
                        "4.1, 4.3 (after Loop and Schaefer 2008)",
                        "one curvature at extraordinary vertices: patches of degree 7 there, of a "
                        "derived basis; regular quads as bicubics",
                        IsolatedNets::requirements(),
                        IsolatedNets::parameters(),
                        IsolatedNets::watertight_with()};
        info.takes.edges = StencilForm::kMostEdges;
        info.no_curvature = {};
        return info;
    }
    std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const> mesh,
                                     Parameters const& parameters,
                                     BuildServices const& services) const override
    {
        return std::make_unique<BisepticPatches>(std::move(mesh), parameters, services.threads);
    }
};

} // namespace

std::unique_ptr<Scheme> make_biseptic()
{
    return std::make_unique<Biseptic>();
}

} // namespace tessemu
