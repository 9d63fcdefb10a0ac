// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/bolz/table_patches.h"

#include "pipeline/mesh/sharpness.h"

#include <algorithm>
#include <numeric>

namespace tessemu {

namespace {

// Control points that a sum takes for a patch.
int summed(int points, TableOrder order)
{
    if (order == TableOrder::Table) return points;
    constexpr int kAtOnce = OrderedSums::kAtOnce;
    return (points + kAtOnce - 1) / kAtOnce * kAtOnce;
}

static_assert(TableLayout::kSide == kTableSide);

// Tables side by side, so many to a texel.
std::vector<float> texture_of(std::vector<float> const& tables, int points,
                              TableLayout const& layout, int channels)
{
    std::vector<float> out(std::size_t(layout.width()) * std::size_t(layout.height()) *
                           std::size_t(channels));
    for (int p = 0; p < points; ++p) {
        int const x = layout.x(p / channels), y = layout.y(p / channels);
        float const* const table = tables.data() + std::size_t(p) * kTableSamples;
        for (int j = 0; j < kTableSide; ++j)
            for (int i = 0; i < kTableSide; ++i) {
                std::size_t const texel =
                    std::size_t(y + j) * std::size_t(layout.width()) + std::size_t(x + i);
                out[texel * std::size_t(channels) + std::size_t(p % channels)] =
                    table[j * kTableSide + i];
            }
    }
    return out;
}

PatchKind kind_of(PatchFamily family)
{
    constexpr PatchClass kClasses[] = {PatchClass::RegularQuad,   PatchClass::IrregularQuad,
                                       PatchClass::Crease,        PatchClass::ConvexCorner,
                                       PatchClass::ConcaveCorner, PatchClass::Dart,
                                       PatchClass::SemiSharp};
    static_assert(std::size(kClasses) == kPatchFamilies);
    return {in_words(family), kClasses[std::size_t(family)]};
}

// When all finite sharpness is gone.
bool stays_a_corner(Sharpness const& sharpness, std::uint32_t vertex)
{
    RingSharpness ring;
    sharpness.around(vertex, ring);
    auto const is_infinite = [](float s) { return s >= kInfinitelySharp; };
    return is_infinite(ring.vertex) ||
           std::count_if(ring.edge.begin(), ring.edge.end(), is_infinite) > 2;
}

} // namespace

TablePatches::TablePatches(RefinedMesh const& mesh, MeshBasis const& basis, TableOrder order,
                           std::vector<char> const& hidden)
{
    add_textures(basis, order);
    add_patches(mesh, basis, order, hidden);
    add_corners(mesh, basis, hidden);
}

void TablePatches::add_textures(MeshBasis const& basis, TableOrder order)
{
    int const channels =
        order == TableOrder::Global ? OrderedSums::kChannels : PackedSums::kChannels;
    for (PatchTypeTables const& t : basis.types()) {
        TypeTextures& out = textures.emplace_back();
        out.layout = TableLayout::of((t.points + channels - 1) / channels);
        out.position = texture_of(t.position, t.points, out.layout, channels);
        out.du = texture_of(t.du, t.points, out.layout, channels);
        out.dv = texture_of(t.dv, t.points, out.layout, channels);
    }
}

void TablePatches::add_patches(RefinedMesh const& mesh, MeshBasis const& basis, TableOrder order,
                               std::vector<char> const& hidden)
{
    Topology const& topology = mesh.topology();
    auto const all = basis.patches();
    // Kinds in the order of the families, patches of a kind in the order of the faces.
    std::vector<std::uint32_t> drawn;
    for (std::uint32_t p = 0; p < all.size(); ++p)
        if (!hidden[all[p].face]) drawn.push_back(p);
    auto const family = [&](std::uint32_t p) { return basis.types()[all[p].type].type.family(); };
    std::stable_sort(drawn.begin(), drawn.end(),
                     [&](auto a, auto b) { return family(a) < family(b); });
    std::vector<std::uint32_t> of_face(mesh.mesh().faces(), kNone);
    for (std::uint32_t i = 0; i < drawn.size(); ++i) of_face[all[drawn[i]].face] = i;

    Sharpness const sharpness(topology);
    std::vector<std::uint32_t> order_of;
    for (std::uint32_t i = 0; i < drawn.size(); ++i) {
        BasisPatch const& p = all[drawn[i]];
        PatchFamily const f = family(drawn[i]);
        if (i == 0 || f != family(drawn[i - 1])) kinds.push_back({kind_of(f), i, 0});
        ++kinds.back().count;
        Patch out{p.face, std::uint32_t(p.rotation), p.type, p.corner, 0, 0, {}, kNone, {}, {}};
        auto const half_edge = [&](int k) {
            return mesh.mesh().face_start[p.face] + std::uint32_t(p.rotation + k) % 4;
        };
        for (int k = 0; k < 4; ++k) {
            HalfEdge const twin = topology.twin(half_edge(k));
            out.neighbours[std::size_t(k)] =
                twin == Topology::kNone ? kNone : of_face[topology.face_of(twin)];
        }
        for (std::size_t e = 0; e < 2; ++e) {
            int const k = e == 0 ? 0 : 3;
            bool const sharp = sharpness.edge(half_edge(k)) >= kInfinitelySharp;
            out.across[e] = sharp ? out.neighbours[std::size_t(k)] : kNone;
            has_creases = has_creases || out.across[e] != kNone;
        }
        // Its control points, in the order of the sums.
        int const points = basis.types()[p.type].points;
        TableLayout const layout = textures[p.type].layout;
        order_of.resize(std::size_t(points));
        std::iota(order_of.begin(), order_of.end(), 0u);
        auto const vertex = [&](std::uint32_t k) { return basis.points()[p.first_point + k]; };
        if (order == TableOrder::Global)
            std::stable_sort(order_of.begin(), order_of.end(),
                             [&](auto a, auto b) { return vertex(a) < vertex(b); });
        out.first = std::uint32_t(vertices.size());
        out.count = std::uint32_t(summed(points, order));
        for (std::uint32_t k : order_of) {
            vertices.push_back(vertex(k));
            if (order == TableOrder::Global) {
                offsets.push_back(float(layout.x(int(k))));
                offsets.push_back(float(layout.y(int(k))));
            }
        }
        vertices.resize(out.first + out.count, PatchConstantsShader::kNone);
        if (order == TableOrder::Global) offsets.resize(2 * vertices.size());
        patches.push_back(out);
    }
}

void TablePatches::add_corners(RefinedMesh const& mesh, MeshBasis const& basis,
                               std::vector<char> const& hidden)
{
    using Faces = CornerNormalShader::Faces;
    Topology const& topology = mesh.topology();
    ControlMesh const& control = mesh.mesh();
    Sharpness const sharpness(topology);
    poles = find_poles(topology);
    has_poles = !poles.empty();
    if (!has_poles) {
        poles.of_vertex.assign(control.positions.size(), Poles::kNone);
        poles.first.assign(1, 0);
    }
    // The faces that meet at each corner, and the corners of each vertex.
    std::vector<std::vector<std::uint32_t>> faces(basis.corners());
    std::vector<std::vector<std::uint32_t>> corners_of(control.positions.size());
    auto const vertex_of = [&](BasisPatch const& p) {
        return control.face(p.face)[std::size_t(p.rotation)];
    };
    for (BasisPatch const& p : basis.patches()) {
        faces[p.corner].push_back(p.face);
        if (hidden[p.face]) continue; // it moves nothing
        auto& here = corners_of[vertex_of(p)];
        if (std::find(here.begin(), here.end(), p.corner) == here.end()) here.push_back(p.corner);
    }
    for (std::uint32_t c = 0; c < basis.corners(); ++c) {
        BasisPatch const& owner = basis.patches()[basis.corner_owner()[c]];
        PatchTypeTables const& tables = basis.types()[owner.type];
        std::uint32_t const vertex = vertex_of(owner);
        PatchFamily const family = tables.type.family();
        Faces use = Faces::None;
        std::uint32_t which = 0;
        if (poles.at(vertex) != Poles::kNone && sharpness.is_untagged(vertex)) {
            use = Faces::Normal;
            which = poles.at(vertex);
        } else if (family != PatchFamily::Regular && family != PatchFamily::Smooth) {
            // By the plain rules a corner's tangents are those of its two edges, however far its
            // faces turn.
            bool const may_turn = control.rules.sectors == SectorRules::OpenSubdiv &&
                                  faces[c].size() > 1 && stays_a_corner(sharpness, vertex);
            use = may_turn ? Faces::Outside : Faces::Fallback;
            which = std::uint32_t(poles.size());
            for (std::uint32_t f : faces[c]) {
                auto const quad = control.face(f);
                poles.faces.push_back({quad[0], quad[1], quad[2], quad[3]});
            }
            poles.first.push_back(std::uint32_t(poles.faces.size()));
        }
        corners.insert(corners.end(),
                       {std::uint32_t(corner_vertices.size()), std::uint32_t(use), which});
        for (int k = 0; k < tables.points; ++k) {
            std::size_t const sample = std::size_t(k) * kTableSamples; // (0, 0)
            float const a = tables.du[sample], b = tables.dv[sample];
            if (a == 0 && b == 0) continue;
            corner_vertices.push_back(basis.points()[owner.first_point + std::uint32_t(k)]);
            corner_weights.insert(corner_weights.end(), {a, b});
        }
    }
    corners.insert(corners.end(), {std::uint32_t(corner_vertices.size()), 0, 0});

    std::vector<std::uint32_t> shared(control.positions.size(), kNone);
    for (std::uint32_t v = 0; v < corners_of.size(); ++v) {
        if (corners_of[v].size() < 2) continue;
        shared[v] = std::uint32_t(shared_first.size() - 1);
        std::sort(corners_of[v].begin(), corners_of[v].end());
        shared_corners.insert(shared_corners.end(), corners_of[v].begin(), corners_of[v].end());
        shared_first.push_back(std::uint32_t(shared_corners.size()));
    }
    has_creases = has_creases || !shared_corners.empty();
    for (Patch& p : patches) {
        auto const quad = control.face(p.face);
        for (std::uint32_t k = 0; k < 4; ++k)
            p.poles[k] = has_poles && sharpness.is_untagged(quad[(p.rotation + k) % 4])
                             ? poles.at(quad[(p.rotation + k) % 4])
                             : kNone;
        p.shared = shared[quad[p.rotation]];
    }
}

} // namespace tessemu
