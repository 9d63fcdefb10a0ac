// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/mesh_tables.h"

#include "pipeline/basis_tables/signed_sets.h"

#include <algorithm>
#include <map>
#include <set>

namespace tessemu {

namespace {

// Columns that weigh something.
std::vector<std::uint16_t> used_columns(LocalTables const& t)
{
    std::vector<std::uint16_t> out;
    auto const samples = std::ptrdiff_t(t.grid.samples());
    for (int k = 0; k < t.points; ++k) {
        auto const weighs = [&](std::vector<double> const& table) {
            return !table.empty() &&
                   std::any_of(table.begin() + k * samples, table.begin() + (k + 1) * samples,
                               [](double w) { return w != 0; });
        };
        if (weighs(t.position) || weighs(t.tangents[0]) || weighs(t.tangents[1]))
            out.push_back(std::uint16_t(k));
    }
    return out;
}

TypeOfTables rounded(LocalMesh const& type, LocalTables const& t,
                     std::vector<std::uint16_t> const& columns)
{
    TypeOfTables out{type, t.grid, int(columns.size()), {}, {}};
    auto const samples = std::size_t(t.grid.samples());
    auto const take = [&](std::vector<double> const& from, std::vector<float>& to) {
        if (from.empty()) return;
        for (std::uint16_t k : columns)
            for (std::size_t s = 0; s < samples; ++s) to.push_back(float(from[k * samples + s]));
    };
    take(t.position, out.position);
    for (int i : {0, 1}) take(t.tangents[i], out.tangents[i]);
    return out;
}

} // namespace

TableVertex make_table_vertex(Topology const& t, std::uint32_t v, std::size_t first,
                              std::size_t faces, bool is_open, std::vector<std::uint32_t>& rings)
{
    auto const ring = t.ring(v);
    TableVertex out{v, std::uint32_t(rings.size()), 0, is_open};
    auto const edge_end = [&](std::size_t j) {
        return j == ring.size() && t.is_boundary(v) ? t.vertex_of(t.previous(ring.back()))
                                                    : t.vertex_of(t.next(ring[j % ring.size()]));
    };
    out.ring = std::uint32_t(faces + (is_open ? 1 : 0));
    for (std::size_t j = 0; j < out.ring; ++j) rings.push_back(edge_end(first + j));
    return out;
}

MeshTables::MeshTables(Topology const& topology, Make const& make, Options options,
                       Progress const& progress)
{
    ControlMesh const& mesh = topology.mesh();
    LocalMeshFinder finder(topology, options.rings);
    std::map<LocalMesh, std::uint32_t> numbers;
    std::vector<std::uint32_t> type_of;
    std::vector<FoundLocalMesh> found;
    std::vector<LocalMesh const*> types;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        FoundLocalMesh p = finder.at(f);
        auto const [at, is_new] =
            numbers.try_emplace(std::move(p.type), std::uint32_t(types.size()));
        if (is_new) types.push_back(&at->first);
        type_of.push_back(at->second);
        found.push_back({{}, p.rotation, std::move(p.corners), std::move(p.points)});
    }
    std::vector<std::vector<std::uint16_t>> columns;
    for (std::size_t i = 0; i < types.size(); ++i) {
        LocalTables const tables = make(*types[i]);
        columns.push_back(used_columns(tables));
        types_.push_back(rounded(*types[i], tables, columns.back()));
        if (progress) progress(i + 1, types.size());
    }
    // Through which corners a patch sees each of its points.
    std::vector<std::vector<HalfEdge>> corners;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order; // vertex, column
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        FoundLocalMesh const& p = found[f];
        LocalMesh const& type = *types[type_of[f]];
        std::vector<std::vector<HalfEdge>> of_point(type.points);
        for (std::size_t c = 0; c < p.corners.size(); ++c)
            of_point[type.point_of[type.face_vertices[c]]].push_back(p.corners[c]);
        order.clear();
        for (std::uint32_t k = 0; k < columns[type_of[f]].size(); ++k)
            order.emplace_back(p.points[columns[type_of[f]][k]], k);
        std::sort(order.begin(), order.end());
        patches_.push_back({f, p.rotation, type_of[f], std::uint32_t(points_.size())});
        for (auto const& [vertex, column] : order) {
            points_.push_back({vertex, column}); // of the mesh as yet
            corners.push_back(std::move(of_point[columns[type_of[f]][column]]));
        }
    }
    if (options.enforced) enforce(topology);
    add_vertices(topology, finder, corners);
}

