// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/symmetry.h"

#include "pipeline/mesh/flatness.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <set>

namespace tessemu {

namespace {

// A control point of the ring of a vertex beyond.
struct PointName {
    int of, index, is_face; // of: PatchType::Beyond

    auto operator<=>(PointName const&) const = default;
};

int wrapped(int i, int n)
{
    return (i % n + n) % n;
}

using Cell = std::array<int, 2>; // column, row of the control points' grid

// Control points by where they lie; none: -1.
class PointsOfType {
public:
    explicit PointsOfType(PatchTypeTables const& t) : type_(&t.type), point_of_(t.point_of)
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

    // Of V's ring, by its own numbers.
    int edge(int i) const
    {
        VertexRing const& c = type_->corner;
        if (c.closed) i = wrapped(i, c.faces);
        return i < 0 || i >= int(c.edge_count()) ? -1 : point_of_[std::size_t(1 + 2 * i)];
    }
    int face(int i) const
    {
        VertexRing const& c = type_->corner;
        if (c.closed) i = wrapped(i, c.faces);
        return i < 0 || i >= c.faces ? -1 : point_of_[std::size_t(2 + 2 * i)];
    }
    int at(Cell cell) const
    {
        auto const found = grid_.find(cell);
        return found == grid_.end() ? -1 : found->second;
    }
    int beyond(PointName const& name) const
    {
        auto const found = beyond_.find(name);
        return found == beyond_.end() ? -1 : found->second;
    }
    std::map<Cell, int> const& grid() const { return grid_; }
    std::map<PointName, int> const& beyond() const { return beyond_; }

private:
    PatchType const* type_;
    std::span<std::uint16_t const> point_of_;
    std::map<Cell, int> grid_;
    std::map<PointName, int> beyond_;
};

// Of a joint: which control point of a is which of b; -1: it has none.
struct Match {
    std::vector<int> of_a, of_b;

