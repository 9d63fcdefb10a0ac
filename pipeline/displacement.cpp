// SPDX-License-Identifier: Apache-2.0
#include "pipeline/displacement.h"

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

std::vector<std::uint32_t> patch_words(ControlMesh const& mesh,
                                       std::span<PatchOrigin const> patches)
{
    std::vector<std::uint32_t> words;
    words.reserve(2 * patches.size());
    for (PatchOrigin const& p : patches) {
        auto const face = mesh.face(p.face);
        std::uint32_t word = p.rotation;
        for (unsigned k = 0; k < p.sides; ++k)
            if (face[(k + p.rotation) % p.sides] > face[(k + 1 + p.rotation) % p.sides])
                word |= 4u << k;
        words.insert(words.end(), {mesh.face_start[p.face], word});
    }
    return words;
}

} // namespace

Displacement Displacement::studs(float period, float scale)
{
    if (!(period > 0)) throw Error("the period of the studs is not above 0");
    Displacement d;
    d.scale_ = scale;
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
    for (float h : image.heights) texels_.insert(texels_.end(), {h, h, h, 1});
    corners_ = owned_corners(topology);
}

HeightMap Displacement::height_map() const
{
    HeightMap map;
    map.frequency = frequency_;
    if (!texels_.empty())
        map.image = Texture2D(texels_, width_, height_, HeightMap::kImageSlot, "height_map");
    return map;
}

PatchEpilog make_patch_epilog(ControlMesh const& mesh, std::span<PatchOrigin const> patches,
                              VertexFinish const& finish,
                              std::shared_ptr<Displacement const> const& displacement,
                              Machine const& machine)
{
    if (!displacement) return {make_domain_epilog(ProjectionEpilog{finish}, machine), {}};
    struct Memory {
        std::shared_ptr<Displacement const> displacement;
        std::vector<std::uint32_t> words;
    };
    auto memory = std::make_shared<Memory>(Memory{displacement, {}});
    DisplacementEpilog epilog;
    epilog.height = displacement->height_map();
    epilog.scale = displacement->scale();
    epilog.finish = finish;
    if (!displacement->corners().empty() && !patches.empty()) {
        memory->words = patch_words(mesh, patches);
        epilog.coordinates.sides = patches[0].sides;
        epilog.coordinates.corners = {displacement->corners(), 6, "texture_coordinates"};
        epilog.coordinates.patches = {memory->words, 7, "patch_corners"};
    }
    return {make_domain_epilog(epilog, machine), memory};
}

} // namespace tessemu
