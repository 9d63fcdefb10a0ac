// SPDX-License-Identifier: Apache-2.0
#include "pipeline/displaced_normals.h"

#include "shaders_cpp/domain_edges.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace tessemu {

namespace {

// A way through a patch's domain: (u, v) + x step, for x from `low` <= 0 to `high` >= 0.
struct Line {
    float du, dv, low, high;
};

// Two lines through a domain point, the second to the left of the first. Of a triangle they run
// from its nearest corner's side to the other two corners, so that both have a length.
std::array<Line, 2> lines_through(TessellatorDomain domain, float u, float v)
{
    if (domain == TessellatorDomain::Quad) return {{{1, 0, -u, 1 - u}, {0, 1, -v, 1 - v}}};
    float const weight[3] = {u, v, 1 - u - v};
    constexpr float kU[3] = {1, 0, 0}, kV[3] = {0, 1, 0};
    int const k = int(std::max_element(weight, weight + 3) - weight), a = (k + 1) % 3,
              b = (k + 2) % 3;
    return {{{kU[a] - kU[k], kV[a] - kV[k], -weight[a], weight[k]},
             {kU[b] - kU[k], kV[b] - kV[k], -weight[b], weight[k]}}};
}

// Lagrange's polynomial of a node of 0, 1, ..., degree: its value and its derivative.
double basis(int degree, int node, double t)
{
    double product = 1;
    for (int l = 0; l <= degree; ++l)
        if (l != node) product *= (t - l) / (node - l);
    return product;
}
double basis_derivative(int degree, int node, double t)
{
    double sum = 0;
    for (int m = 0; m <= degree; ++m) {
        if (m == node) continue;
        double product = 1.0 / (node - m);
        for (int l = 0; l <= degree; ++l)
            if (l != node && l != m) product *= (t - l) / (node - l);
        sum += product;
    }
    return sum;
}

// Derivatives at x = 0 of what is known at points of a line.
//
// Singles round, so the longest differences are the best: of the polynomials through 2, 3 or 5 of
// nine points along all of the line the first one that goes through the others as well. A patch
// that is none of these has five points around x = 0, a sixteenth apart. The ends are left out,
// where other normals than the inside's may hold.
class Stencil {
public:
    static constexpr int kWide = 8, kNarrow = 4, kPoints = kWide + 1 + kNarrow + 1;

    explicit Stencil(Line const& line)
        : wide_first_(line.low + kOff),
          wide_step_((line.high - line.low - 2 * kOff) / kWide),
          narrow_first_(std::clamp(-0.5f * kNarrow * kStep, line.low + kOff,
                                   line.high - kOff - kNarrow * kStep))
    {
    }
    float x(int k) const
    {
        return k <= kWide ? wide_first_ + float(k) * wide_step_
                          : narrow_first_ + float(k - kWide - 1) * kStep;
    }
    using Values = std::array<glm::dvec3, kPoints>;
    /// \param error  of a component that is not worth a higher degree
    glm::dvec3 derivative(Values const& values, double error) const
    {
        for (int degree : {1, 2, 4}) {
            int const apart = kWide / degree;
            bool fits = true;
            for (int k = 0; k <= kWide && fits; ++k) {
                glm::dvec3 off = -values[std::size_t(k)];
                for (int i = 0; i <= degree; ++i)
                    off += basis(degree, i, double(k) / apart) * values[std::size_t(i * apart)];
                fits = k % apart == 0 || glm::dot(off, off) <= error * error;
            }
            if (fits) return difference(values.data(), degree, apart, wide_first_, wide_step_);
        }
        return difference(values.data() + kWide + 1, kNarrow, 1, narrow_first_, kStep);
    }

private:
    static constexpr float kStep = 1.0f / 16, kOff = 1.0f / 64;

    static glm::dvec3 difference(glm::dvec3 const* values, int degree, int apart, double first,
                                 double step)
    {
        step *= apart;
        glm::dvec3 sum(0);
        for (int i = 0; i <= degree; ++i)
            sum += basis_derivative(degree, i, -first / step) * values[i * apart];
        return sum / step;
    }

