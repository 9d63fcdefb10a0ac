// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/loop09/figures.h"

#include "pipeline/colored_mesh.h"
#include "pipeline/schemes/scheme.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace tessemu {

namespace {

constexpr glm::vec3 kView(0.45f, 0.35f, 1);

class Subject {
public:
    Subject(ControlMesh const& mesh, char const* scheme, FrameSettings const& settings)
        : name_(mesh.name),
          settings_(settings)
    {
        on_ = build_scheme(find_scheme(scheme), mesh);
        settings_.camera =
            frame_points(positions(), kView, float(settings.width) / float(settings.height));
    }
    std::vector<glm::vec3> const& positions() const { return on_.mesh->mesh().positions; }
    FrameSettings& settings() { return settings_; }
    Topology const& topology() const { return on_.mesh->topology(); }
    PatchMesh const& patches() const { return *on_.patches; }

    PaperFigure::Panel cage(ThreadPool const& threads) const
    {
        Frame frame(settings_);
        draw_colored_mesh(control_mesh_picture(topology()), settings_, 0.45f, threads, frame);
        return {std::move(frame.color), name_ + ": control mesh"};
    }
    PaperFigure::Panel surface(View view, char const* what, ThreadPool const& threads) const
    {
        FrameSettings s = settings_;
        s.view = view;
        Frame frame = draw_frame(patches(), s, threads);
        return {std::move(frame.color), name_ + ": " + what};
    }
    PaperFigure::Panel displaced(ThreadPool const& threads) const
    {
        glm::vec3 low(1e30f), high(-1e30f);
        for (glm::vec3 const& p : positions()) low = min(low, p), high = max(high, p);
        float const diagonal = glm::length(high - low);
        FrameSettings s = settings_;
        s.displacement =
            std::make_shared<Displacement>(Displacement::studs(diagonal / 20, diagonal / 120));
        Frame frame = draw_frame(patches(), s, threads);
        return {std::move(frame.color), name_ + ": displaced"};
    }

private:
    std::string name_;
    FrameSettings settings_;
    SchemeOnMesh on_;
};

PaperFigure rows_of_four(std::vector<ControlMesh> const& meshes, FrameSettings const& settings,
                         ThreadPool const& threads, PaperProgress const& progress)
{
    PaperFigure f;
    f.columns = 4;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        Subject const s(meshes[i], "gregory-stencil", settings);
        f.panels.push_back(s.cage(threads));
        f.panels.push_back(s.surface(View::Patches, "patches", threads));
        f.panels.push_back(s.surface(View::Lit, "surface", threads));
        f.panels.push_back(s.displaced(threads));
        if (progress) progress(i + 1, meshes.size());
    }
    f.remarks = {"Gold: regular quads; purple: irregular quads; green: triangles."};
    return f;
}

PaperFigure gallery(std::vector<ControlMesh> const& meshes, FrameSettings const& settings,
                    ThreadPool const& threads, PaperProgress const& progress)
{
    PaperFigure f;
    f.columns = int(meshes.size());
    std::vector<Subject> subjects;
    for (ControlMesh const& m : meshes) subjects.emplace_back(m, "gregory-stencil", settings);
    std::size_t const all = 3 * subjects.size();
    auto const add = [&](auto const& panel) {
        for (Subject const& s : subjects) {
            f.panels.push_back(panel(s));
            if (progress) progress(f.panels.size(), all);
        }
    };
    add([&](Subject const& s) { return s.cage(threads); });
    add([&](Subject const& s) { return s.surface(View::Patches, "patches", threads); });
    add([&](Subject const& s) { return s.surface(View::Lit, "surface", threads); });
    f.remarks = {"Gold: regular quads; purple: irregular quads; green: triangles."};
    return f;
}

