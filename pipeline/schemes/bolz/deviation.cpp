// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/bolz/deviation.h"

#include "pipeline/basis_tables/generator.h"
#include "pipeline/mesh/limit_constants.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tessemu {

namespace {

using Point = glm::dvec2;

constexpr int kSegments = 1 << PatchDeviation::kSampleLevel;
constexpr int kSide = kSegments + 1;
constexpr int kBlocks = 4; // regions of a grid, along u and v

// An angle of pi turns / parts.
struct Angle {
    int turns, parts;
};

// Between neighbouring edges of a ring.
Angle angle_of(VertexRing const& ring)
{
    int const n = ring.faces;
    if (ring.closed) return {2, n};
    if (ring.vertex == 0) return {1, n};
    // Of a corner: one face has a right angle, many less than pi.
    return !ring.concave.empty() ? Angle{3, 2 * n} : Angle{1, n + 1};
}

double cross(Point a, Point b)
{
    return a.x * b.y - a.y * b.x;
}

// Weights of the corners for the point of a triangle that is nearest to p.
struct Nearest {
    std::array<double, 3> weight{};
    double distance = 0; // squared
};

Nearest nearest_of(std::array<Point, 3> const& t, Point p)
{
    double const area = cross(t[1] - t[0], t[2] - t[0]);
    if (area > 0) {
        double const w[3] = {cross(t[1] - p, t[2] - p), cross(t[2] - p, t[0] - p),
                             cross(t[0] - p, t[1] - p)};
        if (w[0] >= 0 && w[1] >= 0 && w[2] >= 0) {
            double const sum = w[0] + w[1] + w[2];
            return {{w[0] / sum, w[1] / sum, w[2] / sum}, 0};
        }
    }
    Nearest best;
    best.distance = HUGE_VAL;
    for (std::size_t k = 0; k < 3; ++k) {
        std::size_t const l = (k + 1) % 3;
        Point const side = t[l] - t[k];
        double const length = glm::dot(side, side);
        double const s = length > 0 ? std::clamp(glm::dot(p - t[k], side) / length, 0.0, 1.0) : 0.0;
        Point const off = p - t[k] - s * side;
        double const distance = glm::dot(off, off);
        if (!(distance < best.distance)) continue;
        best.weight = {};
        best.weight[k] = 1 - s;
        best.weight[l] = s;
        best.distance = distance;
    }
    return best;
}

std::uint32_t sample_at(int x, int y)
{
    return std::uint32_t(y * kSide + x);
}

// Functionals of the points, [C, A, B][point], with the least weighted sum of squares of what
// C + x A + y B leaves.
std::vector<double> affine_fit(std::span<Point const> chart, std::span<double const> weight)
{
    std::size_t const n = chart.size();
    Point centre(0);
    double total = 0, xx = 0, xy = 0, yy = 0;
    for (std::size_t i = 0; i < n; ++i) {
        centre += weight[i] * chart[i];
        total += weight[i];
    }
    centre /= total;
    for (std::size_t i = 0; i < n; ++i) {
        Point const p = chart[i] - centre;
        xx += weight[i] * p.x * p.x, xy += weight[i] * p.x * p.y, yy += weight[i] * p.y * p.y;
    }
    double const determinant = xx * yy - xy * xy;
    std::vector<double> out(3 * n);
    for (std::size_t i = 0; i < n; ++i) {
        Point const p = weight[i] * (chart[i] - centre);
        double const a = out[n + i] = (yy * p.x - xy * p.y) / determinant;
        double const b = out[2 * n + i] = (xx * p.y - xy * p.x) / determinant;
        out[i] = weight[i] / total - centre.x * a - centre.y * b;
    }
    return out;
}

// A sample as an edge sees it: how far along it, and how far inside.
struct FromEdge {
    int along, inside;
};
FromEdge from_edge(int edge, int segments, int x, int y)
{
    switch (edge) {
    case 0:
        return {x, y};
    case 1:
        return {y, segments - x};
    case 2:
        return {segments - x, segments - y};
    default:
        return {segments - y, x};
    }
}

} // namespace

