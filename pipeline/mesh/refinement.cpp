// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/refinement.h"

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
        RefinedStep refined = step(s ? *topology_ : *base_topology_, first);
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

} // namespace tessemu
