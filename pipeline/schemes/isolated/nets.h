// Patches after the steps of subdivision that leave every face one extraordinary vertex at most,
// LOOP10 section 4. A scheme derives from this and says what the patches at those vertices are; all
// others are alike: regular faces are bicubics (4.1), and faces that the scheme's paper has no patch
// for, as at a boundary, are those of gregory-stencil, with a warning.
//
// Edges are drawn in one of two ways. edges=paper evaluates each patch alone, from inputs in the
// order of its net; edges=shared makes all patches those of the stencil form, which give shared
// points equal bits.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/forms/stencil_form.h"
#include "pipeline/schemes/gregory/stencils.h"
#include "pipeline/schemes/scheme.h"

namespace tessemu {

class IsolatedNets : public StencilForm {
public:
    bool has_shared_edges() const final { return shared_edges_; }

    /// What schemes of this kind ask of a mesh, and their parameters "edges" and "regular".
    static MeshRequirements requirements();
    static std::vector<SchemeParameter> parameters();
    static std::vector<std::pair<std::string, std::string>> watertight_with();

protected:
    /// Patches at extraordinary vertices.
    struct Net {
        std::string name;     ///< "Stam quad"
        std::string promise;  ///< what Gregory patches do not keep: "exact"
        int max_valence;      ///< from 3 on
        std::string boundary; ///< why not at a boundary
        std::string valence;  ///< why no other valences
    };
    IsolatedNets(std::shared_ptr<RefinedMesh const> mesh, Net net, Parameters const& parameters);
    /// Makes the tables and says what is drawn in another way: called by the scheme's constructor,
    /// as make_tables() is.
    void make_nets(ThreadPool const* threads);

    /// Valences of extraordinary vertices with nets, ascending: kinds from kFirstNet on.
    std::vector<int> const& valences() const { return valences_; }
    int valence_of(std::size_t kind) const { return valences_[kind - kFirstNet]; }
    static constexpr std::size_t kFirstNet = 2;

    // What a scheme says of a kind from kFirstNet on. Corner 0 of its patches is the extraordinary
    // vertex.

    /// Whether the inputs are the four corners alone (edges=paper): something else reads the net.
    virtual bool takes_corners_alone(std::size_t /*kind*/) const { return false; }
    /// edges=paper: inputs are the net, in the order of net_of(), or the corners. edges=shared: all
    /// vertices of the faces around; see rim_stencils().
    virtual PatchStencils net_stencils(std::size_t kind, Neighbourhood const& patch) const = 0;
    virtual HullShader net_hull_shader(std::size_t kind, RowBuffers const& buffers,
                                       SurfaceSettings const& settings) const = 0;
    virtual DomainShader net_domain_shader(std::size_t kind,
                                           SurfaceSettings const& settings) const = 0;
    virtual void net_added(std::size_t /*kind*/, std::uint32_t /*face*/, Neighbourhood const&) {}

    /// Local numbers of a net's points: EV; e_i and f_i in turn, counter-clockwise; (2,2) (2,1)
    /// (2,0) (2,-1) (1,2) (0,2) (-1,2): see eigen.h. Of valence 4 (-1,-1) is f_2.
    static std::vector<int> net_of(Neighbourhood const& patch);
    /// Turns a neighbourhood so that its corner 0 is corner `rotation` of the face.
    static void turn_to(Neighbourhood& patch, int rotation);
    /// edges=shared: p, e+ and e-, of which edges are made, and `points` behind them.
    PatchStencils rim_stencils(Neighbourhood const& patch,
                               std::vector<StencilRow> const& points) const;

private:
    IsolatedNets(std::shared_ptr<RefinedMesh const> mesh, Net net, Parameters const& parameters,
                 std::vector<int> valences);

    enum Kind : std::size_t { kRegularQuad, kGregoryQuad };

    /// Faces that take gregory-stencil's patches.
    struct Gregory {
        std::size_t count = 0;
        std::uint32_t first = 0xffffffffu; ///< by its number in the file
    };

    std::size_t kind_of(std::uint32_t face) const final;
    void arrange(std::uint32_t face, Neighbourhood& patch) const final;
    void added(std::size_t kind, std::uint32_t face, Neighbourhood const& patch) final;
    PatchStencils stencils(std::size_t kind, Neighbourhood const& patch) const final;
    HullShader hull_shader(std::size_t kind, RowBuffers const& buffers,
                           SurfaceSettings const& settings) const final;
    DomainShader domain_shader(std::size_t kind, SurfaceSettings const& settings) const final;
    void say_gregory(Gregory const& faces, std::string const& where, std::string const& why);

    Net net_;
    bool shared_edges_, bspline_;
    GregoryParameters gregory_;
    std::vector<int> valences_;
    Gregory at_boundary_, at_two_edges_, at_many_edges_;
};

} // namespace tessemu