std::vector<glm::dvec2> chart_of(PatchType const& type, std::span<std::uint16_t const> beyond)
{
    // With lambda the eigenvalue of the ring of edges at (cos, sin) j theta, C = cos(theta/2): a
    // face between two edges lies at 4/(C + sqrt(C^2 + 4)), and the points beyond follow from
    // lambda X = the rule of X's vertex or edge.
    VertexRing const& ring = type.corner;
    auto const [turns, parts] = angle_of(ring);
    double const c = cos_pi(turns, 2 * parts), root = std::sqrt(c * c + 4);
    double const lambda = (2 + c * c + c * root) / 8, face = 4 / (c + root);
    auto const e = [&, t = turns, n = parts](int j) {
        return Point(cos_pi(t * j, n), sin_pi(t * j, n));
    };
    auto const f = [&, t = turns, n = parts](int j) {
        int const at = t * (2 * j + 1);
        return face * Point(cos_pi(at, 2 * n), sin_pi(at, 2 * n));
    };
    int const p = ring.position;
    double const s = 1 / (16 * lambda - 1);
    // Beyond edge j: (2,0) and to its left (2,1), to its right (2,-1).
    auto const straight = [&](int j) {
        Point const faces = f(j) + f(j - 1), edges = e(j + 1) + e(j - 1);
        return (36.0 * e(j) + 6.0 * faces + edges + s * (12.0 * e(j) + 6.0 * faces + edges)) /
               (64 * lambda - 6 - 2 * s);
    };
    auto const beside = [&](int j, int face_beside, int next) {
        return s * (6.0 * (e(j) + f(face_beside)) + e(next) + straight(j));
    };
    Point const x20 = straight(p), x21 = beside(p, p, p + 1), x02 = straight(p + 1),
                x12 = beside(p + 1, p, p);
    Point const x22 =
        (36.0 * f(p) + 6.0 * (e(p) + e(p + 1) + x21 + x12) + x20 + x02) / (64 * lambda - 1);
    std::vector<Point> out{Point(0)};
    for (int j = 0; j < ring.faces; ++j) {
        out.push_back(e(j));
        out.push_back(f(j));
    }
    if (!ring.closed) out.push_back(e(ring.faces));
    out.insert(out.end(), {x20, x21, x22, x12, x02});
    if (type.has_lower()) out.push_back(beside(p, p - 1, p - 1));
    if (type.has_left()) out.push_back(beside(p + 1, p + 1, p + 2));
    if (beyond.empty()) return out;
    std::vector<PatchType::BeyondPoint> const points = type.beyond_points();
    for (std::uint16_t number : beyond) {
        PatchType::BeyondPoint const& x = points[number];
        // The vertex, and the ends of the edges on both sides of the face that looks at it.
        std::array<Point, 3> const known =
            x.vertex == PatchType::RightVertex      ? std::array{x20, x21, e(p)}
            : x.vertex == PatchType::DiagonalVertex ? std::array{x22, x12, x21}
                                                    : std::array{x02, e(p + 1), x12};
        VertexRing const& around = *type.beyond[std::size_t(x.vertex)];
        Angle const angle = angle_of(around);
        int const steps = int(x.index) - around.position;
        auto const edge = [&](int j) { // so many edges on from the first of both
            double const sine = sin_pi(angle.turns, angle.parts);
            if (std::abs(sine) < 0.1) return Point(0); // a half turn, or nearly
            double const first = sin_pi(angle.turns * (1 - j), angle.parts) / sine,
                         second = sin_pi(angle.turns * j, angle.parts) / sine;
            return first * (known[1] - known[0]) + second * (known[2] - known[0]);
        };
        out.push_back(known[0] + (x.is_face ? edge(steps) + edge(steps + 1) : edge(steps)));
    }
    return out;
}

