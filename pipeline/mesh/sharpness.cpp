// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/sharpness.h"

#include "pipeline/mesh/limit_constants.h"

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

double RingSector::cos_theta() const
{
    return cos_pi(turn, of);
}

std::vector<RingSector> RingSharpness::sectors() const
{
    std::vector<std::size_t> cuts;
    for (std::size_t j = 0; j < edge.size(); ++j)
        if (edge[j] > 0) cuts.push_back(j);
    std::size_t const n = open ? edge.size() - 1 : edge.size();
    if (cuts.size() < 2) return {{cuts.empty() ? 0 : cuts[0], n, true, false, 2, int(n)}};
    if (!open) cuts.push_back(cuts[0] + n); // round to the first
    bool const is_corner = rule() == VertexRule::Corner;
    std::vector<RingSector> out;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        std::size_t const k = cuts[i + 1] - cuts[i];
        bool const is_concave = is_corner && k > 1 &&
                                std::find(concave.begin(), concave.end(), cuts[i]) != concave.end();
        out.push_back(
            {cuts[i], k, false, is_concave, is_concave ? 3 : 1, is_corner ? 2 * int(k) : int(k)});
    }
    return out;
}

std::vector<Lean> RingSharpness::leans() const
{
    if (!biermann) return {};
    std::vector<Lean> out(edge.size());
    auto const far = [&](std::size_t j) -> std::optional<double> {
        return far_cos_theta.empty() ? std::nullopt : far_cos_theta[j];
    };
    bool const is_smooth = rule() == VertexRule::Smooth;
    for (RingSector const& s : sectors())
        for (std::size_t k = 0; k < s.faces; ++k) {
            std::size_t const j = (s.first + k) % edge.size();
            if (edge[j] > 0) continue;
            if (is_smooth && far(j)) out[j] = {1, *far(j)};
            if (!is_smooth && !far(j)) out[j] = {0, s.cos_theta()};
        }
    return out;
}

RingSharpness RingSharpness::after_step() const
{
    RingSharpness out;
    out.open = open;
    out.vertex = decremented(vertex);
    out.biermann = biermann;
    out.flatness = flatness;
    out.concave = concave;
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

Sharpness::Sharpness(Topology const& topology, std::span<char const> is_cut)
    : topology_(&topology),
      is_cut_(is_cut)
{
    add_tags();
    ControlMesh const& mesh = topology.mesh();
    if (mesh.rules.sectors != SectorRules::Biermann) return;
    is_sharp_.assign(mesh.positions.size(), 0);
    cos_theta_.assign(mesh.face_vertices.size(), 0);
    RingSharpness around;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        auto const ring = topology.ring(v);
        if (ring.empty() || is_plain(v) || this->is_cut(v)) continue;
        around_itself(v, around);
        if (around.rule() == VertexRule::Smooth) continue;
        is_sharp_[v] = 1;
        for (RingSector const& s : around.sectors()) {
            double const cos_theta = s.cos_theta();
            for (std::size_t k = 0; k < s.faces; ++k)
                cos_theta_[ring[(s.first + k) % ring.size()]] = cos_theta;
        }
    }
}

void Sharpness::add_tags()
{
    Topology const& topology = *topology_;
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
    around_itself(v, out);
    if (is_sharp_.empty()) return;
    for (HalfEdge h : topology_->ring(v)) {
        HalfEdge const other = topology_->twin(h);
        bool const is_sharp = is_sharp_[topology_->vertex_of(topology_->next(h))];
        out.far_cos_theta.push_back(
            is_sharp && other != Topology::kNone ? std::optional(cos_theta_[other]) : std::nullopt);
    }
    if (out.open) out.far_cos_theta.emplace_back(); // of a sharp edge, which leans nowhere
}

Lean Sharpness::lean(HalfEdge h) const
{
    if (is_sharp_.empty() || edge(h) > 0) return {};
    bool const first = is_sharp_[topology_->vertex_of(h)],
               second = is_sharp_[topology_->vertex_of(topology_->next(h))];
    if (first == second) return {};
    return first ? Lean{0, cos_theta_[h]} : Lean{1, cos_theta_[topology_->twin(h)]};
}

void Sharpness::around_itself(std::uint32_t v, RingSharpness& out) const
{
    ControlMesh const& mesh = topology_->mesh();
    auto const ring = topology_->ring(v);
    out.open = topology_->is_boundary(v);
    out.vertex = vertex(v);
    out.edge.clear();
    for (HalfEdge h : ring) out.edge.push_back(edge(h));
    if (out.open) out.edge.push_back(kInfinitelySharp);
    out.biermann = mesh.rules.sectors == SectorRules::Biermann;
    out.flatness = mesh.rules.flatness;
    out.concave.clear();
    out.far_cos_theta.clear();
    if (out.biermann && !mesh.concave.empty())
        for (std::size_t j = 0; j < ring.size(); ++j)
            if (std::binary_search(mesh.concave.begin(), mesh.concave.end(), ring[j]))
                out.concave.push_back(j);
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
