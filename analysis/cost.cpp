// SPDX-License-Identifier: Apache-2.0
#include "analysis/cost.h"

#include "emu/error.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tessemu {

namespace {

constexpr double kFetchBytes = 16;
constexpr char const* kHullShader = "hull_shader";
constexpr char const* kPixelShader = "pixel_shader";

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

// What each command of a frame says for itself.
struct OfCommands {
    double hull_shader = 0;                          ///< seconds of its arithmetic
    double switches = 0, bus_bytes = 0;              ///< of targets
    std::map<std::string, double> arithmetic, fetch; ///< seconds of issues, by stage
};

bool is_bounded(double rate)
{
    return rate != GpuModel::kUnknown;
}

// Products that feed sums are one instruction with them.
double issued_operations(GpuModel const& m, FlopCount const& f)
{
    return (double(std::max(f.add, f.mul) + f.mad) + special_operations(f)) / m.components;
}

double texels(StageStatistics const& stage)
{
    double n = 0;
    for (FetchStatistics const& f : stage.fetches)
        if (f.kind == ResourceKind::Texture) n += double(f.count);
    return n;
}

// Adds what hangs on how a command's draws are cut.
void add_command(OfCommands& to, GpuModel const& m, DrawStatistics const& s,
                 std::map<std::uint64_t, std::uint64_t> const& draws)
{
    for (StageStatistics const& stage : s.stages) {
        if (stage.stage == kHullShader)
            to.hull_shader += idle_lanes(m, s.pipeline) * arithmetic_seconds(m, stage.flops);
        auto const rate = m.issues.find(stage.stage);
        if (rate == m.issues.end()) continue;
        double const idle = stage.stage == kPixelShader ? 1 / utilisation(m, draws) : 1;
        to.arithmetic[stage.stage] += idle * issued_operations(m, stage.flops) / rate->second;
        to.fetch[stage.stage] += idle * texels(stage) / rate->second;
    }
}

void add_command(OfCommands& to, GpuModel const& m, CommandStatistics const& c)
{
    add_command(to, m, c.statistics, c.draws);
    to.switches += double(c.own_targets);
    for (StageStatistics const& stage : c.statistics.stages) {
        // To the CPU and, as vertices, back.
        if (stage.stage == "output_merger" && c.own_targets)
            to.bus_bytes += 2 * double(stage.output_bytes);
        if (!m.has(stage.stage)) to.bus_bytes += double(stage.output_bytes);
    }
}

// Throws Error for a stage that the GPU lacks and the CPU does not stand for.
bool runs_on(GpuModel const& m, std::string const& stage)
{
    if (m.has(stage)) return true;
    if (std::find(m.cpu_stages.begin(), m.cpu_stages.end(), stage) != m.cpu_stages.end())
        return false;
    std::string all;
    for (std::string const& s : m.stages) all += (all.empty() ? "" : ", ") + s;
    throw Error(m.name + " has no " + stage + ", which the scheme uses; it has " + all);
}

// Without rasterization nobody counts them, and none has to be made.
double tessellated_triangles(PipelineStatistics const& p)
{
    return double(p.GSInvocations ? p.GSInvocations : p.CInvocations);
}

DrawCost cost(GpuModel const& m, DrawStatistics const& s, OfCommands const& of)
{
    DrawCost out;
    PipelineStatistics const& p = s.pipeline;
    double memory = 0, longest_shader = -1, longest_fixed = 0;
    std::string shader, fixed;
    auto const add_fixed = [&](StageCost const& c) {
        if (c.seconds() > longest_fixed) longest_fixed = c.seconds(), fixed = c.stage;
        out.stages.push_back(c);
    };
    for (StageStatistics const& stage : s.stages) {
        if (!runs_on(m, stage.stage)) continue;
        StageCost c;
        c.stage = stage.stage;
        bool const is_shader = stage.stage.ends_with("_shader");
        c.operations = operations(stage.flops);
        c.arithmetic =
            stage.stage == kHullShader ? of.hull_shader : arithmetic_seconds(m, stage.flops);
        for (FetchStatistics const& r : stage.fetches) {
            double const n = fetch_count(r);
            c.fetches += n;
            c.fetched_bytes += double(r.bytes);
            // The input assembler and the vertex cache fetch ahead; only their traffic counts.
            if (is_shader) c.fetch += n / m.fetch_rate(r.kind);
            c.memory_bytes += memory_bytes(m, r);
        }
        if (m.issues.contains(c.stage)) {
            c.arithmetic += of.arithmetic.at(c.stage);
            c.fetch += of.fetch.at(c.stage);
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
            out.stages.push_back(c);
        } else {
            add_fixed(c);
        }
    }
    for (auto const& [name, amount, rate] :
         {std::tuple{"target_switch", of.switches, m.target_switches},
          {"bus", of.bus_bytes, m.bus}})
        if (is_bounded(rate) && amount > 0) {
            StageCost c;
            c.stage = name;
            c.fixed = amount / rate;
            add_fixed(c);
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

double utilisation(GpuModel const& m, std::map<std::uint64_t, std::uint64_t> const& draws)
{
    double fragments = 0, places = 0;
    for (auto const& [n, count] : draws) {
        fragments += double(n) * double(count);
        places += std::ceil(double(n) / m.fragment_batch) * m.fragment_batch * double(count);
    }
    return places > 0 ? fragments / places : 1;
}

std::string in_words(DrawCost const& cost)
{
    for (StageCost const& s : cost.stages)
        if (s.stage == cost.bound) {
            std::string stage = s.stage;
            std::replace(stage.begin(), stage.end(), '_', ' ');
            return s.bound() == "rate" ? stage : stage + ", " + s.bound();
        }
    return cost.bound;
}

DrawCost estimate_cost(GpuModel const& m, DrawStatistics const& s)
{
    OfCommands of;
    add_command(of, m, s, {{s.pipeline.PSInvocations, 1}});
    return cost(m, s, of);
}

DrawCost estimate_cost(GpuModel const& m, std::span<CommandStatistics const> commands)
{
    DrawStatistics all;
    OfCommands of;
    for (CommandStatistics const& c : commands) {
        all += c.statistics;
        add_command(of, m, c);
    }
    return cost(m, all, of);
}

} // namespace tessemu