// The corner of the mesh where most triangles and quads meet, seen from outside.
PaperFigure close_up(ControlMesh const& mesh, FrameSettings const& settings,
                     ThreadPool const& threads)
{
    Subject s(mesh, "gregory-stencil", settings);
    Topology const& t = s.topology();
    std::uint32_t best = 0;
    std::size_t most = 0;
    float nearest = 0;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        if (t.is_boundary(v)) continue;
        std::size_t sides[2] = {0, 0};
        for (HalfEdge h : t.ring(v)) ++sides[t.mesh().face(t.face_of(h)).size() == 3];
        float const near = dot(mesh.positions[v] - s.settings().camera.target, kView);
        std::size_t const n = std::min(sides[0], sides[1]);
        if (near > 0 && std::pair(n, near) > std::pair(most, nearest))
            most = n, nearest = near, best = v;
    }
    if (most == 0) throw Error(mesh.name + ": no vertex has triangles and quads around it");
    std::vector<glm::vec3> near;
    for (HalfEdge h : t.ring(best))
        for (std::uint32_t v : t.mesh().face(t.face_of(h))) near.push_back(mesh.positions[v]);
    s.settings().camera = frame_points(near, kView, float(settings.width) / float(settings.height));
    fit_depth_range(s.settings().camera, mesh.positions);
    PaperFigure f;
    f.columns = 3;
    f.panels.push_back(s.cage(threads));
    f.panels.push_back(s.surface(View::Patches, "patches", threads));
    f.panels.push_back(s.surface(View::Lit, "surface", threads));
    return f;
}

PaperFigure errors(ControlMesh const& mesh, FrameSettings const& settings,
                   ThreadPool const& threads, PaperProgress const& progress)
{
    constexpr char const* kSchemes[] = {"acc", "pm", "gregory-stencil"};
    constexpr int kLevel = 4;
    std::vector<EqualParameterErrors> all;
    FrameSettings s = settings;
    double position = 0, normal = 0;
    for (char const* scheme : kSchemes) {
        Subject subject(mesh, scheme, settings);
        s.camera = subject.settings().camera;
        all.push_back(equal_parameter_errors(subject.patches(), settings, kLevel, threads));
        position = std::max(position, quantile(all.back().distance, all.back().weight, 0.99));
        normal = std::max(normal, quantile(all.back().angle, all.back().weight, 0.99));
        if (progress) progress(all.size(), std::size(kSchemes));
    }
    PaperFigure f;
    f.columns = 2;
    for (std::size_t i = 0; i < all.size(); ++i) {
        ErrorView view = draw_error(all[i], s, position, normal, threads);
        f.panels.push_back({std::move(view.position), std::string(kSchemes[i]) + ": position"});
        f.panels.push_back({std::move(view.normal), std::string(kSchemes[i]) + ": normal"});
    }
    f.scales = {{"distance / diagonal", position}, {"angle, radians", normal}};
    f.remarks = {
        "By equal parameter against the Catmull-Clark limit surface. Red is what 99 % of the "
        "area of the worst scheme stays below; the paper gives no scale.",
        "The paper's cage is not named; it leaves triangles out, as this does."};
    return f;
}

PaperFigure patterns(FrameSettings const& settings, ThreadPool const& threads)
{
    PaperFigure f;
    f.columns = 4;
    for (int sides : {3, 4})
        for (float factor : {1.0f, 3.0f, 4.4f, 9.0f}) {
            ControlMesh mesh;
            mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
            if (sides == 3) mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.5f, 0.866f, 0}};
            std::vector<std::uint32_t> face(mesh.positions.size());
            for (std::uint32_t i = 0; i < face.size(); ++i) face[i] = i;
            mesh.add_face(face);
            Subject s(mesh, "gregory-stencil", settings);
            s.settings().camera = frame_points(mesh.positions, {0, 0, 1},
                                               float(settings.width) / float(settings.height));
            s.settings().tess_factor = factor;
            PaperFigure::Panel panel = s.surface(View::Wire, "", threads);
            panel.caption =
                fmt::format("{}, fractional_odd {}", sides == 3 ? "tri" : "quad", factor);
            f.panels.push_back(std::move(panel));
        }
    return f;
}

} // namespace

PaperFigure reproduce_loop09_figure(int number, std::vector<ControlMesh> const& meshes,
                                    FrameSettings const& settings, ThreadPool const& threads,
                                    PaperProgress const& progress)
{
    if (number != 3 && meshes.empty()) throw Error("a figure needs a mesh");
    switch (number) {
    case 1:
    case 9:
        return rows_of_four(meshes, settings, threads, progress);
    case 3:
        return patterns(settings, threads);
    case 10:
        return close_up(meshes[0], settings, threads);
    case 11:
        return errors(meshes[0], settings, threads, progress);
    case 12:
        return gallery(meshes, settings, threads, progress);
    default:
        throw Error(fmt::format("LOOP09 has no figure {} to reproduce", number));
    }
}

} // namespace tessemu
