// Sharpness of edges and vertices, and the rules that follow from it: OpenSubdiv's semi-sharp
// creases (docs/math/subdivision.md, 1.7), and the sectors of Biermann's rules (5.2).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/topology.h"

#include <array>
#include <optional>

namespace tessemu {

/// What a vertex follows in a step of subdivision. Smooth and Dart have the same masks, but not the
/// same limit.
enum class VertexRule {
    Smooth, ///< nothing sharp meets here
    Dart,   ///< one sharp edge ends here
    Crease, ///< two sharp edges: the curve along them
    Corner, ///< sharp itself, or three sharp edges and more: it stays where it is
};

/// The sharpness that is left after a step: one less, and at least 0; infinite stays.
float decremented(float sharpness);

/// What is sharp at one end of an edge, for Chaikin's rule: sharpnesses above 0 that are finite.
struct SharpEnd {
    float sum = 0;
    int count = 0;

    void add(float sharpness);
    /// Of an edge of `sharpness` that ends here, the sharpness of the half at this end after a
    /// step by Chaikin's rule: 3/4 of it and 1/4 of the mean of the others, decremented.
    float decremented_here(float sharpness) const;
};

/// Of a smooth edge by Biermann's rules: the end to which its point leans, which is the only one
/// of the two where something is sharp.
struct Lean {
    int end = -1;         ///< 0 or 1; -1: neither
    double cos_theta = 0; ///< of the angle of a face at that end
};

/// Faces at a vertex between two sharp edges, or all of them where fewer edges are sharp.
struct RingSector {
    std::size_t first, faces; ///< from edge `first` on, cyclic
    bool closed;              ///< all faces; `first` is the sharp edge, if there is one
    bool concave;
    int turn, of; ///< by Biermann's rules a face has the angle theta = pi turn / of

    double cos_theta() const;
};

/// The edges around a vertex, in the order of Topology::ring.
struct RingSharpness {
    bool open = false;       ///< on the boundary: edge[0] and edge.back() are infinitely sharp
    float vertex = 0;        ///< the vertex's own
    std::vector<float> edge; ///< as many as faces, and one more where it is open
    // For Chaikin's rule; empty with the other.
    SharpEnd here;
    std::vector<SharpEnd> far_end; ///< of each edge, with it
    // For Biermann's rules.
    bool biermann = false;
    std::optional<double> flatness;   ///< SubdivisionRules'
    std::vector<std::size_t> concave; ///< first edges of concave sectors
    /// By edge: theta's cosine at the far end, where something is sharp there; empty: nowhere is.
    std::vector<std::optional<double>> far_cos_theta;

    std::size_t faces() const { return edge.size() - (open ? 1 : 0); }
    VertexRule rule() const;
    /// In the order of their first edges.
    std::vector<RingSector> sectors() const;
    /// By edge, end 0 the vertex; empty with OpenSubdiv's rules.
    std::vector<Lean> leans() const;
    /// A finite sharpness is left: the surface is smoother here than the rule says.
    bool is_semi_sharp() const;
    /// The first sharp edge and the last: a crease's two.
    std::array<std::size_t, 2> crease() const;
    /// What is left after a step, on the halves of the edges that lie at the vertex.
    RingSharpness after_step() const;
    /// Of the halves of an edge after a step: at the vertex, and at the far end.
    std::array<float, 2> halves(std::size_t j) const;
};

/// How much of the rule of `now` a vertex's new point has where that of `after` is another: the
/// mean of the sharpnesses that end in this step, at most 1.
double fractional_weight(RingSharpness const& now, RingSharpness const& after);

/// How much of the midpoint an edge's new point has, of `sharpness` above 0 and with such halves
/// after the step; the rest is the smooth edge point. With Chaikin's rule more than all, up to 4/3,
/// where a half ends that was sharper than 1: OpenSubdiv's refinement does so.
double crease_weight(float sharpness, std::array<float, 2> halves);

/// A mesh's tags by edge and vertex. Boundary edges are infinitely sharp, and so is a vertex with
/// one face unless the boundary rule smooths it.
class Sharpness {
public:
    /// \param topology  outlives this. \cost  linear in the tags and, where there are some, in the
    ///                  corners of faces
    /// \param is_cut    by vertex, of a mesh that is a piece of another: some of its faces are
    ///                  not in the piece, so that the boundary there is none, and what is sharp there is
    ///                  not known. Empty: no vertex. Outlives this.
    explicit Sharpness(Topology const& topology, std::span<char const> is_cut = {});

    float edge(HalfEdge h) const
    {
        return topology_->twin(h) == Topology::kNone ? kInfinitelySharp
               : edge_.empty()                       ? 0
                                                     : edge_[h];
    }
    float vertex(std::uint32_t v) const;
    /// Inside the mesh, and no tag on it or on an edge at it.
    bool is_plain(std::uint32_t v) const
    {
        return !topology_->is_boundary(v) && (tagged_.empty() || !tagged_[v]);
    }
    /// No tag on it or on an edge at it, but for the boundary.
    bool is_untagged(std::uint32_t v) const { return tagged_.empty() || !tagged_[v]; }
    bool is_cut(std::uint32_t v) const { return !is_cut_.empty() && is_cut_[v]; }
    /// \param out  reused from call to call
    void around(std::uint32_t v, RingSharpness& out) const;
    /// Of the halves of an edge after a step: at the half-edge's vertex, and at the next.
    std::array<float, 2> halves(HalfEdge h) const;
    /// End 0 is the half-edge's vertex.
    Lean lean(HalfEdge h) const;

private:
    void add_tags();
    void around_itself(std::uint32_t v, RingSharpness& out) const;

    Topology const* topology_;
    std::span<char const> is_cut_;
    std::vector<float> edge_;   ///< by half-edge; empty: no creases
    std::vector<float> vertex_; ///< empty: no corners
    std::vector<char> tagged_;  ///< by vertex; empty: no tags
    std::vector<SharpEnd> end_; ///< by vertex; empty: Chaikin's rule is not needed
    // Empty: OpenSubdiv's rules.
    std::vector<char> is_sharp_;    ///< by vertex: it, or an edge at it
    std::vector<double> cos_theta_; ///< by half-edge, of its face at its vertex if that is sharp
};

} // namespace tessemu
