// SPDX-License-Identifier: Apache-2.0
#include "pipeline/commands/displacement.h"

#include <algorithm>
#include <cmath>

namespace tessemu {

namespace {

// [face corner][4][2], see OwnedCoordinates.
std::vector<float> owned_corners(Topology const& topology)
{
    ControlMesh const& mesh = topology.mesh();
    std::vector<float> out(mesh.face_vertices.size() * OwnedCoordinates::kFloats);
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        auto const n = std::uint32_t(mesh.face(f).size());
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
            float* at = out.data() + std::size_t(h) * OwnedCoordinates::kFloats;
            for (HalfEdge from : {h, first, last, corner}) {
                glm::vec2 const c = mesh.coordinates[mesh.face_coordinates[from]];
                *at++ = c.x;
                *at++ = c.y;
            }
        }
    }
    return out;
}

// The quads that a split makes of faces that are none, [face corner][4] corners more; see
// OwnedCoordinates for the four pairs.
void add_split_corners(Topology const& topology, std::vector<float>& corners,
                       std::vector<std::uint32_t>& start)
{
    ControlMesh const& mesh = topology.mesh();
    auto const whole = [&](HalfEdge h, int pair) { // of a face's corner, as it stands
        float const* const at = corners.data() + std::size_t(h) * OwnedCoordinates::kFloats;
        return glm::vec2(at[2 * pair], at[2 * pair + 1]);
    };
    std::vector<float> more;
    start.assign(mesh.faces(), 0);
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        auto const n = std::uint32_t(mesh.face(f).size());
        if (n == 4) continue;
        start[f] = std::uint32_t((corners.size() + more.size()) / OwnedCoordinates::kFloats);
        HalfEdge const first = mesh.face_start[f];
        glm::vec2 center(0);
        for (HalfEdge h = first; h < first + n; ++h) center += whole(h, 0);
        center /= float(n);
        for (std::uint32_t k = 0; k < n; ++k) {
            HalfEdge const h = first + k, next = first + (k + 1) % n,
                           before = first + (k + n - 1) % n;
            glm::vec2 const middle = (whole(h, 0) + whole(next, 0)) / 2.0f,
                            middle_before = (whole(before, 0) + whole(h, 0)) / 2.0f;
            // In the middle of an edge its owner's coordinates, as the shader has them at 1/2.
            auto const owned_middle = [&](HalfEdge e) {
                return 0.5f * whole(e, 1) + 0.5f * whole(e, 2);
            };
            for (glm::vec2 c :
                 {whole(h, 0), whole(h, 1), whole(h, 2), whole(h, 3), //
                  middle, middle, center, owned_middle(h),            //
                  center, middle_before, center, center,              //
                  middle_before, whole(before, 1), whole(before, 2), owned_middle(before)}) {
                more.push_back(c.x);
                more.push_back(c.y);
            }
        }
    }
    corners.insert(corners.end(), more.begin(), more.end());
}

std::vector<std::uint32_t> patch_words(ControlMesh const& mesh, Displacement const& displacement,
                                       std::span<PatchPlace const> patches)
{
    using C = OwnedCoordinates;
    std::vector<std::uint32_t> words;
    words.reserve(2 * patches.size());
    for (PatchPlace const& p : patches) {
        auto const face = mesh.face(p.face);
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
        word |= std::uint32_t(p.level) << C::kLevel;
        word |= (std::uint32_t(p.i) + (std::uint32_t(p.j) << p.level)) << C::kCell;
        words.insert(words.end(), {displacement.first_corner(mesh, p), word});
    }
    return words;
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

Displacement::Displacement(Topology const& topology, HeightImage const& image, float scale)
    : scale_(scale),
      width_(image.width),
      height_(image.height)
{
    if (topology.mesh().face_coordinates.empty())
        throw Error("the mesh has no texture coordinates for a height map; the built-in pattern "
                    "needs none");
    texels_.reserve(4 * image.heights.size());
    float highest = 1;
    for (float h : image.heights) {
        texels_.insert(texels_.end(), {h, h, h, 1});
        highest = std::max(highest, std::abs(h));
    }
    reach_ = highest * std::abs(scale);
    corners_ = owned_corners(topology);
    add_split_corners(topology, corners_, split_start_);
}

std::uint32_t Displacement::first_corner(ControlMesh const& mesh, PatchPlace const& p) const
{
    return p.corner == PatchPlace::kWhole ? mesh.face_start[p.face]
                                          : split_start_[p.face] + 4u * p.corner;
}

HeightMap Displacement::height_map() const
{
    HeightMap map;
    map.frequency = frequency_;
    if (!texels_.empty())
        map.image = Texture2D(texels_, width_, height_, HeightMap::kImageSlot, "height_map");
    return map;
}

PatchEpilog make_patch_epilog(ControlMesh const& mesh, std::span<PatchPlace const> patches,
                              SurfaceSettings const& settings)
{
    std::shared_ptr<Displacement const> const& displacement = settings.displacement;
    if (!displacement)
        return {bind_domain_epilog(ProjectionEpilog{settings.view_projection}, settings.machine),
                {}};
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
        memory->words = patch_words(mesh, *displacement, patches);
        epilog.coordinates.sides = patches[0].sides;
        epilog.coordinates.corners = {displacement->corners(), kEpilogSlot + 1,
                                      "texture_coordinates"};
        epilog.coordinates.patches = {memory->words, kEpilogSlot + 2, "patch_corners"};
    }
    return {bind_domain_epilog(epilog, settings.machine), memory};
}

} // namespace tessemu
