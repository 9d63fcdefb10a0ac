// SPDX-License-Identifier: Apache-2.0
#include "analysis/compare.h"

#include "analysis/embree_scene.h"
#include "pipeline/mesh/placement.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace tessemu {

namespace {

using Vec = glm::dvec3;

// The angle between unit vectors without a library arc tangent, so that results have the same bits
// everywhere: tan(angle/2) = |a - b| / |a + b| is halved four times, tan(x/2) = t / (1 + sqrt(1 +
// t^2)); of the series at t < 0.05 eight terms are within 2^-60.
double angle(Vec const& a, Vec const& b)
{
    double const apart = glm::length(a - b), together = glm::length(a + b);
    bool const wide = apart > together; // beyond a right angle: pi less the other angle
    double t = wide ? together / apart : apart / std::max(together, 1e-300);
    for (int i = 0; i < 4; ++i) t = t / (1 + std::sqrt(1 + t * t));
    double sum = 0;
    for (int k = 7; k >= 0; --k) sum = 1.0 / (2 * k + 1) - t * t * sum;
    double const result = 2 * 16 * t * sum;
    return wide ? 3.14159265358979323846 - result : result;
}

struct Triangles {
    std::vector<Vec> position, normal;
    std::vector<std::uint32_t> index;
    std::vector<double> weight; ///< a third of the areas around a vertex

    void weigh()
    {
        weight.assign(position.size(), 0);
        for (std::size_t t = 0; t + 2 < index.size(); t += 3) {
            Vec const a = position[index[t]], b = position[index[t + 1]],
                      c = position[index[t + 2]];
            double const area = glm::length(cross(b - a, c - a)) / 2;
            for (std::size_t k = 0; k < 3; ++k) weight[index[t + k]] += area / 3;
        }
    }
};

class Accumulator {
public:
    void add(double x, double weight)
    {
        s_.max = std::max(s_.max, x);
        sum_ += weight * x;
        squares_ += weight * x * x;
        weight_ += weight;
        ++s_.samples;
    }
    ErrorStatistics result() const
    {
        ErrorStatistics s = s_;
        if (weight_ > 0) {
            s.mean = sum_ / weight_;
            s.rms = std::sqrt(squares_ / weight_);
        }
        return s;
    }

private:
    ErrorStatistics s_;
    double sum_ = 0, squares_ = 0, weight_ = 0;
};

// The closest point of a triangle, as weights of b and c (Ericson, Real-Time Collision Detection,
// section 5.1.5: the region of the triangle's plane that the point projects to).
glm::dvec2 closest_in_triangle(Vec const& p, Vec const& a, Vec const& b, Vec const& c)
{
    Vec const ab = b - a, ac = c - a, ap = p - a;
    double const d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return {0, 0};
    Vec const bp = p - b;
    double const d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return {1, 0};
    double const vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 / (d1 - d3), 0};
    Vec const cp = p - c;
    double const d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return {0, 1};
    double const vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 / (d2 - d6)};
    double const va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        double const w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {1 - w, w};
    }
    double const scale = 1 / (va + vb + vc);
    return {vb * scale, vc * scale};
}

class ClosestPoints {
public:
    explicit ClosestPoints(Triangles const& t)
        : t_(t),
          scene_(std::span(t.position), std::span(t.index))
    {
    }

    /// Distance and the interpolated normal of the closest point that does not face away from
    /// `facing`. The tree is in single precision, the distance is not.
    std::pair<double, Vec> find(Vec const& p, Vec const& facing) const
    {
        Search s{&t_, p, facing, kNowhere, Vec(0)};
        RTCPointQuery query{};
        query.x = float(p.x), query.y = float(p.y), query.z = float(p.z);
        query.radius = INFINITY;
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        rtcPointQuery(scene_.get(), &query, &context, &visit, &s);
        if (s.squared == kNowhere && facing != Vec(0)) return find(p, Vec(0)); // all face away
        double const length = glm::length(s.normal);
        return {std::sqrt(s.squared), length > 0 ? s.normal / length : s.normal};
    }

private:
    static constexpr double kNowhere = 1e300;
    struct Search {
        Triangles const* t;
        Vec p;
        Vec facing;
        double squared;
        Vec normal;
    };
    static bool visit(RTCPointQueryFunctionArguments* arguments)
    {
        auto& s = *static_cast<Search*>(arguments->userPtr);
        std::uint32_t const* const i = s.t->index.data() + 3 * std::size_t(arguments->primID);
        auto const& x = s.t->position;
        glm::dvec2 const w = closest_in_triangle(s.p, x[i[0]], x[i[1]], x[i[2]]);
        Vec const at = (1 - w.x - w.y) * x[i[0]] + w.x * x[i[1]] + w.y * x[i[2]];
        double const squared = dot(at - s.p, at - s.p);
        if (squared >= s.squared) return false;
        auto const& n = s.t->normal;
        Vec const normal = (1 - w.x - w.y) * n[i[0]] + w.x * n[i[1]] + w.y * n[i[2]];
        if (dot(normal, s.facing) < 0) return false; // another sheet of a thin part
        s.squared = squared;
        s.normal = normal;
        // A little wider than the best so far: the tree rounds.
        arguments->query->radius = float(std::sqrt(squared) * 1.0001 + 1e-30);
        return true;
    }

