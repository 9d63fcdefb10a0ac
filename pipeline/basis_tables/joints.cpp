// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/joints.h"

#include "pipeline/mesh/flatness.h"

#include <algorithm>
#include <cassert>
#include <set>

namespace tessemu {

namespace {

int wrapped(int i, int n)
{
    return (i % n + n) % n;
}

// Ring numbers of a vertex beyond a as b has them, whose own view of it is turned by `turn` faces.
int seen_by(VertexRing const& ring, int index, int turn)
{
    return ring.closed ? wrapped(index + turn, ring.faces) : index;
}

} // namespace

PatchSide other_side(PatchSide side)
{
    return side == PatchSide::Lower ? PatchSide::Left : PatchSide::Upper;
}
float lower_sharpness(PatchType const& t)
{
    return t.corner.edge(t.corner.position);
}
float left_sharpness(PatchType const& t)
{
    return t.corner.edge((t.corner.position + 1u) % t.corner.edge_count());
}
bool is_fold(PatchType const& t)
{
    return t.corner.closed && t.corner.faces == 2;
}

PointsOfType::PointsOfType(PatchTypeTables const& t) : type_(&t.type), point_of_(t.point_of)
{
    auto const take = [this](int& number) { return int(point_of_[std::size_t(number++)]); };
    VertexRing const& c = type_->corner;
    int const j = c.position, ring = type_->ring_points();
    int next = ring;
    for (Cell cell : {Cell{2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}}) grid_[cell] = take(next);
    if (type_->has_lower()) grid_[{2, -1}] = take(next);
    if (type_->has_left()) grid_[{-1, 2}] = take(next);
    auto const names = type_->beyond_points();
    for (std::uint16_t i : t.beyond)
        beyond_[{names[i].vertex, int(names[i].index), names[i].is_face}] = take(next);
    assert(std::size_t(next) == t.point_of.size());
    grid_[{0, 0}] = 0;
    grid_[{1, 0}] = edge(j);
    grid_[{1, 1}] = face(j);
    grid_[{0, 1}] = edge(j + 1);
    if (type_->has_lower()) {
        grid_[{0, -1}] = edge(j - 1);
        grid_[{1, -1}] = face(j - 1);
    }
    if (type_->has_left()) {
        grid_[{-1, 0}] = edge(j + 2);
        grid_[{-1, 1}] = face(j + 1);
    }
}

int PointsOfType::edge(int i) const
{
    VertexRing const& c = type_->corner;
    if (c.closed) i = wrapped(i, c.faces);
    return i < 0 || i >= int(c.edge_count()) ? -1 : point_of_[std::size_t(1 + 2 * i)];
}

int PointsOfType::face(int i) const
{
    VertexRing const& c = type_->corner;
    if (c.closed) i = wrapped(i, c.faces);
    return i < 0 || i >= c.faces ? -1 : point_of_[std::size_t(2 + 2 * i)];
}

int PointsOfType::at(Cell cell) const
{
    auto const found = grid_.find(cell);
    return found == grid_.end() ? -1 : found->second;
}

int PointsOfType::beyond(BeyondName const& name) const
{
    auto const found = beyond_.find(name);
    return found == beyond_.end() ? -1 : found->second;
}

JointMatch match_of(Joint const& joint, PatchTypeTables const& ta, PatchTypeTables const& tb)
{
    using Cell = PointsOfType::Cell;
    PointsOfType const a(ta), b(tb);
    JointMatch out(ta, tb);
    VertexRing const& ca = ta.type.corner;
    if (joint.mirrored) {
        // (column, row) to (row, column); the ring the other way round.
        int const n = ca.faces, first = ca.closed ? 1 : n;
        out.set(0, 0);
        for (int i = 0; i < int(ca.edge_count()); ++i) out.set(a.edge(i), b.edge(first - i));
        for (int i = 0; i < n; ++i) out.set(a.face(i), b.face(first - 1 - i));
        for (auto const& [cell, point] : a.grid())
            if (cell[0] == 2 || cell[1] == 2) out.set(point, b.at({cell[1], cell[0]}));
        return out;
    }
    if (joint.side == PatchSide::Lower) {
        auto const grid = [&](Cell cell) { out.set(a.at(cell), b.at({-cell[1], cell[0]})); };
        if (!ca.closed && ca.position == 0) { // b is of another sector, and the line is all
            for (Cell cell : {Cell{0, 0}, {1, 0}, {2, 0}}) grid(cell);
            if (ca.vertex == 0) out.set(a.edge(ca.faces), b.edge(0)); // a crease's, through V
            return out;
        }
        int const turn = ca.closed ? 1 : 0; // b is the face before a
        out.set(0, 0);
        for (int i = 0; i < int(ca.edge_count()); ++i) out.set(a.edge(i), b.edge(i + turn));
        for (int i = 0; i < ca.faces; ++i) out.set(a.face(i), b.face(i + turn));
        for (Cell cell : {Cell{2, 0}, {2, 1}, {2, -1}}) grid(cell);
        // a's (2,0) is b's (0,2); it looks at it by the face above the line, b by that below.
        if (auto const& ring = ta.type.beyond[PatchType::RightVertex])
            for (auto const& [name, point] : a.beyond())
                if (name.of == PatchType::RightVertex)
                    out.set(point, b.beyond({PatchType::UpperVertex, seen_by(*ring, name.index, -1),
                                             name.is_face}));
        return out;
    }
    // a's (c, r) is b's (r, 2 - c): b's corner is (2,0), and its (0,2) a's corner.
    for (auto const& [cell, point] : a.grid())
        if (cell[0] >= 0) out.set(point, b.at({cell[1], 2 - cell[0]}));
    if (tb.type.beyond[PatchType::UpperVertex])
        for (auto const& [name, point] : b.beyond()) {
            if (name.of != PatchType::UpperVertex) continue;
            out.set(name.is_face ? a.face(name.index) : a.edge(name.index), point);
        }
    for (auto const& [name, point] : a.beyond()) {
        if (name.of == PatchType::RightVertex)
            out.set(point, name.is_face ? b.face(name.index) : b.edge(name.index));
        if (name.of == PatchType::DiagonalVertex)
            out.set(point, b.beyond({PatchType::RightVertex, name.index, name.is_face}));
        if (name.of == PatchType::UpperVertex) // b's (2,2), seen by the same face
            out.set(point, b.beyond({PatchType::DiagonalVertex, name.index, name.is_face}));
    }
    return out;
}

namespace {

PatchType neighbour_below(PatchType t)
{
    if (t.corner.closed && !t.corner.edges.empty())
        std::rotate(t.corner.edges.rbegin(), t.corner.edges.rbegin() + 1, t.corner.edges.rend());
    if (t.corner.closed)
        for (std::uint16_t& edge : t.corner.concave)
            edge = std::uint16_t((edge + 1) % t.corner.faces);
    std::sort(t.corner.concave.begin(), t.corner.concave.end());
    if (!t.corner.closed) --t.corner.position;
    return t;
}

PatchType mirror_image(PatchType t)
{
    VertexRing& c = t.corner;
    std::reverse(c.edges.begin(), c.edges.end());
    if (c.closed && !c.edges.empty()) // edge i becomes 1 - i
        std::rotate(c.edges.rbegin(), c.edges.rbegin() + 2 % c.faces, c.edges.rend());
    if (!c.closed) c.position = std::uint16_t(c.faces - 1 - c.position);
    return t;
}

// Whether a neighbour across Right, or Upper, would need to know the corner.
bool reaches_beyond(PatchType const& t, PatchSide side)
{
    if (t.sectors == SectorRules::OpenSubdiv) return false;
    VertexRing const& c = t.corner;
    return c.leans((c.position + (side == PatchSide::Upper ? 1u : 0u)) % c.edge_count()) ||
           is_flattened(c.sharpness(t.sectors, t.flatness), c.faces);
}

} // namespace

std::vector<Joint> possible_joints(std::span<PatchTypeTables const> types)
{
    std::map<PatchType, std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < types.size(); ++i) {
        PatchType const& t = types[i].type;
        bool const alone = std::none_of(t.beyond.begin(), t.beyond.end(),
                                        [](auto const& ring) { return ring.has_value(); });
        if (alone && t.family() != PatchFamily::SemiSharp) numbers.emplace(t, i);
    }
    std::set<Joint> out;
    // Each that can be a with one b, and each b with one a: that makes them all equal.
    using List = std::vector<std::uint32_t>;
    auto const join_all = [&](PatchSide side, List const& a, List const& b) {
        if (a.empty() || b.empty()) return;
        for (std::uint32_t i : a) out.insert({i, side, b[0]});
        for (std::uint32_t i : b) out.insert({a[0], side, i});
    };
    List right[2], upper[2];                       // by whether at an infinitely sharp edge
    std::map<float, std::array<List, 2>> crossing; // infinitely sharp edges, by the corner's own
    for (auto const& [type, i] : numbers) {
        VertexRing const& c = type.corner;
        float const lower = lower_sharpness(type), left = left_sharpness(type);
        if (!is_fold(type) && !reaches_beyond(type, PatchSide::Right))
            right[lower >= kInfinitelySharp].push_back(i);
        if (!is_fold(type) && !reaches_beyond(type, PatchSide::Upper))
            upper[left >= kInfinitelySharp].push_back(i);
        if (c.closed || c.position > 0) {
            if (auto const below = numbers.find(neighbour_below(type)); below != numbers.end())
                out.insert({i, PatchSide::Lower, below->second});
        } else {
            crossing[c.vertex][0].push_back(i);
        }
        if (!c.closed && c.position + 1 == c.faces) crossing[c.vertex][1].push_back(i);
        if (auto const image = numbers.find(mirror_image(type)); image != numbers.end())
            for (PatchSide side : {PatchSide::Lower, PatchSide::Right})
                if (side == PatchSide::Lower || !is_fold(type))
                    out.insert({i, side, image->second, true});
    }
    for (int tag : {0, 1}) join_all(PatchSide::Right, right[tag], upper[tag]);
    for (auto const& [sharpness, ends] : crossing) join_all(PatchSide::Lower, ends[0], ends[1]);
    return {out.begin(), out.end()};
}

} // namespace tessemu