void MeshTables::add_vertices(Topology const& topology, LocalMeshFinder const& finder,
                              std::vector<std::vector<HalfEdge>> const& corners)
{
    ControlMesh const& mesh = topology.mesh();
    // By half-edge the sector of its vertex that its face is in, by the first edge.
    std::vector<HalfEdge> sector(mesh.face_vertices.size());
    auto const set_sectors = [&](std::uint32_t v) {
        auto const ring = topology.ring(v);
        std::vector<std::size_t> cuts;
        for (std::size_t j = 0; j < ring.size(); ++j)
            if (finder.is_cut(ring[j])) cuts.push_back(j);
        if (cuts.size() < 2 && !topology.is_boundary(v)) cuts.assign(1, 0);
        for (std::size_t i = 0; i < cuts.size(); ++i) {
            std::size_t const end =
                i + 1 < cuts.size() ? cuts[i + 1] : ring.size() + cuts[0]; // round
            for (std::size_t j = cuts[i]; j < end; ++j)
                sector[ring[j % ring.size()]] = ring[cuts[i]];
        }
    };
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) set_sectors(v);
    std::vector<std::uint32_t> count_of(mesh.face_vertices.size());
    for (HalfEdge h = 0; h < sector.size(); ++h) {
        if (sector[h] == h) count_of[h] = sector_count_++;
        has_sharp_edges_ =
            has_sharp_edges_ || (topology.twin(h) != Topology::kNone && finder.is_cut(h));
    }
    for (HalfEdge first : sector) sectors_.push_back(count_of[first]);
    // A patch that sees several sectors of a vertex makes them one.
    std::vector<char> is_whole(mesh.positions.size(), 0);
    for (std::size_t i = 0; i < points_.size(); ++i)
        for (HalfEdge h : corners[i])
            if (sector[h] != sector[corners[i][0]]) is_whole[points_[i].vertex] = 1;
    std::vector<std::uint32_t> number(mesh.face_vertices.size()); // by first half-edge of a sector
    auto const add = [&](std::uint32_t v, std::size_t first, std::size_t faces, bool is_open) {
        return make_table_vertex(topology, v, first, faces, is_open, rings_);
    };
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        auto const ring = topology.ring(v);
        std::vector<std::size_t> first;
        for (std::size_t j = 0; j < ring.size(); ++j)
            if (sector[ring[j]] == ring[j]) first.push_back(j);
        if (first.size() < 2 || is_whole[v]) {
            for (std::size_t j : first) number[ring[j]] = std::uint32_t(vertices_.size());
            if (ring.empty()) continue;
            vertices_.push_back(add(v, 0, ring.size(), topology.is_boundary(v)));
            whole_.push_back(vertices_.back());
            continue;
        }
        has_creases_ = true;
        TableVertex const whole = add(v, 0, ring.size(), topology.is_boundary(v));
        for (std::size_t i = 0; i < first.size(); ++i) {
            number[ring[first[i]]] = std::uint32_t(vertices_.size());
            std::size_t const end = i + 1 < first.size() ? first[i + 1] : ring.size() + first[0];
            vertices_.push_back(add(v, first[i], end - first[i], true));
            whole_.push_back(whole);
        }
    }
    for (std::size_t i = 0; i < points_.size(); ++i)
        points_[i].vertex = number[sector[corners[i][0]]];
}

