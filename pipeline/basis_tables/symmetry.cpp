// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/symmetry.h"

#include "pipeline/basis_tables/signed_sets.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

namespace tessemu {

namespace {

bool is_infinite(float sharpness)
{
    return sharpness >= kInfinitelySharp;
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
        JointMatch const match = match_of(joint, types[joint.a], types[joint.b]);
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
        std::vector<PointsOfType::Cell> cell_of(std::size_t(t.points), {-9, -9});
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
        JointMatch match(a, b);
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