    Triangles const& t_;
    EmbreeScene scene_;
};

void compare_closest(Triangles const& samples, Triangles const& surface, double diagonal,
                     ThreadPool const& threads, ErrorStatistics& distance, ErrorStatistics& normal)
{
    ClosestPoints const closest(surface);
    std::vector<std::pair<double, double>> errors(samples.position.size());
    constexpr std::size_t kPiece = 4096;
    threads.parallel_for((errors.size() + kPiece - 1) / kPiece, [&](std::size_t piece) {
        for (std::size_t i = piece * kPiece; i < std::min(errors.size(), (piece + 1) * kPiece);
             ++i) {
            if (samples.weight[i] == 0) continue;
            auto const [d, n] = closest.find(samples.position[i], samples.normal[i]);
            errors[i] = {d / diagonal, angle(samples.normal[i], n)};
        }
    });
    Accumulator d, n;
    for (std::size_t i = 0; i < errors.size(); ++i) { // in order: the same sum for any threads
        if (samples.weight[i] == 0) continue;
        d.add(errors[i].first, samples.weight[i]);
        n.add(errors[i].second, samples.weight[i]);
    }
    distance = d.result();
    normal = n.result();
}

constexpr std::uint32_t kNoPartner = 0xffffffffu;

// The scheme's domain points on the limit surface's grid, and the limit's vertex at the same
// parameter.
struct SchemeSamples {
    Triangles triangles;
    std::vector<std::uint32_t> partner;
    std::vector<int> times; ///< as times_if_it_went_on()
};

// The drawn mesh's face that a patch lies on, whole or a part of it.
class FacesByPlace {
public:
    explicit FacesByPlace(RefinedMesh const& mesh)
    {
        for (std::uint32_t f = 0; f < mesh.mesh().faces(); ++f)
            faces_[key(mesh.place(f))] = {f, mesh.place(f).rotation};
    }

    struct OnFace {
        std::uint32_t face;
        PatchPlace in_cell; ///< of the patch in the face's cell
        PatchPlace turn;    ///< from the cell to the face, whose corner 0 need not be the cell's

        UnitPoint at(float u, float v) const
        {
            UnitPoint const cell = domain_to_unit(in_cell, u, v);
            return domain_to_unit(turn, cell.u, cell.v);
        }
    };
    OnFace find(PatchPlace const& place) const
    {
        for (PatchPlace cell = place;; cell = parent(cell)) {
            auto const found = faces_.find(key(cell));
            if (found == faces_.end()) {
                if (cell.level == 0) throw Error("a patch lies on no face of the drawn mesh");
                continue;
            }
            OnFace out{found->second.first, place, {}};
            int const steps = place.level - cell.level;
            auto const in_cell = [&](int at, int first) {
                return std::uint16_t(cell.is_flipped ? ((first + 1) << steps) - 1 - at
                                                     : at - (first << steps));
            };
            out.in_cell.level = std::uint8_t(steps);
            out.in_cell.i = in_cell(place.i, cell.i);
            out.in_cell.j = in_cell(place.j, cell.j);
            out.in_cell.is_flipped = place.is_flipped != cell.is_flipped;
            out.turn.sides = place.sides;
            out.turn.rotation = std::uint8_t((place.sides - found->second.second) % place.sides);
            return out;
        }
    }

private:
    using Key =
        std::tuple<std::uint32_t, std::uint16_t, std::uint8_t, bool, std::uint16_t, std::uint16_t>;
    static Key key(PatchPlace const& p)
    {
        return {p.face, p.corner, p.level, p.is_flipped, p.i, p.j};
    }
    // The cell that a step made this one of. Of a parallelogram's eight triangles those belong to
    // its flipped half whose middle lies beyond the diagonal.
    static PatchPlace parent(PatchPlace p)
    {
        p.is_flipped = p.sides == 3 && (p.i & 1) + (p.j & 1) + int(p.is_flipped) > 1;
        --p.level;
        p.i /= 2;
        p.j /= 2;
        return p;
    }
    std::map<Key, std::pair<std::uint32_t, int>> faces_;
};