    float wide_first_, wide_step_, narrow_first_;
};

glm::dvec3 as_vector(float3<float> const& v)
{
    return {v.x, v.y, v.z};
}
// A unit vector that singles have already stays as it is.
glm::dvec3 unit(glm::dvec3 const& v)
{
    double const square = glm::dot(v, v);
    return std::abs(square - 1) < 0x1p-21 ? v : v / std::sqrt(square);
}

using NamedNormal = std::pair<MeshPoint, glm::dvec3>;

bool has_smaller_name(NamedNormal const& a, NamedNormal const& b)
{
    return a.first < b.first;
}

// Of points that several patches may have, by name.
class SharedNormals {
public:
    void add(MeshPoint const& point, glm::dvec3 const& normal)
    {
        normals_.emplace_back(point, normal);
    }
    // The unit normal of each point's sum, in the order in which they were added.
    void unite()
    {
        std::stable_sort(normals_.begin(), normals_.end(), has_smaller_name);
        std::size_t kept = 0;
        for (std::size_t i = 0; i < normals_.size();) {
            glm::dvec3 sum(0);
            double count = 0;
            std::size_t j = i;
            for (; j < normals_.size() && normals_[j].first == normals_[i].first; ++j, ++count)
                sum += normals_[j].second;
            // Nothing is left where patches fold against each other: then the first one's. The
            // mean of normals in singles is known to 2^-20, its square to 1e-12.
            bool const folded = !(glm::dot(sum, sum) > 1e-12 * count * count);
            normals_[kept++] = {normals_[i].first, unit(folded ? normals_[i].second : sum / count)};
            i = j;
        }
        normals_.resize(kept);
    }
    glm::dvec3 at(MeshPoint const& point) const
    {
        auto const found = std::lower_bound(normals_.begin(), normals_.end(),
                                            NamedNormal{point, {}}, has_smaller_name);
        assert(found != normals_.end() && found->first == point);
        return found->second;
    }

private:
    std::vector<NamedNormal> normals_;
};

// What the domain programs of all draws need.
struct Setting {
    ControlMesh const& mesh;
    Displacement const& displacement;
    SharedNormals const* shared; ///< none: points on edges get what their patch has, to be united
};

MeshPoint name_of(ControlMesh const& mesh, PatchPlace const& place, float u, float v)
{
    return mesh_point(mesh, place, std::uint32_t(u * 65536), std::uint32_t(v * 65536));
}

bool is_on_edge(TessellatorDomain domain, float u, float v)
{
    DomainEdges<4, float> const at =
        domain_edges<float>(sides_of(domain), u, v, 1 - u - v, 1 - u, 1 - v);
    return at.on[0] || at.on[1] || at.on[2] || at.on[3];
}

// A domain program around a surface's: behind the epilog it replaces the normals.
class DisplacedNormalProgram final : public DomainProgram {
public:
    DisplacedNormalProgram(DomainShader surface, std::span<PatchPlace const> places,
                           Setting const& setting)
        : surface_(std::move(surface)),
          places_(places),
          s_(setting)
    {
    }
    TessellatorDomain domain() const override { return surface_->domain(); }
    int control_points() const override { return surface_->control_points(); }
    int control_point_floats() const override { return surface_->control_point_floats(); }
    int patch_constant_floats() const override { return surface_->patch_constant_floats(); }
    bool reads_tess_factors() const override { return surface_->reads_tess_factors(); }
    OutputLayout output() const override { return surface_->output(); }
    std::vector<ResourceInfo> resources(ShaderBinding const&) const override
    {
        return surface_.resources();
    }

    void run(ShaderBinding const&, DomainBatch const& b, StageCounters& counters) const override
    {
        surface_.run(b, counters);
        constexpr std::size_t kBlock = 256;
        std::vector<std::size_t> points;
        for (std::size_t i = 0; i < b.points; ++i) {
            bool const on_edge = is_on_edge(domain(), b.u[i], b.v[i]);
            if (on_edge && s_.shared) take_shared(b, i);
            if (on_edge != bool(s_.shared)) points.push_back(i);
            if (points.size() < kBlock && i + 1 < b.points) continue;
            replace_normals(b, points);
            points.clear();
        }
    }

private:
    using Point = SurfacePoint<float>;
    using Vertex = DisplacedVertex<float>;

