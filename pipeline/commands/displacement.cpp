// SPDX-License-Identifier: Apache-2.0
#include "pipeline/commands/displacement.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tessemu {

namespace {

using C = OwnedCoordinates;

// Texture coordinates as places in an image: in texels from the first one's centre, rows from the
// top.
class TexelFrame {
public:
    TexelFrame(HeightImage const& image, HeightWrap wrap)
        : size_(image.width, image.height),
          period_(wrap == HeightWrap::Mirror ? 2.0 * size_ : size_),
          repeats_(wrap != HeightWrap::Clamp)
    {
    }
    glm::dvec2 place(glm::dvec2 c) const { return glm::dvec2(c.x, 1 - c.y) * size_ - 0.5; }
    /// The whole number that stands before a place and its neighbours' parts.
    glm::dvec2 whole(glm::dvec2 place) const { return floor(place); }
    /// The same within the period, so that a single holds it.
    glm::vec2 stored(glm::dvec2 whole) const
    {
        return glm::vec2(repeats_ ? whole - period_ * floor(whole / period_) : whole);
    }

private:
    glm::dvec2 size_, period_;
    bool repeats_;
};

// A corner's record, see OwnedCoordinates.
struct CornerRecord {
    glm::vec2 own, first, last, vertex; // parts
    glm::vec2 face_whole, edge_whole, vertex_whole;
};
static_assert(sizeof(CornerRecord) == C::kFloats * sizeof(float));

std::vector<CornerRecord> owned_corners(Topology const& topology, TexelFrame const& frame)
{
    ControlMesh const& mesh = topology.mesh();
    std::vector<CornerRecord> out(mesh.face_vertices.size());
    auto const place = [&](HalfEdge h) {
        return frame.place(mesh.coordinates[mesh.face_coordinates[h]]);
    };
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        auto const n = std::uint32_t(mesh.face(f).size());
        glm::dvec2 const whole = frame.whole(place(mesh.face_start[f]));
        for (std::uint32_t i = 0; i < n; ++i) {
            HalfEdge const h = mesh.face_start[f] + i, end = mesh.face_start[f] + (i + 1) % n;
            // The edge as its owner has it: first and last corner in canonical direction.
            HalfEdge first = h, last = end;
            if (HalfEdge const twin = topology.twin(h);
                twin != Topology::kNone && topology.face_of(twin) < f)
                first = topology.next(twin), last = twin;
            if (topology.vertex_of(h) > topology.vertex_of(end)) std::swap(first, last);
            HalfEdge corner = h;
            for (HalfEdge other : topology.ring(topology.vertex_of(h)))
                if (topology.face_of(other) < topology.face_of(corner)) corner = other;
            glm::dvec2 const on_edge = frame.whole(place(first)),
                             at_vertex = frame.whole(place(corner));
            out[h] = {glm::vec2(place(h) - whole),
                      glm::vec2(place(first) - on_edge),
                      glm::vec2(place(last) - on_edge),
                      glm::vec2(place(corner) - at_vertex),
                      frame.stored(whole),
                      frame.stored(on_edge),
                      frame.stored(at_vertex)};
        }
    }
    return out;
}

// The quads that a split makes of faces that are none, [face corner][4] corners more.
void add_split_corners(Topology const& topology, std::vector<CornerRecord>& corners,
                       std::vector<std::uint32_t>& start)
{
    ControlMesh const& mesh = topology.mesh();
    start.assign(mesh.faces(), 0);
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        auto const n = std::uint32_t(mesh.face(f).size());
        if (n == 4) continue;
        start[f] = std::uint32_t(corners.size());
        HalfEdge const first = mesh.face_start[f];
        glm::vec2 center(0);
        for (HalfEdge h = first; h < first + n; ++h) center += corners[h].own;
        center /= float(n);
        for (std::uint32_t k = 0; k < n; ++k) {
            CornerRecord const at = corners[first + k], next = corners[first + (k + 1) % n],
                               before = corners[first + (k + n - 1) % n];
            glm::vec2 const whole = at.face_whole, middle = (at.own + next.own) / 2.0f,
                            middle_before = (before.own + at.own) / 2.0f;
            // In the middle of an edge its owner's coordinates, as the shader has them at 1/2.
            auto const owned_middle = [](CornerRecord const& e) {
                return 0.5f * e.first + 0.5f * e.last;
            };
            corners.push_back(at);
            corners.push_back(
                {middle, middle, center, owned_middle(at), whole, whole, at.edge_whole});
            corners.push_back({center, middle_before, center, center, whole, whole, whole});
            corners.push_back({middle_before, before.first, before.last, owned_middle(before),
                               whole, before.edge_whole, before.edge_whole});
        }
    }
}

