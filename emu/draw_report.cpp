// SPDX-License-Identifier: Apache-2.0
#include "emu/draw_report.h"

namespace tessemu {

namespace {

struct Report {
    DrawnParts const& d;
    DrawStatistics& out;

    StageStatistics& add_stage(char const* name, std::uint64_t invocations, StageCounters const& c)
    {
        out.stages.push_back({name, invocations, c.flops, {}, 0});
        return out.stages.back();
    }
    static void add_fetch(StageStatistics& s, char const* name, ResourceKind kind, std::uint64_t n,
                          std::uint64_t unique, std::size_t bytes)
    {
        s.fetches.push_back({name, kind, n, n * bytes, unique * bytes});
    }

    void run()
    {
        PipelineStatistics& p = out.pipeline;
        StageStatistics& ia = add_stage("input_assembler", p.IAPrimitives, {});
        if (d.primitives.index_bytes) {
            std::uint64_t const read = d.primitives.indices_read * d.call.instance_count;
            add_fetch(ia, "indices", ResourceKind::Index, read, d.primitives.indices_read,
                      d.primitives.index_bytes);
        }
        VertexProgram const& vs = d.pipeline.vertex_shader.program();
        StageStatistics& v =
            add_stage("vertex_shader", d.counters.vertex.invocations, d.counters.vertex);
        if (std::size_t const bytes = d.call.vertex_bytes()) // or SV_VertexID is all
            add_fetch(v, "vertices", ResourceKind::Vertex, d.counters.vertex.input_fetches,
                      d.counters.vertex.input_touched, bytes);
        d.vertex_buffers.report(d.counters.vertex, v);
        v.output_bytes =
            d.counters.vertex.invocations * std::uint64_t(vs.output_floats()) * sizeof(float);
        if (d.pipeline.hull_shader) report_tessellation();
        if (d.pipeline.geometry_shader) {
            GeometryProgram const& gs = d.pipeline.geometry_shader.program();
            p.GSInvocations = d.counters.geometry.invocations;
            StageStatistics& g =
                add_stage("geometry_shader", d.counters.geometry.invocations, d.counters.geometry);
            add_fetch(g, "vertices", ResourceKind::Vertex, d.counters.geometry.input_fetches,
                      d.counters.geometry.input_touched,
                      std::size_t(gs.input_fetch_floats()) * sizeof(float));
            d.front_end.geometry_buffers().report(d.counters.geometry, g);
            g.output_bytes = p.GSPrimitives * std::uint64_t(gs.vertices_per_output()) *
                             std::uint64_t(gs.output().floats) * sizeof(float);
        }
        if (d.stream_output) {
            out.stream_output = d.stream_output->statistics();
            std::uint64_t written = 0;
            for (auto const& s : out.stream_output) written += s.NumPrimitivesWritten;
            add_stage("stream_output", written, {}).output_bytes = d.stream_output->bytes_written();
        }
        if (d.raster) report_raster();
    }

    void report_tessellation()
    {
        PipelineStatistics& p = out.pipeline;
        HullProgram const& hs = d.pipeline.hull_shader.program();
        auto const points = std::uint64_t(d.pipeline.hull_shader.control_points()),
                   constants = std::uint64_t(d.pipeline.hull_shader.patch_constants());
        p.HSInvocations = d.counters.hull.invocations;
        p.HSControlPointInvocations = d.counters.hull.invocations * points;
        p.HSPatchConstantInvocations = d.counters.hull.invocations * (constants + 1);
        std::size_t const point_bytes = std::size_t(hs.control_point_floats()) * sizeof(float);
        std::size_t const fetch_bytes =
            std::size_t(hs.control_point_fetch_floats()) * sizeof(float);
        std::size_t const constant_bytes = std::size_t(hs.patch_constant_floats()) * sizeof(float);
        StageStatistics& h = add_stage("hull_shader", d.counters.hull.invocations, d.counters.hull);
        add_fetch(h, "input_control_points", ResourceKind::ControlPoint,
                  d.counters.hull.input_fetches, d.counters.hull.input_touched,
                  std::size_t(hs.input_fetch_floats()) * sizeof(float));
        if (d.counters.hull.output_fetches)
            add_fetch(h, "output_control_points", ResourceKind::ControlPoint,
                      d.counters.hull.output_fetches, d.counters.hull.output_touched, fetch_bytes);
        if (d.counters.hull.constant_fetches)
            add_fetch(h, "patch_constants", ResourceKind::PatchConstant,
                      d.counters.hull.constant_fetches, d.counters.hull.constant_touched,
                      constant_bytes);
        d.front_end.hull_buffers().report(d.counters.hull, h);
        h.output_bytes = d.counters.hull.invocations *
                         (points * point_bytes + constants * constant_bytes +
                          std::uint64_t(tess_factor_count(hs.domain())) * sizeof(float));

        StageStatistics& t = add_stage("tessellator", d.counters.hull.invocations, {});
        t.output_bytes = d.counters.tessellated_points * 2 * sizeof(float) +
                         d.counters.tessellated_indices * sizeof(std::uint32_t);

        p.DSInvocations = d.counters.domain.invocations;
        StageStatistics& s =
            add_stage("domain_shader", d.counters.domain.invocations, d.counters.domain);
        add_fetch(s, "control_points", ResourceKind::ControlPoint, d.counters.domain.input_fetches,
                  d.counters.domain.input_touched, fetch_bytes);
        add_fetch(s, "patch_constants", ResourceKind::PatchConstant,
                  d.counters.domain.constant_fetches, d.counters.domain.constant_touched,
                  constant_bytes);
        if (d.counters.domain.factor_fetches)
            add_fetch(s, "tess_factors", ResourceKind::PatchConstant,
                      d.counters.domain.factor_fetches, d.counters.domain.factor_touched,
                      sizeof(float));
        d.front_end.domain_buffers().report(d.counters.domain, s);
        s.output_bytes = d.counters.domain.invocations *
                         std::uint64_t(d.pipeline.domain_output().floats) * sizeof(float);
    }

    void report_raster()
    {
        PipelineStatistics& p = out.pipeline;
        RasterCounters const& c = d.raster->counters;
        out.samples_passed = c.passed_samples;
        add_stage("rasterizer", p.CPrimitives, {}).output_bytes = c.covered_samples * sizeof(float);
        p.PSInvocations = c.pixel.invocations;
        StageStatistics& ps = add_stage("pixel_shader", c.pixel.invocations, c.pixel);
        d.raster->buffers().report(c.pixel, ps);
        int const colors =
            d.pipeline.pixel_shader ? d.pipeline.pixel_shader->info().color_targets : 0;
        ps.output_bytes = c.pixel.invocations * std::uint64_t(colors) * 4 * sizeof(float);
        std::uint64_t texel_bytes = d.raster->target().depth ? sizeof(float) : 0;
        for (std::size_t i = 0; i < d.raster->target().color.size() && int(i) < colors; ++i)
            if (ColorTarget const* t = d.raster->target().color[i]) texel_bytes += t->texel_bytes();
        add_stage("output_merger", c.covered_samples, {}).output_bytes =
            c.passed_samples * texel_bytes;
    }
};

} // namespace

void report_draw(DrawnParts const& draw, DrawStatistics& out)
{
    Report{draw, out}.run();
}

} // namespace tessemu