// How much more of a patch would lie around a point, in a regular net, if the patch went on.
int times_if_it_went_on(int sides, float u, float v)
{
    if (sides == 4) return 1 << ((u == 0 || u == 1) + (v == 0 || v == 1));
    int const on = (u == 0) + (v == 0) + (u + v == 1); // so many sides
    return on == 2 ? 6 : 1 << on;
}

SchemeSamples sample_scheme(LimitSurface const& limit, PatchMesh const& patches,
                            FrameSettings settings, ThreadPool const& threads)
{
    FacesByPlace const faces(patches.mesh());
    // Patches that are parts of a face are drawn as finely as the smallest has points of the grid.
    int finest = 0;
    frame_commands(patches, settings, surface_settings(settings))
        .for_each_surface_draw([&](Draw const& d) {
            for (PatchPlace const& p : d.patches)
                finest = std::max(finest, int(faces.find(p).in_cell.level));
        });
    settings.tess_factor = float(std::max(1, limit.grid() >> finest));
    settings.partitioning = Partitioning::Integer;
    SchemeSamples out;
    Triangles& scheme = out.triangles;
    visit_surface(patches, settings, threads, [&](SurfacePatch const& p) {
        FacesByPlace::OnFace const on = faces.find(p.place());
        auto const first = std::uint32_t(scheme.position.size());
        for (std::size_t i = 0; i < p.points(); ++i) {
            SurfaceVertex const vertex = p.vertex(i);
            scheme.position.emplace_back(vertex.position);
            scheme.normal.emplace_back(vertex.normal);
            float const u = p.domain().u[i], v = p.domain().v[i];
            std::uint32_t at = kNoPartner;
            if (limit.has_grid(on.face)) {
                UnitPoint const f = on.at(u, v);
                float const x = f.u * float(limit.grid()), y = f.v * float(limit.grid());
                if (float(int(x)) == x && float(int(y)) == y)
                    at = limit.vertex(on.face, int(x), int(y));
            }
            out.partner.push_back(at);
            out.times.push_back(times_if_it_went_on(p.place().sides, u, v));
        }
        for (std::uint32_t i : p.triangles()) scheme.index.push_back(first + i);
    });
    return out;
}

EqualParameterErrors errors_of(LimitSurface const& limit, SchemeSamples const& samples,
                               double diagonal)
{
    Triangles const& t = samples.triangles;
    EqualParameterErrors out;
    out.diagonal = diagonal;
    out.position = t.position;
    out.normal = t.normal;
    // Weights are areas of the limit surface, the same for every scheme.
    Triangles same = t;
    std::size_t const n = t.position.size();
    out.distance.assign(n, 0);
    out.angle.assign(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        std::uint32_t const at = samples.partner[i];
        if (at == kNoPartner) continue;
        same.position[i] = limit.positions()[at];
        out.distance[i] = glm::length(t.position[i] - same.position[i]) / diagonal;
        out.angle[i] = angle(t.normal[i], limit.normals()[at]);
    }
    auto const paired = [&](std::uint32_t i) { return samples.partner[i] != kNoPartner; };
    for (std::size_t i = 0; i + 2 < t.index.size(); i += 3)
        if (paired(t.index[i]) && paired(t.index[i + 1]) && paired(t.index[i + 2]))
            out.triangles.insert(out.triangles.end(), {t.index[i], t.index[i + 1], t.index[i + 2]});
    same.index = out.triangles;
    same.weigh();
    out.weight = std::move(same.weight);
    for (std::size_t i = 0; i < n; ++i) out.grid_weight.push_back(out.weight[i] * samples.times[i]);
    return out;
}

} // namespace

ErrorStatistics EqualParameterErrors::statistics(std::vector<double> const& values,
                                                 std::vector<double> const& weights)
{
    Accumulator a;
    for (std::size_t i = 0; i < weights.size(); ++i)
        if (weights[i] > 0) a.add(values[i], weights[i]);
    return a.result();
}

double quantile(std::vector<double> const& values, std::vector<double> const& weights, double share)
{
    std::vector<std::size_t> order;
    double all = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (weights[i] > 0) order.push_back(i), all += weights[i];
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return values[a] != values[b] ? values[a] < values[b] : a < b;
    });
    double sum = 0;
    for (std::size_t i : order)
        if ((sum += weights[i]) >= share * all) return values[i];
    return order.empty() ? 0 : values[order.back()];
}