void MeshTables::enforce(Topology const& topology)
{
    ControlMesh const& mesh = topology.mesh();
    // Entries on sides, by type, table, column, side and place on it.
    struct OfType {
        std::size_t first;
        std::size_t per_column;
    };
    std::vector<OfType> of_type;
    std::size_t size = 0;
    for (TypeOfTables const& t : types_) {
        std::size_t const per_column = std::size_t(t.grid.sides) * std::size_t(t.grid.segments + 1);
        of_type.push_back({size, per_column});
        size += 3 * std::size_t(t.points) * per_column;
    }
    auto const entry = [&](std::uint32_t type, int table, std::uint32_t column, int side, int t) {
        TypeOfTables const& of = types_[type];
        return of_type[type].first +
               (std::size_t(table) * std::size_t(of.points) + column) * of_type[type].per_column +
               std::size_t(side) * std::size_t(of.grid.segments + 1) + std::size_t(t);
    };
    SignedSets sets(size);
    int const tables = types_.empty() || types_[0].tangents[0].empty() ? 1 : 3; // with tangents
    // A corner is at the end of one side and the beginning of the next.
    for (std::uint32_t type = 0; type < types_.size(); ++type) {
        TypeOfTables const& of = types_[type];
        for (std::uint32_t k = 0; k < std::uint32_t(of.points); ++k)
            for (int side = 0; side < of.grid.sides; ++side)
                sets.join(entry(type, 0, k, side, of.grid.segments),
                          entry(type, 0, k, (side + 1) % of.grid.sides, 0));
    }
    Sharpness const sharpness(topology);
    std::set<std::vector<std::uint32_t>> joints; // types, sides, is_sharp, which point is which
    constexpr std::uint32_t kNone = 0xffffffffu;
    for (HalfEdge h = 0; h < mesh.face_vertices.size(); ++h) {
        HalfEdge const twin = topology.twin(h);
        if (twin == Topology::kNone || twin < h) continue;
        Patch const &a = patches_[topology.face_of(h)], &b = patches_[topology.face_of(twin)];
        auto const side_of = [&](Patch const& p, HalfEdge edge) {
            int const sides = int(mesh.face(p.face).size());
            return std::uint32_t((int(edge - mesh.face_start[p.face]) - p.rotation + sides) %
                                 sides);
        };
        std::vector<std::uint32_t> joint{a.type, b.type, side_of(a, h), side_of(b, twin),
                                         sharpness.edge(h) >= kInfinitelySharp};
        // Both lists ascend.
        auto const points_of = [&](Patch const& p) {
            return std::span(points_).subspan(p.first_point, std::size_t(types_[p.type].points));
        };
        auto const pa = points_of(a), pb = points_of(b);
        for (std::size_t i = 0, j = 0; i < pa.size() || j < pb.size();) {
            std::uint32_t const va = i < pa.size() ? pa[i].vertex : kNone,
                                vb = j < pb.size() ? pb[j].vertex : kNone;
            joint.push_back(va <= vb ? pa[i++].column : kNone);
            joint.push_back(vb <= va ? pb[j++].column : kNone);
        }
        joints.insert(std::move(joint));
    }
    for (auto const& joint : joints) {
        std::uint32_t const a = joint[0], b = joint[1];
        int const side_a = int(joint[2]), side_b = int(joint[3]), n = types_[a].grid.segments;
        bool const has_tangents = !joint[4];
        for (std::size_t i = 5; i < joint.size(); i += 2)
            for (int table = 0; table < (has_tangents ? tables : 1); ++table)
                // At the corners tangents are the patches' own.
                for (int t = table ? 1 : 0; t <= (table ? n - 1 : n); ++t) {
                    std::uint32_t const ca = joint[i], cb = joint[i + 1];
                    if (ca != kNone && cb != kNone)
                        sets.join(entry(a, table, ca, side_a, t),
                                  entry(b, table, cb, side_b, n - t), table > 0);
                    else if (ca != kNone)
                        sets.set_zero(entry(a, table, ca, side_a, t));
                    else
                        sets.set_zero(entry(b, table, cb, side_b, n - t));
                }
    }
    // The least of what a set has, BOLZ03's choice; of tangents, which may be opposite, that of the
    // first.
    struct Value {
        float value = 0;
        bool is_set = false;
    };
    std::vector<Value> values(size);
    auto const for_each = [&](auto const& work) {
        for (std::uint32_t type = 0; type < types_.size(); ++type) {
            TypeOfTables& of = types_[type];
            auto const samples = std::size_t(of.grid.samples());
            for (int table = 0; table < tables; ++table)
                for (std::uint32_t k = 0; k < std::uint32_t(of.points); ++k)
                    for (int side = 0; side < of.grid.sides; ++side)
                        for (int t = 0; t <= of.grid.segments; ++t)
                            work(entry(type, table, k, side, t),
                                 (table ? of.tangents[table - 1]
                                        : of.position)[k * samples +
                                                       std::size_t(of.grid.on_side(side, t))],
                                 table == 0, t == 0 || t == of.grid.segments);
        }
    };
    for_each([&](std::size_t i, float x, bool is_position, bool) {
        auto const [root, opposite] = sets.root(i);
        float const here = opposite ? -x : x;
        Value& v = values[root];
        if (!v.is_set || (is_position && here < v.value)) v = {here, true};
    });
    for_each([&](std::size_t i, float& x, bool is_position, bool is_corner) {
        if (is_corner && !is_position) return;
        auto const [root, opposite] = sets.root(i);
        float const v = values[root].value, value = sets.is_zero(root) ? 0 : opposite ? -v : v;
        changed_ += value != x;
        x = value + 0.0f;
    });
}

} // namespace tessemu