    static void store_normal(DomainBatch const& b, std::size_t i, glm::dvec3 const& normal)
    {
        auto vertex = load_column<Vertex>(b.outputs + i, b.stride);
        vertex.normal = {float(normal.x), float(normal.y), float(normal.z)};
        float* at = b.outputs + i;
        for_each_scalar(vertex, [&](float scalar) {
            *at = scalar;
            at += b.stride;
        });
    }

    void take_shared(DomainBatch const& b, std::size_t i) const
    {
        PatchPlace const& place = places_[std::size_t(b.primitive_id)];
        store_normal(b, i, s_.shared->at(name_of(s_.mesh, place, b.u[i], b.v[i])));
    }

    void replace_normals(DomainBatch const& b, std::vector<std::size_t> const& points) const
    {
        std::size_t const all = points.size() * 2 * Stencil::kPoints, stride = (all + 15) / 16 * 16;
        std::vector<Line> lines;
        std::vector<Stencil> stencils;
        std::vector<float> u(stride), v(stride);
        for (std::size_t i : points)
            for (Line const& line : lines_through(domain(), b.u[i], b.v[i])) {
                std::size_t const at = lines.size() * Stencil::kPoints;
                lines.push_back(line);
                stencils.emplace_back(line);
                for (int k = 0; k < Stencil::kPoints; ++k) {
                    float const x = stencils.back().x(k);
                    u[at + std::size_t(k)] = b.u[i] + x * line.du;
                    v[at + std::size_t(k)] = b.v[i] + x * line.dv;
                }
            }
        std::vector<float> around(stride * std::size_t(scalar_count<Point>()));
        run_uncounted(b, u, v, all, around);
        for (std::size_t i = 0; i < points.size(); ++i) {
            Tangent tangents[2];
            for (std::size_t line : {2 * i, 2 * i + 1})
                tangents[line % 2] =
                    tangent(stencils[line], around.data() + line * Stencil::kPoints, stride);
            replace_normal(b, points[i], &lines[2 * i], tangents);
        }
    }

    void run_uncounted(DomainBatch const& b, std::vector<float> const& u,
                       std::vector<float> const& v, std::size_t points,
                       std::vector<float>& outputs) const
    {
        StageCounters unused;
        StageScope const scope(unused, StageBuffers({}), surface_.sites());
        DomainBatch other = b;
        other.u = u.data();
        other.v = v.data();
        other.points = points;
        other.outputs = outputs.data();
        other.stride = u.size();
        other.epilog = nullptr;
        surface_.run(other, unused);
    }

    struct Tangent {
        glm::dvec3 position, normal; // derivatives
        double rounding;             // below it a derivative of the position is none
    };
    static Tangent tangent(Stencil const& stencil, float const* points, std::size_t stride)
    {
        Stencil::Values positions, normals;
        double size = 0;
        for (int k = 0; k < Stencil::kPoints; ++k) {
            auto const p = load_column<Point>(points + k, stride);
            positions[std::size_t(k)] = as_vector(p.position);
            normals[std::size_t(k)] = as_vector(p.normal);
            size = std::max(size, glm::length(positions[std::size_t(k)]));
        }
        double const rounding = 0x1p-21; // a few of single precision
        return {stencil.derivative(positions, rounding * size),
                stencil.derivative(normals, rounding), 8 * rounding * size};
    }

    void replace_normal(DomainBatch const& b, std::size_t i, Line const* lines,
                        Tangent const* tangents) const
    {
        auto const vertex = load_column<Vertex>(b.outputs + i, b.stride);
        double slopes[2];
        for (int l = 0; l < 2; ++l)
            slopes[l] = slope(places_[std::size_t(b.primitive_id)], {b.u[i], b.v[i]}, lines[l],
                              as_vector(vertex.base), tangents[l].position);
        glm::dvec3 const n = normal(vertex, slopes, tangents);
        store_normal(b, i, s_.shared ? unit(n) : n);
    }

    // Of the displacement along a line: both sides' mean, at an end the inner side's.
    double slope(PatchPlace const& place, glm::dvec2 domain_point, Line const& line,
                 glm::dvec3 const& point, glm::dvec3 const& tangent) const
    {
        auto const leaving = [&](double way) {
            return way *
                   s_.displacement.slope(place, {domain_point, way * glm::dvec2(line.du, line.dv),
                                                 point, way * tangent});
        };
        if (line.low == 0) return leaving(1);
        if (line.high == 0) return leaving(-1);
        return 0.5 * leaving(1) + 0.5 * leaving(-1);
    }