    Match(PatchTypeTables const& a, PatchTypeTables const& b)
        : of_a(std::size_t(a.points), -1),
          of_b(std::size_t(b.points), -1)
    {
    }
    void set(int a, int b)
    {
        if (a < 0 || b < 0) return;
        of_a[std::size_t(a)] = b;
        of_b[std::size_t(b)] = a;
    }
};

bool is_infinite(float sharpness)
{
    return sharpness >= kInfinitelySharp;
}
// Of the edge along Lower, and along Left.
float lower_sharpness(PatchType const& t)
{
    return t.corner.edge(t.corner.position);
}
float left_sharpness(PatchType const& t)
{
    return t.corner.edge((t.corner.position + 1u) % t.corner.edge_count());
}
PatchSide other_side(PatchSide side)
{
    return side == PatchSide::Lower ? PatchSide::Left : PatchSide::Upper;
}

// Ring numbers of a vertex beyond a as b has them, whose own view of it is turned by `turn` faces.
int seen_by(VertexRing const& ring, int index, int turn)
{
    return ring.closed ? wrapped(index + turn, ring.faces) : index;
}

Match match_of(Joint const& joint, PatchTypeTables const& ta, PatchTypeTables const& tb)
{
    PointsOfType const a(ta), b(tb);
    Match out(ta, tb);
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

std::size_t sample_at(PatchSide side, std::size_t t)
{
    constexpr std::size_t n = kTableSide;
    switch (side) {
    case PatchSide::Lower:
        return t;
    case PatchSide::Right:
        return t * n + n - 1;
    case PatchSide::Upper:
        return (n - 1) * n + t;
    case PatchSide::Left:
        return t * n;
    }
    return 0;
}

// Sets of numbers that are equal or opposite; those that are their own opposite are 0.
class SignedSets {
public:
    explicit SignedSets(std::size_t size) : parent_(size), is_opposite_(size, 0), is_zero_(size, 0)
    {
        for (std::size_t i = 0; i < size; ++i) parent_[i] = i;
    }
    std::pair<std::size_t, bool> root(std::size_t i)
    {
        std::size_t r = i;
        bool opposite = false;
        while (parent_[r] != r) opposite ^= is_opposite_[r] != 0, r = parent_[r];
        bool rest = opposite;
        while (parent_[i] != r && i != r) { // compress
            std::size_t const next = parent_[i];
            bool const here = is_opposite_[i] != 0;
            parent_[i] = r, is_opposite_[i] = rest;
            rest ^= here;
            i = next;
        }
        return {r, opposite};
    }
    void join(std::size_t a, std::size_t b, bool opposite = false)
    {
        auto const [ra, oa] = root(a);
        auto const [rb, ob] = root(b);
        bool const turned = oa ^ ob ^ opposite;
        if (ra == rb) {
            is_zero_[ra] |= turned;
            return;
        }
        auto const [low, high] = std::minmax(ra, rb);
        parent_[high] = low;
        is_opposite_[high] = turned;
        is_zero_[low] |= is_zero_[high];
    }
    void set_zero(std::size_t i) { is_zero_[root(i).first] = 1; }
    bool is_zero(std::size_t root_) const { return is_zero_[root_]; }
    std::size_t size() const { return parent_.size(); }

private:
    std::vector<std::size_t> parent_;
    std::vector<char> is_opposite_, is_zero_;
};

// What double's roundings leave of a weight that is 0.
constexpr float kRoundingOf0 = 0x1p-40f;

std::uint32_t ulps_between(float a, float b)
{
    auto const ordered = [](float v) {
        auto const bits = std::bit_cast<std::uint32_t>(v);
        return bits >> 31 ? -std::int64_t(bits & 0x7fffffffu) : std::int64_t(bits);
    };
    std::int64_t const apart = ordered(a) - ordered(b);
    return std::uint32_t(apart < 0 ? -apart : apart);
}

// Entries on the sides of all types, by table: 0 position, 1 du, 2 dv.
class Entries {
public:
    explicit Entries(std::span<PatchTypeTables> types) : types_(types)
    {
        number_of_.fill(kNone);
        for (PatchSide side :
             {PatchSide::Lower, PatchSide::Right, PatchSide::Upper, PatchSide::Left})
            for (std::size_t t = 0; t < kTableSide; ++t) {
                std::size_t const s = sample_at(side, t);
                if (number_of_[s] != kNone) continue;
                number_of_[s] = samples_.size();
                samples_.push_back(s);
            }
        for (PatchTypeTables const& t : types) {
            first_.push_back(size_);
            size_ += 3 * std::size_t(t.points) * samples_.size();
        }
    }
    std::size_t size() const { return size_; }
    std::size_t at(std::size_t type, std::size_t table, std::size_t point, PatchSide side,
                   std::size_t t) const
    {
        return first_[type] + (point * 3 + table) * samples_.size() +
               number_of_[sample_at(side, t)];
    }
    // In the order of at().
    template <class Function> void for_each(Function const& function) const
    {
        std::size_t i = 0;
        for (PatchTypeTables& t : types_)
            for (std::size_t k = 0; k < std::size_t(t.points); ++k)
                for (auto* table : {&t.position, &t.du, &t.dv})
                    for (std::size_t s : samples_)
                        function(i++, (*table)[k * kTableSamples + s], table == &t.position);
    }

private:
    static constexpr std::size_t kNone = std::size_t(-1);
    std::span<PatchTypeTables> types_;
    std::array<std::size_t, kTableSamples> number_of_;
    std::vector<std::size_t> samples_, first_;
    std::size_t size_ = 0;
};

struct Tangents {
    std::size_t along, across; // numbers of tables
};
Tangents tangents_of(PatchSide side)
{
    bool const is_u = side == PatchSide::Lower || side == PatchSide::Upper;
    return is_u ? Tangents{1, 2} : Tangents{2, 1};
}

} // namespace

PatchTypeTables in_single_precision(PatchType const& type, BasisTables const& tables,
                                    std::vector<std::uint16_t> point_of)
{
    if (point_of.empty()) {
        point_of.resize(std::size_t(tables.points));
        std::iota(point_of.begin(), point_of.end(), std::uint16_t(0));
    }
    int const points = 1 + *std::max_element(point_of.begin(), point_of.end());
    auto const rounded = [&](std::vector<double> const& x) {
        std::vector<double> sums(std::size_t(points) * kTableSamples, 0.0);
        for (std::size_t k = 0; k < point_of.size(); ++k)
            for (std::size_t s = 0; s < kTableSamples; ++s)
                sums[point_of[k] * std::size_t(kTableSamples) + s] += x[k * kTableSamples + s];
        return std::vector<float>(sums.begin(), sums.end());
    };
    auto position = rounded(tables.position), du = rounded(tables.du), dv = rounded(tables.dv);
    return {type,          points,       std::move(point_of), tables.beyond, std::move(position),
            std::move(du), std::move(dv)};
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

// With two faces around, points on both sides of the patch are one, and its neighbours' are not.
bool is_fold(PatchType const& t)
{
    return t.corner.closed && t.corner.faces == 2;
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
            right[is_infinite(lower)].push_back(i);
        if (!is_fold(type) && !reaches_beyond(type, PatchSide::Upper))
            upper[is_infinite(left)].push_back(i);
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

namespace {

// Classes of table edges, for the report.
void count_classes(std::span<PatchTypeTables const> types, std::span<Joint const> joints,
                   SymmetryReport& out)
{
    std::vector<std::size_t> first;
    std::size_t size = 0;
    for (PatchTypeTables const& t : types) {
        first.push_back(size);
        size += 4 * std::size_t(t.points);
    }
    auto const at = [&](std::size_t type, PatchSide side, int point) {
        return first[type] + std::size_t(side) * std::size_t(types[type].points) +
               std::size_t(point);
    };
    SignedSets directed(size);
    for (Joint const& joint : joints) {
        Match const match = match_of(joint, types[joint.a], types[joint.b]);
        for (int k = 0; k < types[joint.a].points; ++k)
            if (int const other = match.of_a[std::size_t(k)]; other >= 0)
                directed.join(at(joint.a, joint.side, k),
                              at(joint.b, other_side(joint.side), other));
    }
    // What (2,0), (2,1) and (2,-1) weigh on a side from the corner does not depend on its ring.
    std::map<int, std::size_t> two_ring;
    for (std::size_t type = 0; type < types.size(); ++type) {
        PatchTypeTables const& t = types[type];
        if (t.type.family() == PatchFamily::SemiSharp) continue;
        PointsOfType const points(t);
        for (int d : {-1, 0, 1}) {
            auto const join = [&](PatchSide side, float line, int point) {
                if (line > 0 || point < 0) return;
                std::size_t const edge = at(type, side, point);
                auto const [found, is_new] = two_ring.try_emplace(std::abs(d), edge);
                if (!is_new) directed.join(found->second, edge);
            };
            join(PatchSide::Lower, lower_sharpness(t.type), points.at({2, d}));
            join(PatchSide::Left, left_sharpness(t.type), points.at({d, 2}));
        }
    }
    SignedSets undirected = directed;
    std::map<SymmetryReport::Classes*, std::array<std::set<std::size_t>, 2>> found;
    std::vector<std::pair<SymmetryReport::Classes*, std::size_t>> edges;
    for (std::size_t type = 0; type < types.size(); ++type) {
        PatchTypeTables const& t = types[type];
        PointsOfType const points(t);
        std::vector<Cell> cell_of(std::size_t(t.points), Cell{-9, -9});
        for (auto const& [cell, point] : points.grid())
            if (cell_of[std::size_t(point)][0] == -9) cell_of[std::size_t(point)] = cell;
        for (PatchSide side :
             {PatchSide::Lower, PatchSide::Right, PatchSide::Upper, PatchSide::Left}) {
            bool const is_lower = side == PatchSide::Lower || side == PatchSide::Right;
            bool const at_tag =
                is_infinite(is_lower ? lower_sharpness(t.type) : left_sharpness(t.type));
            bool const off_corner = side == PatchSide::Right || side == PatchSide::Upper;
            if (off_corner && is_fold(t.type)) continue;
            for (int k = 0; k < t.points; ++k) {
                bool any = false;
                for (std::size_t s = 0; s < kTableSide && !any; ++s)
                    any = t.position[std::size_t(k) * kTableSamples + sample_at(side, s)] != 0;
                if (!any) continue;
                auto const [c, r] = cell_of[std::size_t(k)];
                if (off_corner && !at_tag) {
                    int const reversed =
                        side == PatchSide::Right ? points.at({c, 1 - r}) : points.at({1 - c, r});
                    if (reversed >= 0) undirected.join(at(type, side, k), at(type, side, reversed));
                }
                bool const is_two_ring = side == PatchSide::Lower ? c == 2 : r == 2;
                SymmetryReport::Classes* const kind =
                    off_corner               ? (at_tag ? &out.off_corner_at_a_tag : &out.off_corner)
                    : is_two_ring && !at_tag ? &out.two_ring
                                             : &out.on_corner;
                edges.emplace_back(kind, at(type, side, k));
            }
        }
    }
    for (auto const& [kind, edge] : edges) {
        ++kind->table_edges;
        found[kind][0].insert(directed.root(edge).first);
        found[kind][1].insert(undirected.root(edge).first);
    }
    for (auto const& [kind, sets] : found) {
        kind->directed = sets[0].size();
        kind->undirected = sets[1].size();
    }
}

} // namespace

SymmetryReport enforce_symmetry(std::span<PatchTypeTables> types, std::span<Joint const> joints,
                                std::span<JointPoints const> points, CountClasses classes)
{
    SymmetryReport out;
    out.joints = joints.size();
    if (classes == CountClasses::Yes) count_classes(types, joints, out);
    Entries const entries(types);
    SignedSets sets(entries.size());
    for (std::size_t number = 0; number < joints.size(); ++number) {
        Joint const& joint = joints[number];
        PatchTypeTables const &a = types[joint.a], &b = types[joint.b];
        PatchSide const side_a = joint.side, side_b = other_side(side_a);
        Match match(a, b);
        if (points.empty())
            match = match_of(joint, a, b);
        else
            for (auto const& [of_a, of_b] : points[number]) match.set(of_a, of_b);
        Tangents const ta = tangents_of(side_a), tb = tangents_of(side_b);
        bool const on_corner = side_a == PatchSide::Lower;
        bool const shares_across =
            joint.mirrored || !on_corner || !is_infinite(lower_sharpness(a.type));
        for (std::size_t t = 0; t < kTableSide; ++t) {
            bool const has_tangents = !(on_corner && t == 0);
            for (std::size_t k = 0; k < std::size_t(a.points); ++k) {
                auto const ea = [&](std::size_t table) {
                    return entries.at(joint.a, table, k, side_a, t);
                };
                if (match.of_a[k] < 0) {
                    sets.set_zero(ea(0));
                    if (has_tangents) sets.set_zero(ea(ta.along));
                    if (has_tangents && shares_across) sets.set_zero(ea(ta.across));
                    continue;
                }
                auto const eb = [&](std::size_t table) {
                    return entries.at(joint.b, table, std::size_t(match.of_a[k]), side_b, t);
                };
                sets.join(ea(0), eb(0));
                if (has_tangents) sets.join(ea(ta.along), eb(tb.along));
                if (has_tangents && shares_across)
                    sets.join(ea(ta.across), eb(tb.across), !joint.mirrored);
            }
            for (std::size_t k = 0; k < std::size_t(b.points); ++k) {
                if (match.of_b[k] >= 0) continue;
                sets.set_zero(entries.at(joint.b, 0, k, side_b, t));
                if (has_tangents) sets.set_zero(entries.at(joint.b, tb.along, k, side_b, t));
                if (has_tangents && shares_across)
                    sets.set_zero(entries.at(joint.b, tb.across, k, side_b, t));
            }
        }
    }
    // The value of each set, as its root has it.
    struct Value {
        float least = 0;
        std::uint32_t count = 0;
        bool positive = false, negative = false;
    };
    for (bool any = true; any;) {
        any = false;
        std::vector<Value> values(entries.size());
        entries.for_each([&](std::size_t i, float& x, bool is_position) {
            auto const [r, opposite] = sets.root(i);
            Value& v = values[r];
            float const here = opposite ? -x : x;
            v.positive |= here > 0, v.negative |= here < 0;
            if (v.count++ == 0 ||
                (is_position ? here < v.least : std::abs(here) < std::abs(v.least)))
                v.least = here;
        });
        std::size_t compared = 0;
        entries.for_each([&](std::size_t i, float& x, bool is_position) {
            auto const [r, opposite] = sets.root(i);
            Value const& v = values[r];
            if (v.count < 2 && !sets.is_zero(r)) return;
            ++compared;
            bool const is_zero = sets.is_zero(r) || (!is_position && v.positive && v.negative);
            float const value = is_zero || v.least == 0 ? 0.0f : opposite ? -v.least : v.least;
            if (std::bit_cast<std::uint32_t>(value) == std::bit_cast<std::uint32_t>(x)) return;
            if (value != x) {
                ++out.changed;
                any = true;
                if (std::max(std::abs(value), std::abs(x)) < kRoundingOf0 || value == 0) {
                    ++out.zeroed;
                } else {
                    std::uint32_t const ulps = ulps_between(value, x);
                    out.changed_ulps += ulps;
                    out.most_ulps = std::max(out.most_ulps, ulps);
                }
            }
            x = value; // and -0 is 0
        });
        out.entries = compared;
        out.passes += any;
    }
    return out;
}

} // namespace tessemu
