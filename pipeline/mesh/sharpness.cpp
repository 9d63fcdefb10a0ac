// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/sharpness.h"

#include <algorithm>

namespace tessemu {

namespace {

bool is_finite(float sharpness)
{
    return sharpness > 0 && sharpness < kInfinitelySharp;
}

} // namespace

float decremented(float sharpness)
{
    return sharpness >= kInfinitelySharp ? sharpness : std::max(0.0f, sharpness - 1);
}

void SharpEnd::add(float sharpness)
{
    if (is_finite(sharpness)) sum += sharpness, ++count;
}

float SharpEnd::decremented_here(float sharpness) const
{
    if (count < 2 || !is_finite(sharpness)) return decremented(sharpness);
    float const others = (sum - sharpness) / float(count - 1);
    return std::max(0.0f, 0.75f * sharpness + 0.25f * others - 1);
}

VertexRule RingSharpness::rule() const
{
    if (vertex > 0) return VertexRule::Corner;
    auto const sharp = std::count_if(edge.begin(), edge.end(), [](float s) { return s > 0; });
    constexpr VertexRule kRules[] = {VertexRule::Smooth, VertexRule::Dart, VertexRule::Crease};
    return sharp > 2 ? VertexRule::Corner : kRules[sharp];
}

bool RingSharpness::is_semi_sharp() const
{
    return is_finite(vertex) || std::any_of(edge.begin(), edge.end(), is_finite);
}

std::array<std::size_t, 2> RingSharpness::crease() const
{
    auto const is_sharp = [](float s) { return s > 0; };
    auto const first = std::find_if(edge.begin(), edge.end(), is_sharp);
    auto const last = std::find_if(edge.rbegin(), edge.rend(), is_sharp);
    return {std::size_t(first - edge.begin()), std::size_t(edge.rend() - last) - 1};
}

std::array<float, 2> RingSharpness::halves(std::size_t j) const
{
    if (far_end.empty()) return {decremented(edge[j]), decremented(edge[j])};
    return {here.decremented_here(edge[j]), far_end[j].decremented_here(edge[j])};
}

RingSharpness RingSharpness::after_step() const
{
    RingSharpness out;
    out.open = open;
    out.vertex = decremented(vertex);
    for (std::size_t j = 0; j < edge.size(); ++j) {
        auto const [near, far] = halves(j);
        out.edge.push_back(near);
        if (far_end.empty()) continue;
        out.here.add(near);
        SharpEnd& end = out.far_end.emplace_back(); // the new edge point, in the middle of a crease
        end.add(near);
        end.add(far);
    }
    return out;
}

double fractional_weight(RingSharpness const& now, RingSharpness const& after)
{
    float sum = 0;
    int count = 0;
    auto const add = [&](float before, float left) {
        if (before > 0 && left <= 0) sum += before, ++count;
    };
    add(now.vertex, after.vertex);
    for (std::size_t j = 0; j < now.edge.size(); ++j) add(now.edge[j], after.edge[j]);
    return count ? std::min(1.0f, sum / float(count)) : 0.0f;
}

double crease_weight(float sharpness, std::array<float, 2> halves)
{
    return halves[0] > 0 && halves[1] > 0 ? 1 : sharpness;
}

Sharpness::Sharpness(Topology const& topology) : topology_(&topology)
{
    ControlMesh const& mesh = topology.mesh();
    if (mesh.creases.empty() && mesh.corners.empty()) return;
    tagged_.assign(mesh.positions.size(), 0);
    if (!mesh.creases.empty()) edge_.assign(mesh.face_vertices.size(), 0);
    for (ControlMesh::Crease const& c : mesh.creases) {
        HalfEdge const h = topology.find_edge(c.a, c.b);
        if (h == Topology::kNone || c.sharpness <= 0) continue;
        HalfEdge const other = topology.twin(h);
        if (other == Topology::kNone) continue; // as sharp as can be
        edge_[h] = edge_[other] = c.sharpness;
        tagged_[c.a] = tagged_[c.b] = 1;
    }
    if (mesh.rules.crease_method == CreaseMethod::Chaikin && !edge_.empty()) {
        end_.resize(mesh.positions.size());
        for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
            for (HalfEdge h : topology.ring(v)) end_[v].add(edge(h)); // a boundary adds nothing
    }
    if (!mesh.corners.empty()) vertex_.assign(mesh.positions.size(), 0);
    for (ControlMesh::Corner const& c : mesh.corners) {
        vertex_[c.vertex] = c.sharpness;
        if (c.sharpness > 0) tagged_[c.vertex] = 1;
    }
}

float Sharpness::vertex(std::uint32_t v) const
{
    if (topology_->is_boundary(v) && topology_->ring(v).size() == 1 &&
        !topology_->mesh().smooth_corners())
        return kInfinitelySharp;
    return vertex_.empty() ? 0 : vertex_[v];
}

void Sharpness::around(std::uint32_t v, RingSharpness& out) const
{
    auto const ring = topology_->ring(v);
    out.open = topology_->is_boundary(v);
    out.vertex = vertex(v);
    out.edge.clear();
    for (HalfEdge h : ring) out.edge.push_back(edge(h));
    if (out.open) out.edge.push_back(kInfinitelySharp);
    out.here = {};
    out.far_end.clear();
    if (end_.empty()) return;
    out.here = end_[v];
    for (HalfEdge h : ring) out.far_end.push_back(end_[topology_->vertex_of(topology_->next(h))]);
    if (out.open) out.far_end.emplace_back();
}

std::array<float, 2> Sharpness::halves(HalfEdge h) const
{
    float const s = edge(h);
    if (end_.empty()) return {decremented(s), decremented(s)};
    auto const at = [&](std::uint32_t v) { return end_[v].decremented_here(s); };
    return {at(topology_->vertex_of(h)), at(topology_->vertex_of(topology_->next(h)))};
}

} // namespace tessemu