    // As long as its part along the smooth surface's normal is 1.
    static glm::dvec3 normal(Vertex const& vertex, double const* slopes, Tangent const* tangents)
    {
        glm::dvec3 const n = as_vector(vertex.normal);
        glm::dvec3 const displaced(vertex.position.x, vertex.position.y, vertex.position.z);
        double const height = glm::dot(displaced - as_vector(vertex.base), n);
        glm::dvec3 const a = tangents[0].position + height * tangents[0].normal,
                         b = tangents[1].position + height * tangents[1].normal;
        auto const area_of = [&](glm::dvec3 const& x, glm::dvec3 const& y) {
            return glm::dot(n, glm::cross(x, y));
        };
        // Differences weigh points by up to 43, so two tangents as long as these may be off by
        // twice 43 2^-21 = 4e-5: nearer to parallel than that says nothing.
        auto const is_pole = [](double area, glm::dvec3 const& x, glm::dvec3 const& y) {
            return !(std::abs(area) > 1e-4 * glm::length(x) * glm::length(y));
        };
        glm::dvec3 const &s = tangents[0].position, &t = tangents[1].position;
        double const area = area_of(a, b), smooth_area = area_of(s, t);
        glm::dvec3 const turn = slopes[1] * glm::cross(a, n) + slopes[0] * glm::cross(n, b);
        double const shorter = std::min(glm::length(s), glm::length(t));
        if (shorter <= std::max(tangents[0].rounding, tangents[1].rounding) ||
            is_pole(smooth_area, s, t) || is_pole(area, a, b))
            return n;
        if (height == 0 && turn == glm::dvec3(0)) return n;
        bool const folded = (area < 0) != (smooth_area < 0); // displaced through a focal point
        return (folded ? -1.0 : 1.0) * (n + turn / area);
    }

    DomainShader surface_;
    std::span<PatchPlace const> places_;
    Setting s_;
};

class DisplacedNormals final : public PatchMesh {
public:
    DisplacedNormals(PatchMesh const& patches, SharedNormals const* shared)
        : PatchMesh(patches.shared_mesh()),
          patches_(patches),
          shared_(shared)
    {
    }
    CommandList commands(SurfaceSettings const& settings) const override
    {
        CommandList list = patches_.commands(settings);
        list.for_each_surface_draw([&](Draw& d) {
            DomainShader& shader = d.pipeline.domain_shader;
            if (!shader)
                throw Error("normals of the displaced surface are differences between any points "
                            "of a patch, and the scheme has points on a grid alone");
            shader = {
                std::make_shared<DisplacedNormalProgram>(
                    shader, d.patches, Setting{mesh().base(), *settings.displacement, shared_}),
                shader.binding()};
        });
        return list;
    }
    std::vector<PatchCount> patch_counts() const override { return patches_.patch_counts(); }
    bool has_creases() const override { return patches_.has_creases(); }

private:
    PatchMesh const& patches_;
    SharedNormals const* shared_;
};

} // namespace

ListStatistics visit_displaced_surface(PatchMesh const& mesh, FrameSettings const& given,
                                       ThreadPool const& threads, SurfaceVisitor const& visit)
{
    if (!given.displacement) throw Error("the surface is not displaced: it has no such normals");
    FrameSettings settings = given;
    settings.true_normals = true;
    SharedNormals shared;
    visit_surface(DisplacedNormals(mesh, nullptr), settings, threads, [&](SurfacePatch const& p) {
        DomainPoints const& at = p.domain();
        for (std::size_t i = 0; i < p.points(); ++i)
            if (is_on_edge(p.place().sides == 4 ? TessellatorDomain::Quad : TessellatorDomain::Tri,
                           at.u[i], at.v[i]))
                shared.add(name_of(mesh.mesh().base(), p.place(), at.u[i], at.v[i]),
                           glm::dvec3(p.vertex(i).normal));
    });
    shared.unite();
    return visit_surface(DisplacedNormals(mesh, &shared), settings, threads, visit);
}

} // namespace tessemu
