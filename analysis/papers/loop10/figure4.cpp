// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/loop10/figure4.h"

#include "analysis/papers/loop10/items.h"
#include "pipeline/patch_valences.h"
#include "pipeline/schemes/scheme.h"

#include <fmt/format.h>

#include <map>

namespace tessemu {

PaperFigure reproduce_loop10_figure4(std::vector<ControlMesh> const& meshes,
                                     FrameSettings const& settings, ThreadPool const& threads,
                                     PaperProgress const& progress)
{
    PaperFigure f;
    f.columns = int(meshes.size());
    std::map<int, std::string> colors; // of extraordinary vertices that are seen
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        Loop10Model const& model = kLoop10Models[i];
        BuildOptions options;
        options.subdivide = model.steps;
        SchemeOnMesh const on = build_scheme(find_scheme("gregory-stencil"), meshes[i], options);
        FrameSettings s = settings;
        s.view = View::Valence;
        s.tess_factor = 4; // of patches that are small after a step or two
        s.camera = frame_points(on.mesh->mesh().positions, {0.45f, 0.35f, 1},
                                float(s.width) / float(s.height));
        Frame frame = draw_frame(*on.patches, s, threads);
        f.panels.push_back({std::move(frame.color), model.caption()});
        for (auto const& [valence, patches] : count_valences(*on.patches))
            if (valence.valence != PatchValence::kRegular)
                colors[valence.valence] =
                    fmt::format("{} {}", valence.in_words(), valence.color_name());
        if (progress) progress(i + 1, meshes.size());
    }
    std::string legend = "Regular patches are grey";
    for (auto const& [valence, text] : colors) legend += ", " + text;
    f.remarks = {
        legend + ".",
        "After the steps that leave a patch one extraordinary vertex at most: one for quads, two "
        "for the triangles.",
        loop10_models_remark()};
    return f;
}

} // namespace tessemu