namespace {

// The refinement of a comparison, which may be more than a machine holds.
void check_level(RefinedMesh const& mesh, int level)
{
    constexpr std::uint64_t kMostFaces = std::uint64_t(1) << 25;
    if (level > 6) throw LimitError("comparison level", std::uint64_t(level), 6);
    std::uint64_t faces = 0;
    for (std::size_t f = 0; f < mesh.mesh().faces(); ++f)
        faces += std::uint64_t(mesh.step().children(mesh.mesh().face(f).size()));
    faces <<= 2 * std::max(0, level - 1);
    std::string const what = mesh.step().keeps_triangles ? "triangles" : "quads";
    if (faces > kMostFaces)
        throw LimitError(what + " of the limit surface at level " + std::to_string(level), faces,
                         kMostFaces);
}

// By the rules of the scheme.
LimitSurface limit_of(RefinedMesh const& mesh, int level)
{
    check_level(mesh, level);
    return {mesh.topology(), level, {}, mesh.step()};
}

// Of the faces that are not hidden.
Triangles triangles_of(LimitSurface const& limit, RefinedMesh const& mesh)
{
    Triangles out;
    out.position = limit.positions();
    out.normal = limit.normals();
    std::vector<std::string> warnings; // the patches gave them
    std::vector<char> const hidden = hidden_faces(mesh, warnings);
    for (std::uint32_t face = 0; face < mesh.mesh().faces(); ++face) {
        if (hidden[face]) continue;
        for (std::size_t f = limit.first_face(face); f < limit.first_face(face + 1); ++f) {
            auto const corner = limit.face(f);
            for (std::size_t k = 2; k < corner.size(); ++k)
                out.index.insert(out.index.end(), {corner[0], corner[k - 1], corner[k]});
        }
    }
    out.weigh();
    return out;
}

} // namespace

EqualParameterErrors equal_parameter_errors(PatchMesh const& patches, FrameSettings settings,
                                            int level, ThreadPool const& threads)
{
    LimitSurface const limit = limit_of(patches.mesh(), level);
    return errors_of(limit, sample_scheme(limit, patches, settings, threads),
                     bounding_box_diagonal(patches.mesh().base()));
}

SurfaceComparison compare_with_limit(PatchMesh const& patches, FrameSettings settings, int level,
                                     ThreadPool const& threads)
{
    RefinedMesh const& mesh = patches.mesh();
    LimitSurface const limit = limit_of(mesh, level);
    SurfaceComparison out;
    out.diagonal = bounding_box_diagonal(mesh.base());

    Triangles const smooth = triangles_of(limit, mesh);
    SchemeSamples const samples = sample_scheme(limit, patches, settings, threads);
    Triangles scheme = samples.triangles;
    scheme.weigh();

    EqualParameterErrors const equal = errors_of(limit, samples, out.diagonal);
    out.equal_position = equal.position_statistics();
    out.equal_normal = equal.normal_statistics();
    out.equal_normal_grid = equal.normal_grid_statistics();
    compare_closest(scheme, smooth, out.diagonal, threads, out.to_limit, out.normal_to_limit);
    compare_closest(smooth, scheme, out.diagonal, threads, out.from_limit, out.normal_from_limit);
    return out;
}

struct DrawnErrors::Samples {
    Triangles limit;
    double diagonal;
};

DrawnErrors::DrawnErrors(RefinedMesh const& mesh, int level)
    : samples_(std::make_unique<Samples>(
          Samples{triangles_of(limit_of(mesh, level), mesh), bounding_box_diagonal(mesh.base())}))
{
}

DrawnErrors::~DrawnErrors() = default;

DrawnError DrawnErrors::of(PatchMesh const& patches, FrameSettings const& settings,
                           ThreadPool const& threads) const
{
    DrawnError out;
    Triangles drawn;
    out.counts = visit_surface(patches, settings, threads, [&](SurfacePatch const& p) {
        auto const first = std::uint32_t(drawn.position.size());
        for (std::size_t i = 0; i < p.points(); ++i) {
            SurfaceVertex const vertex = p.vertex(i);
            drawn.position.emplace_back(vertex.position);
            drawn.normal.emplace_back(vertex.normal);
        }
        for (std::uint32_t i : p.triangles()) drawn.index.push_back(first + i);
    });
    out.points = drawn.position.size();
    compare_closest(samples_->limit, drawn, samples_->diagonal, threads, out.position, out.normal);
    return out;
}

} // namespace tessemu
