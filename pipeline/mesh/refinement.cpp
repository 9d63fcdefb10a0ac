// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/refinement.h"

#include "pipeline/mesh/refined_step.h"

#include <algorithm>
#include <cassert>
#include <tuple>

namespace tessemu {

RefinedMesh::RefinedMesh(ControlMesh mesh, int steps, RefinementStep step,
                         RefinementProgress const& progress)
    : base_(std::make_unique<ControlMesh const>(std::move(mesh))),
      base_topology_(std::make_unique<Topology const>(*base_)),
      steps_(steps),
      step_(step)
{
    static_assert(kMaxSteps <= PatchPlace::kMaxLevel);
    if (steps < 0)
        throw Error("steps of subdivision is " + std::to_string(steps) + ", it must be 0 or more");
    if (steps > kMaxSteps)
        throw LimitError("steps of subdivision", std::uint64_t(steps), kMaxSteps);
    std::uint64_t children = 0; // of the first step, four times as many with each other
    for (std::size_t f = 0; f < base_->faces(); ++f)
        children += std::uint64_t(step.children(base_->face(f).size()));
    auto const faces = [&](int n) { return n ? children << 2 * (n - 1) : base_->faces(); };
    if (int fit = steps; faces(steps) > kMostFaces) {
        while (fit > 0 && faces(fit) > kMostFaces) --fit;
        throw LimitError("faces after " + std::to_string(steps) + " steps of subdivision (" +
                             std::to_string(fit) + " would do)",
                         faces(steps), kMostFaces);
    }
    places_.reserve(base_->faces());
    for (std::uint32_t f = 0; f < base_->faces(); ++f) {
        PatchPlace p;
        p.face = f;
        p.sides = std::uint8_t(base_->face(f).size() == 3 ? 3 : 4);
        places_.push_back(p);
    }
    // A step's work goes with its faces, four times as many as the last one's: half of it before
    // the topology of what it makes.
    std::size_t done = 0, work = 1, all = 0;
    for (int s = 0; s < steps; ++s) all += std::size_t(2) << 2 * s;
    auto const tell = [&] {
        done += work;
        if (progress) progress(done, all);
    };
    for (int s = 0; s < steps; ++s, work *= 4) {
        ControlMesh const& coarse = s ? *mesh_ : *base_;
        std::uint32_t const first = s ? tables_.back().first_face_point() : 0;
        Topology const& coarse_topology = s ? *topology_ : *base_topology_;
        RefinedStep refined = step(coarse_topology, first);
        if (coarse.rules.smooth_coordinates && !coarse.face_coordinates.empty())
            smooth_coordinates(coarse_topology, step, refined.mesh);
        tell();
        auto fine = std::make_unique<ControlMesh const>(std::move(refined.mesh));
        tables_.push_back(std::move(refined.tables));
        std::vector<PatchPlace> places;
        places.reserve(fine->faces());
        for (std::uint32_t f = 0; f < coarse.faces(); ++f) {
            int const sides = int(coarse.face(f).size()), count = step.children(std::size_t(sides));
            for (int k = 0; k < count; ++k)
                places.push_back(count > sides ? split_triangle(places_[f], k)
                                               : split(places_[f], sides, k));
        }
        places_ = std::move(places);
        topology_.reset(); // reads mesh_
        mesh_ = std::move(fine);
        topology_ = std::make_unique<Topology const>(*mesh_);
        tell();
    }
}

std::string RefinedMesh::vertex_in_words(std::uint32_t v) const
{
    // Vertex points are a step's last, in the order of the vertices.
    std::uint32_t old = v;
    auto step = tables_.rbegin();
    for (; step != tables_.rend() && old >= step->faces + step->edges; ++step)
        old -= step->faces + step->edges;
    if (step == tables_.rend()) return "vertex " + std::to_string(base_->file_vertex(old) + 1);
    std::uint32_t const face = topology().face_of(topology().ring(v)[0]);
    return "the middle of face " + std::to_string(base_->file_face(place(face).face) + 1);
}

namespace {

auto by_place(PatchPlace const& p)
{
    return std::tuple(p.face, p.corner, p.level, p.i, p.j, p.is_flipped);
}

} // namespace

FacesByPlace::FacesByPlace(RefinedMesh const& mesh)
{
    for (std::uint32_t f = 0; f < mesh.mesh().faces(); ++f) faces_.emplace_back(mesh.place(f), f);
    std::sort(faces_.begin(), faces_.end(),
              [](auto const& a, auto const& b) { return by_place(a.first) < by_place(b.first); });
}

FacesByPlace::Found FacesByPlace::operator()(PatchPlace const& place) const
{
    auto const found = std::lower_bound(
        faces_.begin(), faces_.end(), place,
        [](auto const& face, PatchPlace const& p) { return by_place(face.first) < by_place(p); });
    assert(found != faces_.end() && by_place(found->first) == by_place(place));
    int const turns = place.rotation - found->first.rotation, sides = place.sides;
    return {found->second, (turns + sides) % sides};
}

} // namespace tessemu
