// SPDX-License-Identifier: Apache-2.0
#include "analysis/ray_check.h"

#include "analysis/embree_scene.h"
#include "emu/error.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <string>

namespace tessemu {

namespace {

// 113 bits hold differences of floats, products of three of them and a few sums, unless exponents
// lie far apart. Where they do not, an edge's sign is rounded, but to the same value for both
// triangles: its two products only change places. So crossings of a closed mesh balance all the
// same.
#if LDBL_MANT_DIG >= 113
using Exact = long double;
#else
__extension__ typedef __float128 Exact;
#endif

struct Ray {
    glm::vec3 origin, direction, target;
    std::uint32_t aimed_at;
};

// A generator of its own for each ray, so that rays do not depend on the threads.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 0x632be59bd9b4e019u)
    {
    }
    std::uint64_t bits()
    {
        state_ += 0x9e3779b97f4a7c15u;
        std::uint64_t z = (state_ ^ (state_ >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    float unit() { return float(bits() >> 40) * 0x1p-24f; }
    std::size_t below(std::size_t n) { return std::size_t(bits() % n); }

private:
    std::uint64_t state_;
};

// From where a mesh lies to its own frame. A component is moved only where all its values are at
// least as far from 0 as they are from each other. Then they are multiples of the lowest one's last
// bit, the middle too, and the differences are less than 2^24 of them: exact. Elsewhere they lie
// within twice the extent from 0 as they are.
class OwnFrame {
public:
    explicit OwnFrame(std::vector<glm::vec3> const& positions)
    {
        glm::vec3 low(INFINITY), high(-INFINITY);
        for (glm::vec3 const& p : positions) low = min(low, p), high = max(high, p);
        double size = 0;
        for (int k = 0; k < 3; ++k) {
            double const extent = double(high[k]) - double(low[k]);
            size = std::max(size, extent);
            double const away = low[k] > 0 ? low[k] : -high[k];
            if (extent <= away) middle_[k] = float((double(low[k]) + double(high[k])) / 2);
        }
        if (size > 0 && size < INFINITY) exponent_ = std::ilogb(size);
    }
    glm::vec3 into(glm::vec3 p) const
    {
        glm::vec3 out;
        for (int k = 0; k < 3; ++k)
            out[k] = float(std::scalbn(double(p[k]) - middle_[k], -exponent_));
        return out;
    }
    std::vector<glm::vec3> into(std::vector<glm::vec3> points) const
    {
        for (glm::vec3& p : points) p = into(p);
        return points;
    }
    glm::vec3 out_of(glm::vec3 p) const
    {
        glm::vec3 out;
        for (int k = 0; k < 3; ++k)
            out[k] = float(std::scalbn(double(p[k]), exponent_) + middle_[k]);
        return out;
    }

private:
    glm::dvec3 middle_{0};
    int exponent_ = 0;
};

RTCRayHit ray_hit(glm::vec3 origin, glm::vec3 direction)
{
    RTCRayHit hit{};
    hit.ray.org_x = origin.x, hit.ray.org_y = origin.y, hit.ray.org_z = origin.z;
    hit.ray.dir_x = direction.x, hit.ray.dir_y = direction.y, hit.ray.dir_z = direction.z;
    hit.ray.tnear = 0;
    hit.ray.tfar = INFINITY;
    hit.ray.mask = 0xffffffffu;
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return hit;
}

class Scene {
public:
    Scene(std::vector<glm::vec3> const& positions, std::vector<std::uint32_t> const& triangles)
        : scene_(std::span(positions), std::span(triangles), RTC_SCENE_FLAG_ROBUST)
    {
    }

    /// True if the ray meets a front first.
    bool meets_front(Ray const& r) const
    {
        RTCRayHit const hit = trace(r.origin, r.direction);
        return hit.hit.geomID != RTC_INVALID_GEOMETRY_ID &&
               dot(glm::vec3(hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z), r.direction) < 0;
    }

    /// The first triangle, and how far it is; -1 for none.
    std::pair<std::int64_t, float> first_hit(glm::vec3 origin, glm::vec3 direction) const
    {
        RTCRayHit const hit = trace(origin, direction);
        if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {-1, INFINITY};
        return {std::int64_t(hit.hit.primID), hit.ray.tfar};
    }

private:
    RTCRayHit trace(glm::vec3 origin, glm::vec3 direction) const
    {
        RTCRayHit hit = ray_hit(origin, direction);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene_.get(), &context, &hit);
        return hit;
    }

    EmbreeScene scene_;
};

struct Exact3 {
    Exact x, y, z;
};
Exact3 difference(glm::vec3 a, glm::vec3 b)
{
    return {Exact(a.x) - Exact(b.x), Exact(a.y) - Exact(b.y), Exact(a.z) - Exact(b.z)};
}
Exact3 cross3(Exact3 const& a, Exact3 const& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Exact dot3(Exact3 const& a, Exact3 const& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

struct Crossings {
    int first = 0;   // 1 front, -1 back, 0 none
    int balance = 0; // fronts less backs
};

// On which side of an edge from b to c a ray passes: the sign of u = d . ((b - o) x (c - o)). Where
// it runs exactly through the edge, or through a vertex, it is thought moved by (e, e^2, e^3) for
// an e as small as need be, and passes beside it: u changes by e (d x (c - b)).x and so on. All
// triangles see the same moved ray, so that its crossings balance at vertices too.
bool is_negative(Exact u, Exact3 const& d, glm::vec3 b, glm::vec3 c)
{
    if (u != 0) return u < 0;
    Exact3 const change = cross3(d, difference(c, b));
    return change.x != 0 ? change.x < 0 : change.y != 0 ? change.y < 0 : change.z < 0;
}

// \param candidates  triangles, ascending: all that the ray may meet
Crossings cross_exactly(std::vector<glm::vec3> const& positions,
                        std::vector<std::uint32_t> const& triangles,
                        std::vector<std::uint32_t> const& candidates, Ray const& r)
{
    Exact3 const direction{Exact(r.direction.x), Exact(r.direction.y), Exact(r.direction.z)};
    Crossings out;
    Exact best_numerator = 0, best_denominator = 1;
    for (std::uint32_t const triangle : candidates) {
        std::uint32_t const* const corner = triangles.data() + 3 * std::size_t(triangle);
        glm::vec3 const a = positions[corner[0]], b = positions[corner[1]],
                        c = positions[corner[2]];
        Exact3 const A = difference(a, r.origin), B = difference(b, r.origin),
                     C = difference(c, r.origin);
        Exact const u = dot3(direction, cross3(B, C)), v = dot3(direction, cross3(C, A)),
                    w = dot3(direction, cross3(A, B));
        bool const nu = is_negative(u, direction, b, c), nv = is_negative(v, direction, c, a),
                   nw = is_negative(w, direction, a, b);
        bool const front = nu && nv && nw, back = !nu && !nv && !nw;
        Exact const volume = u + v + w; // 0: seen edge on
        if ((!front && !back) || volume == 0) continue;
        // Distance along the ray: A . ((B-A) x (C-A)) / volume.
        Exact const numerator = dot3(A, cross3(difference(b, a), difference(c, a)));
        bool const ahead = (numerator > 0) == (volume > 0);
        if (!ahead) continue;
        Exact const n = volume > 0 ? numerator : -numerator, m = volume > 0 ? volume : -volume;
        out.balance += front ? 1 : -1;
        if (out.first == 0 || n * best_denominator < best_numerator * m) {
            out.first = front ? 1 : -1;
            best_numerator = n;
            best_denominator = m;
        }
    }
    return out;
}

// A tree of boxes around triangles, which says what a ray may meet: nothing that it does meet is left
// out. A ray that meets a triangle passes through its box. Where it meets the planes of one Embree
// says in single precision, off by a few roundings of the distance from the ray's origin, which in the
// mesh's own frame is below 16: by less than 2^-18. So boxes are widened, by more.
class RayCandidates {
public:
    RayCandidates(std::vector<glm::vec3> const& positions,
                  std::vector<std::uint32_t> const& triangles)
        : positions_(positions),
          triangles_(triangles),
          scene_(triangles.size() / 3, this, add_bounds, add_candidate)
    {
    }

    /// \param out  ascending
    void of(Ray const& r, std::vector<std::uint32_t>& out) const
    {
        out.clear();
        Query query{{}, &out};
        rtcInitIntersectContext(&query.context);
        RTCRayHit hit = ray_hit(r.origin, r.direction);
        rtcIntersect1(scene_.get(), &query.context, &hit);
        std::sort(out.begin(), out.end());
        out.erase(std::unique(out.begin(), out.end()), out.end());
    }

private:
    struct Query {
        RTCIntersectContext context; // first: Embree hands it on
        std::vector<std::uint32_t>* found;
    };
    static void add_bounds(RTCBoundsFunctionArguments const* args)
    {
        constexpr float kWider = 0x1p-13f;
        auto const& self = *static_cast<RayCandidates const*>(args->geometryUserPtr);
        std::uint32_t const* const v = self.triangles_.data() + 3 * std::size_t(args->primID);
        glm::vec3 const &a = self.positions_[v[0]], &b = self.positions_[v[1]],
                        &c = self.positions_[v[2]];
        glm::vec3 const low = min(min(a, b), c) - kWider, high = max(max(a, b), c) + kWider;
        RTCBounds& out = *args->bounds_o;
        out.lower_x = low.x, out.lower_y = low.y, out.lower_z = low.z;
        out.upper_x = high.x, out.upper_y = high.y, out.upper_z = high.z;
    }
    // Stops no ray.
    static void add_candidate(RTCIntersectFunctionNArguments const* args)
    {
        reinterpret_cast<Query*>(args->context)->found->push_back(args->primID);
    }

    std::vector<glm::vec3> const& positions_;
    std::vector<std::uint32_t> const& triangles_;
    EmbreeScene scene_;
};

} // namespace

RayCheck check_rays(RayMesh const& mesh, RayAim aim, std::uint64_t rays, std::uint32_t seed,
                    ThreadPool const& threads)
{
    std::size_t const triangles = mesh.triangles.size() / 3;
    if (triangles == 0) throw Error("a mesh without triangles meets no rays");
    RayCheck out;
    if (aim == RayAim::Segments && mesh.targets.empty()) return out;
    OwnFrame const frame(mesh.positions);
    std::vector<glm::vec3> const positions = frame.into(mesh.positions);
    glm::vec3 low(INFINITY), high(-INFINITY);
    for (glm::vec3 const& p : positions) {
        if (!std::isfinite(p.x + p.y + p.z)) throw Error("a point of the mesh is not finite");
        low = min(low, p), high = max(high, p);
    }
    float const reach = 2 * glm::length(high - low);

    // Around a target the normal of some triangle says where outside is.
    std::vector<std::uint32_t> triangle_of(mesh.positions.size(), 0);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        triangle_of[mesh.triangles[i]] = std::uint32_t(i / 3);
    auto const corner = [&](std::size_t triangle, std::size_t k) {
        return positions[mesh.triangles[3 * triangle + k]];
    };
    auto const ray = [&](std::uint64_t i) {
        Random random((std::uint64_t(seed) << 40) + i);
        Ray r{};
        std::size_t triangle = random.below(triangles);
        if (aim == RayAim::Segments) {
            r.aimed_at = std::uint32_t(random.below(mesh.targets.size() / 2));
            std::uint32_t const a = mesh.targets[2 * r.aimed_at],
                                b = mesh.targets[2 * r.aimed_at + 1];
            float const t = 0.1f + 0.8f * random.unit(); // off the vertices
            r.target = (1 - t) * positions[a] + t * positions[b];
            triangle = triangle_of[a];
        } else {
            r.aimed_at = std::uint32_t(triangle);
            float const s = random.unit(), t = random.unit() * (1 - s);
            r.target = aim == RayAim::Vertices
                           ? corner(triangle, random.below(3))
                           : corner(triangle, 0) +
                                 (0.05f + 0.85f * s) * (corner(triangle, 1) - corner(triangle, 0)) +
                                 (0.05f + 0.85f * t) * (corner(triangle, 2) - corner(triangle, 0));
        }
        glm::vec3 const n = cross(corner(triangle, 1) - corner(triangle, 0),
                                  corner(triangle, 2) - corner(triangle, 0));
        float const length = glm::length(n);
        glm::vec3 out_of(0);
        for (int tries = 0; tries < 64; ++tries) {
            glm::vec3 const x(2 * random.unit() - 1, 2 * random.unit() - 1, 2 * random.unit() - 1);
            float const l = glm::length(x);
            if (l > 1 || l < 0.1f) continue;
            out_of = x / l;
            if (length == 0 || dot(out_of, n) >= 0.3f * length) break;
        }
        r.origin = r.target + reach * out_of;
        r.direction = r.target - r.origin;
        return r;
    };

    std::optional<Scene> scene(std::in_place, positions, mesh.triangles);
    constexpr std::uint64_t kPiece = 4096;
    struct Piece {
        std::vector<std::uint64_t> misses;
        std::uint64_t control_misses = 0;
    };
    std::vector<Piece> pieces((rays + kPiece - 1) / kPiece);
    threads.parallel_for(pieces.size(), [&](std::size_t p) {
        for (std::uint64_t i = p * kPiece; i < std::min(rays, (p + 1) * kPiece); ++i) {
            Ray const r = ray(i);
            if (!scene->meets_front(r)) pieces[p].misses.push_back(i);
        }
    });
    out.rays = rays;
    std::vector<std::uint64_t> misses;
    for (Piece const& p : pieces) misses.insert(misses.end(), p.misses.begin(), p.misses.end());
    out.misses = misses.size();
    scene.reset(); // one tree in memory at a time
    if (!misses.empty() && !mesh.control.empty()) {
        Scene const control(frame.into(mesh.control), mesh.triangles);
        threads.parallel_for(pieces.size(), [&](std::size_t p) {
            for (std::uint64_t i = p * kPiece; i < std::min(rays, (p + 1) * kPiece); ++i)
                pieces[p].control_misses += !control.meets_front(ray(i));
        });
        for (Piece const& p : pieces) out.control_misses += p.control_misses;
    }
    if (misses.empty()) return out;
    RayCandidates const tree(positions, mesh.triangles);
    std::vector<Crossings> exact(misses.size());
    threads.parallel_for(misses.size(), [&](std::size_t k) {
        Ray const r = ray(misses[k]);
        std::vector<std::uint32_t> candidates;
        tree.of(r, candidates);
        exact[k] = cross_exactly(positions, mesh.triangles, candidates, r);
    });
    for (std::size_t k = 0; k < misses.size(); ++k) {
        if (exact[k].balance == 0) {
            int const first = exact[k].first;
            ++(first > 0 ? out.refuted : first < 0 ? out.folds : out.past);
            continue;
        }
        Ray const r = ray(misses[k]);
        out.confirmed.push_back({frame.out_of(r.target), r.aimed_at});
    }
    return out;
}

namespace {

// How the picture sees a mesh.
struct Sight {
    double nearest = INFINITY, farthest = -INFINITY; ///< along the view
    double depth_error = 0;                          ///< of the transform, at `nearest`, relative
    double error_px = 0;                             ///< the same across, in pixels
};

// x/w with |x| <= w is off by the errors of both, over w.
Sight sight_of(std::vector<glm::vec3> const& positions, Camera const& camera, int width, int height)
{
    Sight out;
    glm::dvec3 size(0);
    glm::dvec3 const eye(camera.eye), backward(camera.backward());
    for (glm::vec3 const& p : positions) {
        size = max(size, abs(glm::dvec3(p)));
        double const away = dot(eye - glm::dvec3(p), backward);
        out.nearest = std::min(out.nearest, away);
        out.farthest = std::max(out.farthest, away);
    }
    double const aspect = double(width) / height,
                 w = clip_rounding(camera.backward(), camera.eye, size),
                 x = camera.focal / aspect * clip_rounding(camera.right(), camera.eye, size),
                 y = camera.focal * clip_rounding(camera.true_up(), camera.eye, size);
    out.depth_error = w / out.nearest;
    out.error_px = std::max((x + w) * width, (y + w) * height) / (2 * out.nearest);
    return out;
}

} // namespace

// A row's constant is a dot product with the eye times a scale, four roundings; a clip coordinate
// has a product and three sums more.
double clip_rounding(glm::vec3 axis, glm::vec3 eye, glm::dvec3 size)
{
    return 8 * 0x1p-24 * dot(abs(glm::dvec3(axis)), size + abs(glm::dvec3(eye)));
}

namespace {

// How many times `d` it is from the eye to a triangle, whose border belongs to it; -1: past it.
double distance_to(glm::dvec3 eye, glm::dvec3 d, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c)
{
    glm::dvec3 const ab = b - a, ac = c - a, to = eye - a, n = cross(ab, ac), m = cross(to, d);
    double const across = -dot(d, n); // twice the triangle's area, as the ray sees it
    if (across == 0) return -1;
    double const u = dot(ac, m) / across, v = -dot(ab, m) / across;
    // Not exact: a hit beside the border by rounding counts, which only explains a pixel.
    constexpr double kBorder = 0x1p-30;
    if (u < -kBorder || v < -kBorder || u + v > 1 + kBorder) return -1;
    return dot(to, n) / across;
}

} // namespace

VisibilityCheck check_visibility(RayMesh const& mesh,
                                 std::vector<std::uint32_t> const& face_of_triangle,
                                 std::vector<std::int64_t> const& seen, Camera const& camera,
                                 int width, int height, ThreadPool const& threads)
{
    VisibilityCheck all;
    Sight const sight = sight_of(mesh.positions, camera, width, height);
    if (!(sight.nearest >= camera.near_plane && sight.farthest <= camera.far_plane))
        all.skipped = "the near or far plane cuts the surface, or it lies behind the eye";
    else if (!(sight.error_px <= 0.5))
        all.skipped = "so far from the origin single precision places points to " +
                      std::to_string(sight.error_px) + " pixels";
    if (!all.skipped.empty()) return all;
    // The raster rounds vertices to 1/256 pixel.
    float const around = 1.0f / 64 + float(sight.error_px),
                as_far = 1.0001f + 2 * float(sight.depth_error);
    OwnFrame const frame(mesh.positions);
    std::vector<glm::vec3> const positions = frame.into(mesh.positions);
    Scene const scene(positions, mesh.triangles);
    glm::vec3 const eye = frame.into(camera.eye);
    float const aspect = float(width) / float(height);
    glm::vec3 const right = camera.right() * (aspect / camera.focal),
                    up = camera.true_up() / camera.focal, forward = -camera.backward();
    auto const direction = [&](float x, float y) {
        return forward + (2 * x / float(width) - 1) * right + (1 - 2 * y / float(height)) * up;
    };
    auto const face_at = [&](glm::vec3 d) -> std::int64_t {
        std::int64_t const t = scene.first_hit(eye, d).first;
        return t < 0 ? -1 : std::int64_t(face_of_triangle[std::size_t(t)]);
    };
    // Triangles in the order of their faces.
    std::vector<std::uint32_t> by_face(face_of_triangle.size());
    std::iota(by_face.begin(), by_face.end(), 0u);
    std::stable_sort(by_face.begin(), by_face.end(), [&](std::uint32_t a, std::uint32_t b) {
        return face_of_triangle[a] < face_of_triangle[b];
    });
    // Has the face a point there that is as far away as the first hit? Sheets may lie on each other,
    // so all its triangles are asked.
    auto const is_as_far = [&](glm::vec3 d, std::int64_t face) {
        float const first = scene.first_hit(eye, d).second;
        if (!std::isfinite(first)) return false;
        auto const less = [&](std::uint32_t t, std::int64_t f) {
            return std::int64_t(face_of_triangle[t]) < f;
        };
        auto t = std::lower_bound(by_face.begin(), by_face.end(), face, less);
        for (; t != by_face.end() && std::int64_t(face_of_triangle[*t]) == face; ++t) {
            std::uint32_t const* const v = mesh.triangles.data() + 3 * std::size_t(*t);
            double const at =
                distance_to(eye, d, positions[v[0]], positions[v[1]], positions[v[2]]);
            if (at >= 0 && at <= double(first) * double(as_far)) return true;
        }
        return false;
    };
    std::vector<VisibilityCheck> rows(static_cast<std::size_t>(height));
    threads.parallel_for(rows.size(), [&](std::size_t row) {
        VisibilityCheck& out = rows[row];
        float const y = float(row) + 0.5f;
        for (int i = 0; i < width; ++i) {
            float const x = float(i) + 0.5f;
            std::int64_t const raster = seen[row * std::size_t(width) + std::size_t(i)];
            std::int64_t const ray = face_at(direction(x, y));
            if (raster < 0 && ray < 0) continue;
            ++out.pixels;
            if (raster == ray) continue;
            auto const anywhere_around = [&](auto const& holds) {
                constexpr int kAround = 8; // steps to each side
                for (int k = -kAround; k <= kAround; ++k)
                    for (int l = -kAround; l <= kAround; ++l)
                        if (holds(direction(x + around * float(l) / kAround,
                                            y + around * float(k) / kAround)))
                            return true;
                return false;
            };
            auto const as_far_as = [&](glm::vec3 d) { return is_as_far(d, raster); };
            if (anywhere_around([&](glm::vec3 d) { return face_at(d) == raster; }))
                ++(raster < 0 || ray < 0 ? out.silhouettes : out.edges);
            else if (raster >= 0 && anywhere_around(as_far_as))
                ++out.depths;
            else
                out.unexplained.push_back({i, int(row)});
        }
    });
    for (VisibilityCheck const& r : rows) {
        all.pixels += r.pixels, all.edges += r.edges, all.silhouettes += r.silhouettes;
        all.depths += r.depths;
        all.unexplained.insert(all.unexplained.end(), r.unexplained.begin(), r.unexplained.end());
    }
    return all;
}

} // namespace tessemu