// A whole number as the number of a texel, as HeightMap has it.
int texel_number(double x, int size, HeightWrap wrap)
{
    double const period = wrap == HeightWrap::Mirror ? 2.0 * size : size;
    if (wrap != HeightWrap::Clamp) x -= period * std::floor(x / period);
    if (wrap == HeightWrap::Mirror) x = std::min(x, period - 1 - x);
    return int(std::clamp(x, 0.0, size - 1.0));
}

} // namespace

Displacement Displacement::studs(float period, float scale)
{
    if (!(period > 0)) throw Error("the period of the studs is not above 0");
    Displacement d;
    d.scale_ = scale;
    d.reach_ = std::abs(scale);
    d.frequency_ = 1 / period;
    return d;
}

Displacement::Displacement(std::shared_ptr<RefinedMesh const> mesh, HeightImage image, float scale,
                           HeightWrap wrap)
    : scale_(scale),
      image_(std::move(image)),
      wrap_(wrap),
      mesh_(std::move(mesh))
{
    if (mesh_->base().face_coordinates.empty())
        throw Error("the mesh has no texture coordinates for a height map; the built-in pattern "
                    "needs none");
    float highest = 1;
    for (float h : image_.heights) highest = std::max(highest, std::abs(h));
    reach_ = highest * std::abs(scale);
    if (mesh_->base().rules.smooth_coordinates && mesh_->steps() > 0) faces_.emplace(*mesh_);
    std::vector<CornerRecord> corners =
        owned_corners(coordinate_topology(), TexelFrame(image_, wrap));
    add_split_corners(coordinate_topology(), corners, split_start_);
    corners_.resize(corners.size() * C::kFloats);
    std::memcpy(corners_.data(), corners.data(), corners_.size() * sizeof(float));
}

PatchPlace Displacement::on_coordinates(PatchPlace const& place) const
{
    if (!is_smooth()) return place;
    auto const [face, turns] = (*faces_)(place);
    PatchPlace out;
    out.face = face;
    out.sides = place.sides;
    out.rotation = std::uint8_t(turns);
    return out;
}

std::uint32_t Displacement::first_corner(PatchPlace const& p) const
{
    return p.corner == PatchPlace::kWhole ? coordinate_topology().mesh().face_start[p.face]
                                          : split_start_[p.face] + 4u * p.corner;
}

std::array<std::uint32_t, 2> Displacement::words(PatchPlace const& place) const
{
    PatchPlace const p = on_coordinates(place);
    auto const face = coordinate_topology().mesh().face(p.face);
    auto const n = std::uint32_t(face.size());
    std::uint32_t word = p.rotation;
    if (p.corner != PatchPlace::kWhole) {
        std::uint32_t const k = p.corner;
        bool const first = face[k] > face[(k + 1) % n], last = face[(k + n - 1) % n] > face[k];
        // Spokes run from the edge's middle to the centre: edge 1 so, edge 2 against it.
        word |= C::kHalves | (first ? 1u : 0u) << C::kReversed | 4u << C::kReversed |
                (last ? 8u : 0u) << C::kReversed;
    } else {
        // Of a patch that is a part of its face the shader asks in the face's own frame.
        unsigned const turns = p.level ? 0 : p.rotation;
        for (unsigned k = 0; k < p.sides; ++k)
            if (face[(k + turns) % n] > face[(k + 1 + turns) % n])
                word |= 1u << (unsigned(C::kReversed) + k);
    }
    if (p.is_flipped) word |= C::kFlipped;
    word |= std::uint32_t(p.level) << C::kLevel;
    word |= (std::uint32_t(p.i) + (std::uint32_t(p.j) << p.level)) << C::kCell;
    return {first_corner(p), word};
}

HeightMap Displacement::height_map() const
{
    HeightMap map;
    map.frequency = frequency_;
    if (image_.heights.empty()) return map;
    map.texels = {image_.heights, HeightMap::kImageSlot, "height_map"};
    map.width = image_.width;
    map.height = image_.height;
    map.wrap = wrap_;
    return map;
}

