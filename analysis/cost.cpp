// SPDX-License-Identifier: Apache-2.0
#include "analysis/cost.h"

#include <algorithm>
#include <cmath>

namespace tessemu {

namespace {

constexpr double kFetchBytes = 16;
constexpr char const* kHullShader = "hull_shader";

bool is_cached(ResourceKind kind)
{
    return kind == ResourceKind::Buffer || kind == ResourceKind::Texture;
}

// On the chip: what stages hand to each other.
bool stays_on_chip(ResourceKind kind)
{
    return kind == ResourceKind::ControlPoint || kind == ResourceKind::PatchConstant ||
           kind == ResourceKind::Shared;
}

double memory_bytes(GpuModel const& m, FetchStatistics const& f)
{
    if (stays_on_chip(f.kind)) return 0;
    auto const bytes = double(f.bytes), unique = double(f.unique_bytes);
    if (!is_cached(f.kind) || unique == 0) return bytes;
    return unique + std::max(0.0, bytes - unique) * std::max(0.0, 1 - m.cache_bytes / unique);
}

// A hull shader's groups do not span patches: lanes beyond the last control point idle.
double idle_lanes(GpuModel const& m, PipelineStatistics const& p)
{
    double const patches = double(p.HSInvocations);
    if (patches == 0 || m.group_width <= 1) return 1;
    double useful = 0, run = 0;
    for (double all : {double(p.HSControlPointInvocations), double(p.HSPatchConstantInvocations)}) {
        double const each = all / patches;
        useful += each;
        run += std::ceil(each / m.group_width) * m.group_width;
    }
    return run / useful;
}

double special_operations(FlopCount const& f)
{
    return double(f.div + f.sqrt + f.rsqrt);
}

double operations(FlopCount const& f)
{
    return double(f.add + f.mul + f.mad) + special_operations(f);
}

double arithmetic_seconds(GpuModel const& m, FlopCount const& f)
{
    double const special = special_operations(f);
    return (operations(f) - special) / m.arithmetic + special / m.special;
}

double hull_shader_seconds(GpuModel const& m, DrawStatistics const& s)
{
    for (StageStatistics const& stage : s.stages)
        if (stage.stage == kHullShader)
            return idle_lanes(m, s.pipeline) * arithmetic_seconds(m, stage.flops);
    return 0;
}

// Without rasterization nobody counts them, and none has to be made.
double tessellated_triangles(PipelineStatistics const& p)
{
    return double(p.GSInvocations ? p.GSInvocations : p.CInvocations);
}

// \param hull_shader  seconds of its arithmetic
DrawCost cost(GpuModel const& m, DrawStatistics const& s, double hull_shader)
{
    DrawCost out;
    PipelineStatistics const& p = s.pipeline;
    double memory = 0, longest_shader = -1, longest_fixed = 0;
    std::string shader, fixed;
    for (StageStatistics const& stage : s.stages) {
        StageCost c;
        c.stage = stage.stage;
        bool const is_shader = stage.stage.ends_with("_shader");
        c.operations = operations(stage.flops);
        c.arithmetic =
            stage.stage == kHullShader ? hull_shader : arithmetic_seconds(m, stage.flops);
        for (FetchStatistics const& r : stage.fetches) {
            double const n = fetch_count(r);
            c.fetches += n;
            c.fetched_bytes += double(r.bytes);
            // The input assembler and the vertex cache fetch ahead; only their traffic counts.
            if (is_shader) c.fetch += n / m.fetch_rate(r.kind);
            c.memory_bytes += memory_bytes(m, r);
        }
        if (stage.stage == "stream_output" || stage.stage == "output_merger")
            c.memory_bytes += double(stage.output_bytes);
        c.memory = c.memory_bytes / m.bandwidth;
        if (stage.stage == "tessellator")
            c.fixed = std::max(double(p.DSInvocations) / m.tessellator,
                               tessellated_triangles(p) / m.tessellated_triangles);
        if (stage.stage == "rasterizer")
            c.fixed =
                std::max(double(p.CInvocations) / m.setup, double(p.PSInvocations) / m.raster);
        memory += c.memory;
        if (is_shader) {
            out.shaders += c.seconds();
            if (c.seconds() > longest_shader) longest_shader = c.seconds(), shader = c.stage;
        } else if (c.seconds() > longest_fixed) {
            longest_fixed = c.seconds(), fixed = c.stage;
        }
        out.stages.push_back(c);
    }
    double const work = std::max({out.shaders, longest_fixed, memory});
    out.bound = work == 0               ? "-"
                : work == out.shaders   ? shader
                : work == longest_fixed ? fixed
                                        : "memory";
    out.seconds = m.overhead + work;
    return out;
}

} // namespace

double fetch_count(FetchStatistics const& f)
{
    if (f.count == 0) return 0;
    double const each = double(f.bytes) / double(f.count);
    bool const scalar = each <= 4 && is_cached(f.kind);
    return double(f.count) * (scalar ? each / kFetchBytes : std::ceil(each / kFetchBytes));
}

std::string StageCost::bound() const
{
    if (seconds() == 0) return "-";
    if (fixed > 0) return "rate";
    if (memory > arithmetic + fetch) return "memory";
    return arithmetic > fetch ? "arithmetic" : "fetch";
}

DrawCost estimate_cost(GpuModel const& m, DrawStatistics const& s)
{
    return cost(m, s, hull_shader_seconds(m, s));
}

DrawCost estimate_cost(GpuModel const& m, std::span<CommandStatistics const> commands)
{
    DrawStatistics all;
    double hull_shader = 0;
    for (CommandStatistics const& c : commands) {
        all += c.statistics;
        hull_shader += hull_shader_seconds(m, c.statistics);
    }
    return cost(m, all, hull_shader);
}

} // namespace tessemu
