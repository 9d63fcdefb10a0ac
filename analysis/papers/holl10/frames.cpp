// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/holl10/frames.h"

namespace tessemu {

SchemeOnMesh build_holl10(Holl10Scheme const& scheme, ControlMesh const& mesh)
{
    Scheme const& found = find_scheme(scheme.scheme);
    BuildOptions options;
    for (SchemeParameter const& p : found.info().parameters)
        if (p.name == "mesher") options.set = {{"mesher", "pattern"}};
    return build_scheme(found, mesh, options);
}

FrameSettings at_level(FrameSettings s, SchemeOnMesh const& on, int level)
{
    s.tess_factor = float(1 << std::max(0, level - on.mesh->steps()));
    s.direct3d10 = true;
    s.pattern = RefinementPattern::Uniform;
    return s;
}

Holl10Frame count_frame(SchemeOnMesh const& on, FrameSettings const& settings, int level,
                        ThreadPool const& threads)
{
    FrameSettings const s = at_level(settings, on, level);
    CommandList const list = frame_commands(*on.patches, s, surface_settings(s));
    Holl10Frame out;
    list.for_each_surface_draw([&](Draw const& d) {
        out.triangles += d.patches.size() * d.grid->patch.indices.size() / 3;
    });
    out.triangles_of_m0 = on.mesh->base().faces();
    CommandOptions options;
    options.vertex_cache = s.vertex_cache;
    ListStatistics const counts = run_commands(list, threads, options);
    out.all = counts.total;
    for (CommandStatistics const& c : counts.commands)
        if (c.kind == "dispatch") out.initial += c.statistics;
    return out;
}

} // namespace tessemu