PatchDeviation::PatchDeviation(PatchTypeTables const& tables)
    : points_(tables.points),
      chart_(std::size_t(tables.points))
{
    std::size_t const n = std::size_t(points_), samples = std::size_t(kSide) * kSide;
    PatchType const& type = tables.type;
    BasisTables const finer = make_basis_tables(type, kSampleLevel);
    std::vector<Point> const chart = chart_of(type, finer.beyond);
    weights_.resize(n * samples);
    for (std::size_t k = 0; k < chart.size(); ++k) {
        auto const own = std::size_t(type.points());
        std::size_t at = k;
        if (k >= own) {
            auto const& beyond = tables.beyond;
            auto const found = std::find(beyond.begin(), beyond.end(), finer.beyond[k - own]);
            if (found == beyond.end()) continue; // roundings of 0
            at = own + std::size_t(found - beyond.begin());
        }
        std::size_t const i = tables.point_of[at];
        chart_[i] = chart[k];
        for (std::size_t q = 0; q < samples; ++q)
            weights_[q * n + i] += finer.position[k * samples + q];
    }
    samples_.resize(samples);
    for (std::size_t q = 0; q < samples; ++q) {
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) {
            double const b = weights_[q * n + i];
            samples_[q] += b * chart_[i];
            sum += std::abs(b);
        }
        reach_ = std::max(reach_, sum);
    }
    // Each control point counts by how much it may bend the patch.
    std::vector<double> weight(n, 0);
    for (Row const& r : rows(0))
        for (std::size_t i = 0; i < n; ++i) weight[i] = std::max(weight[i], r[2 + i]);
    fit_ = affine_fit(chart_, weight);
}

PatchDeviation::Net PatchDeviation::net_of(std::span<glm::dvec3 const> points,
                                           glm::dvec3 origin) const
{
    std::size_t const n = std::size_t(points_);
    std::array<glm::dvec3, 3> affine{};
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < n; ++i) affine[k] += fit_[k * n + i] * points[i];
    Net out;
    out.a = glm::length(affine[1]);
    out.b = glm::length(affine[2]);
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
        glm::dvec3 const flat = affine[0] + chart_[i].x * affine[1] + chart_[i].y * affine[2];
        out.residual.push_back(glm::length(points[i] - flat));
        largest = std::max({largest, glm::length(points[i]), glm::length(points[i] - origin)});
    }
    out.rounding = 2 * reach_ * double(2 * points_ + 8) * 0x1p-24 * largest;
    return out;
}

void PatchDeviation::add_sample(std::uint32_t sample, std::span<Triangle const> triangles,
                                Row& row) const
{
    Nearest best;
    best.distance = HUGE_VAL;
    Triangle const* of = nullptr;
    for (Triangle const& t : triangles) {
        Nearest const near =
            nearest_of({samples_[t.sample[0]], samples_[t.sample[1]], samples_[t.sample[2]]},
                       samples_[sample]);
        if (!(near.distance < best.distance)) continue;
        best = near;
        of = &t;
        if (best.distance == 0) break;
    }
    std::size_t const n = std::size_t(points_);
    Point flat(0);
    for (std::size_t i = 0; i < n; ++i) {
        double delta = weights_[sample * n + i];
        for (std::size_t k = 0; k < 3; ++k)
            delta -= best.weight[k] * weights_[of->sample[k] * n + i];
        row[2 + i] = std::max(row[2 + i], std::abs(delta));
        flat += delta * chart_[i];
    }
    row[0] = std::max(row[0], std::abs(flat.x));
    row[1] = std::max(row[1], std::abs(flat.y));
}