double Displacement::slope(PatchPlace const& place, Ray const& ray) const
{
    return double(scale_) *
           (image_.heights.empty() ? studs_slope(ray) : image_slope(on_coordinates(place), ray));
}

double Displacement::image_slope(PatchPlace const& place, Ray const& ray) const
{
    // Where the point lies in the patch's unit, and what the step adds to that.
    auto const in_unit = [&](float u, float v) {
        UnitPoint const p = domain_to_unit(place, u, v);
        return glm::dvec2(p.u, p.v);
    };
    glm::dvec2 const origin = in_unit(0, 0), along_u = in_unit(1, 0) - origin,
                     along_v = in_unit(0, 1) - origin;
    glm::dvec2 const at = origin + ray.domain.x * along_u + ray.domain.y * along_v,
                     step = ray.step.x * along_u + ray.step.y * along_v;
    float const* const corner = corners_.data() + std::size_t(first_corner(place)) * C::kFloats;
    auto const own = [&](int i) {
        float const* const c = corner + i * C::kFloats;
        return glm::dvec2(c[0], c[1]);
    };
    glm::dvec2 texel(corner[2 * C::kPairs], corner[2 * C::kPairs + 1]), way;
    if (place.sides == 3) {
        texel += at.x * own(0) + at.y * own(1) + (1 - at.x - at.y) * own(2);
        way = step.x * (own(0) - own(2)) + step.y * (own(1) - own(2));
    } else {
        glm::dvec2 const bottom = own(1) - own(0), top = own(2) - own(3), left = own(3) - own(0),
                         right = own(2) - own(1);
        texel += own(0) + at.x * bottom + at.y * (left + at.x * (top - bottom));
        way = step.x * (bottom + at.y * (top - bottom)) + step.y * (left + at.x * (right - left));
    }
    // The four texels on the side that the way leads to.
    glm::dvec2 first = floor(texel);
    for (int k = 0; k < 2; ++k)
        if (first[k] == texel[k] && way[k] < 0) first[k] -= 1;
    glm::dvec2 const f = texel - first;
    auto const height = [&](int x, int y) {
        std::size_t const i = std::size_t(texel_number(first.x + x, image_.width, wrap_)),
                          j = std::size_t(texel_number(first.y + y, image_.height, wrap_));
        return double(image_.heights[j * std::size_t(image_.width) + i]);
    };
    double const h00 = height(0, 0), h10 = height(1, 0), h01 = height(0, 1), h11 = height(1, 1);
    return way.x * ((1 - f.y) * (h10 - h00) + f.y * (h11 - h01)) +
           way.y * ((1 - f.x) * (h01 - h00) + f.x * (h11 - h10));
}

double Displacement::studs_slope(Ray const& ray) const
{
    glm::dvec3 bump, rise; // see HeightMap
    for (int k = 0; k < 3; ++k) {
        double const scaled = double(frequency_) * ray.point[k], f = scaled - std::floor(scaled),
                     g = f * (1 - f);
        bump[k] = 16 * g * g;
        rise[k] = 32 * g * (1 - 2 * f) * double(frequency_) * ray.tangent[k];
    }
    return (rise.x * (bump.y + bump.z) + rise.y * (bump.z + bump.x) + rise.z * (bump.x + bump.y)) /
           3;
}

SurfaceEpilog make_surface_epilog(std::span<PatchPlace const> patches,
                                  SurfaceSettings const& settings)
{
    std::shared_ptr<Displacement const> const& displacement = settings.displacement;
    if (!displacement) return {ProjectionEpilog{settings.view_projection}, {}};
    struct Memory {
        std::shared_ptr<Displacement const> displacement;
        std::vector<std::uint32_t> words;
    };
    auto memory = std::make_shared<Memory>(Memory{displacement, {}});
    DisplacementEpilog epilog;
    epilog.height = displacement->height_map();
    epilog.scale = displacement->scale();
    epilog.view_projection = settings.view_projection;
    if (!displacement->corners().empty() && !patches.empty()) {
        memory->words.reserve(2 * patches.size());
        for (PatchPlace const& place : patches)
            for (std::uint32_t word : displacement->words(place)) memory->words.push_back(word);
        epilog.coordinates.sides = patches[0].sides;
        epilog.coordinates.corners = {displacement->corners(), kEpilogSlot + 1,
                                      "texture_coordinates"};
        epilog.coordinates.patches = {memory->words, kEpilogSlot + 2, "patch_corners"};
    }
    return {epilog, memory};
}

} // namespace tessemu