PatchDeviation::Rows const& PatchDeviation::rows(int level) const
{
    Rows& out = made_[{level, 0, -1}];
    if (!out.empty()) return out;
    out.assign(std::size_t(kBlocks) * kBlocks, Row(std::size_t(points_) + 2, 0));
    int const cells = 1 << level, step = kSegments >> level;
    auto const corner = [&](int x, int y) { return sample_at(x * step, y * step); };
    std::vector<Triangle> near;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            if (x % step == 0 && y % step == 0) continue; // a vertex
            int const cx = std::min(x / step, cells - 1), cy = std::min(y / step, cells - 1);
            near.clear();
            auto const add = [&](int i, int j) { // the side of the diagonal that has q goes first
                Triangle const below{{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)}},
                    above{{corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)}};
                bool const lower = y - cy * step <= x - cx * step;
                near.push_back(lower ? below : above);
                near.push_back(lower ? above : below);
            };
            add(cx, cy);
            for (int j = std::max(cy - 1, 0); j <= std::min(cy + 1, cells - 1); ++j)
                for (int i = std::max(cx - 1, 0); i <= std::min(cx + 1, cells - 1); ++i)
                    if (i != cx || j != cy) add(i, j);
            int const block = std::min(y * kBlocks / kSegments, kBlocks - 1) * kBlocks +
                              std::min(x * kBlocks / kSegments, kBlocks - 1);
            add_sample(sample_at(x, y), near, out[std::size_t(block)]);
        }
    return out;
}

PatchDeviation::Rows const& PatchDeviation::strip_rows(int level, int edge, int edge_level) const
{
    Rows& out = made_[{level, 1 + edge, edge_level}];
    if (!out.empty()) return out;
    out.assign(std::size_t(kBlocks), Row(std::size_t(points_) + 2, 0));
    GridLevels levels{std::uint8_t(level), {}};
    levels.edges[std::size_t(edge)] = std::uint8_t(edge_level);
    PatchGrid const grid = make_patch_grid(levels);
    int const segments = 1 << level, step = kSegments >> level;
    std::vector<Triangle> strip;
    std::vector<std::uint32_t> const& indices = grid.points.patch.indices;
    for (std::size_t t = 0; t < indices.size(); t += 3) {
        Triangle triangle;
        int most = 0, least = segments;
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t const place = grid.places[indices[t + k]];
            int const x = int(place & 0xff), y = int(place >> 8);
            int const inside = from_edge(edge, segments, x, y).inside;
            most = std::max(most, inside), least = std::min(least, inside);
            triangle.sample[k] = sample_at(x * step, y * step);
        }
        // Of the other edges, which have one segment, each triangle has a corner further inside.
        if (most == 1 && least == 0) strip.push_back(triangle);
    }
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            auto const [along, inside] = from_edge(edge, kSegments, x, y);
            if (inside > step || inside > along || inside > kSegments - along) continue;
            int const block = std::min(along * kBlocks / kSegments, kBlocks - 1);
            add_sample(sample_at(x, y), strip, out[std::size_t(block)]);
        }
    return out;
}

double PatchDeviation::largest(Net const& net, Rows const& rows) const
{
    double out = 0;
    for (Row const& row : rows) {
        double sum = row[0] * net.a + row[1] * net.b;
        for (std::size_t i = 0; i < net.residual.size(); ++i) sum += row[2 + i] * net.residual[i];
        out = std::max(out, sum);
    }
    return out + net.rounding;
}

double PatchDeviation::bound(Net const& net, int level) const
{
    return largest(net, rows(level));
}

double PatchDeviation::strip_bound(Net const& net, int level, int edge, int edge_level) const
{
    return largest(net, strip_rows(level, edge, edge_level));
}

double PatchDeviation::bound(Net const& net, GridLevels const& levels) const
{
    double out = bound(net, int(levels.inside)); // of the cells inside, and of some more
    if (levels.is_regular()) return out;
    for (int k = 0; k < 4; ++k)
        out = std::max(out, strip_bound(net, levels.inside, k, levels.edges[std::size_t(k)]));
    return out;
}

} // namespace tessemu
