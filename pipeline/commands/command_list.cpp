// SPDX-License-Identifier: Apache-2.0
#include "pipeline/commands/command_list.h"

#include <algorithm>
#include <mutex>

namespace tessemu {

namespace {

glm::vec3 as_vector(float3<float> const& v)
{
    return {v.x, v.y, v.z};
}

// Patches that no tessellator made: every vertex as a streamed-out point, patch after patch.
DrawStatistics visit_grids(Draw const& d, PatchVisitor const& visit, ThreadPool const& threads,
                           DrawOptions options)
{
    std::size_t const points = d.grid->patch.points(), patches = d.patches.size();
    GraphicsPipelineDesc desc = d.pipeline;
    auto const floats = std::size_t(d.output().floats);
    std::uint64_t const bytes = std::uint64_t(patches) * points * floats * sizeof(float);
    if (bytes > 0xffffffffu) // a buffer's size is a 32-bit number
        throw LimitError("size in bytes of the vertices that '" + d.name + "' streams out (" +
                             std::to_string(patches) + " patches of " + std::to_string(points) +
                             " points)",
                         bytes, 0xffffffffu);
    desc.pixel_shader = nullptr;
    desc.stream_output.emplace();
    desc.stream_output->rasterized_stream = -1;
    for (std::size_t k = 0; k < floats; k += 4)
        desc.stream_output->entries.push_back(
            {0, std::int16_t(k), std::uint8_t(std::min<std::size_t>(4, floats - k)), 0});
    DrawCall call = d.call;
    call.topology = PrimitiveTopology::PointList;
    call.indices = {};
    call.vertex_count = std::uint32_t(call.instance_count == patches ? points : patches * points);
    std::vector<float> vertices(patches * points * floats), patch(points * floats);
    StreamOutputBuffer buffer{std::as_writable_bytes(std::span(vertices)), 0};
    options.stream_output = std::span(&buffer, 1);
    DrawStatistics const statistics =
        draw(GraphicsPipeline(std::move(desc)), call, nullptr, {}, threads, options);
    for (std::size_t p = 0; p < patches; ++p) {
        for (std::size_t i = 0; i < points; ++i)
            for (std::size_t k = 0; k < floats; ++k)
                patch[k * points + i] = vertices[(p * points + i) * floats + k];
        visit({std::uint32_t(p), d.grid.get(), patch.data(), points});
    }
    return statistics;
}

DrawStatistics run_draw(Draw const& d, ThreadPool const& threads, CommandOptions const& o,
                        DrawProgress const& progress)
{
    std::vector<StreamOutputBuffer> streams = d.stream_output; // filled anew each time
    DrawOptions options = d.options;
    options.vertex_cache = o.vertex_cache;
    options.memory = o.memory;
    options.progress = progress;
    options.stream_output = streams;
    std::optional<RasterTarget> own;
    RasterTarget const* raster = d.target ? &*d.target : d.shows_surface() ? o.raster : nullptr;
    if (raster && d.rasterizer) {
        own = *raster;
        own->rasterizer = *d.rasterizer;
        raster = &*own;
    }
    PatchVisitor visit;
    if (o.visit && d.shows_surface())
        visit = [&](ShadedPatch const& patch) { o.visit(SurfacePatch(d, patch)); };
    DrawStatistics s;
    if (d.grid && visit) {
        s += visit_grids(d, visit, threads, options);
        if (!raster) return s;
        visit = {};
    }
    s += draw(GraphicsPipeline(d.pipeline), d.call, raster, visit, threads, options);
    return s;
}

// Working memories, each of one thread at a time.
class Memories {
public:
    std::unique_ptr<DrawMemory> take()
    {
        std::scoped_lock const lock(mutex_);
        if (idle_.empty()) return std::make_unique<DrawMemory>();
        std::unique_ptr<DrawMemory> m = std::move(idle_.back());
        idle_.pop_back();
        return m;
    }
    void give(std::unique_ptr<DrawMemory> m)
    {
        std::scoped_lock const lock(mutex_);
        idle_.push_back(std::move(m));
    }

private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<DrawMemory>> idle_;
};

CommandStatistics counted(Draw const& d, DrawStatistics statistics)
{
    std::uint64_t const fragments = statistics.pipeline.PSInvocations;
    return {"draw", d.name, 1, std::move(statistics), d.target.has_value(), {{fragments, 1}}};
}

// Threads take runs of the draws. Counts are added run by run, so nothing tells how many threads
// there were.
CommandStatistics run_batch(DrawBatch const& batch, ThreadPool const& threads,
                            CommandOptions const& o)
{
    constexpr std::size_t kRun = 16;
    std::vector<CommandStatistics> runs((batch.count + kRun - 1) / kRun);
    Memories memories;
    threads.parallel_for(runs.size(), [&](std::size_t i) {
        ThreadPool const caller{ThreadPool::Caller()};
        std::unique_ptr<DrawMemory> memory = memories.take();
        CommandOptions options;
        options.vertex_cache = o.vertex_cache;
        options.memory = memory.get();
        for (std::size_t k = i * kRun; k < std::min(batch.count, (i + 1) * kRun); ++k) {
            Draw const d = batch.draw(k);
            assert(!d.shows_surface());
            runs[i] += counted(d, run_draw(d, caller, options, {}));
        }
        memories.give(std::move(memory));
    });
    CommandStatistics all{"draw", batch.name, 0, {}};
    for (CommandStatistics const& run : runs) all += run;
    return all;
}

} // namespace

CommandStatistics& CommandStatistics::operator+=(CommandStatistics const& o)
{
    number += o.number;
    statistics += o.statistics;
    own_targets += o.own_targets;
    for (auto const& [fragments, count] : o.draws) draws[fragments] += count;
    return *this;
}

OutputLayout Draw::output() const
{
    return pipeline.domain_shader ? pipeline.domain_output() : pipeline.vertex_shader->output();
}

std::size_t CommandList::patches() const
{
    std::size_t n = 0;
    for_each_surface_draw([&](Draw const& d) { n += d.patches.size(); });
    return n;
}

bool CommandList::primitives_are_patches() const
{
    bool all = true;
    for_each_surface_draw([&](Draw const& d) { all = all && !d.grid; });
    return all;
}

SurfacePatch::SurfacePatch(Draw const& draw, ShadedPatch const& patch)
    : draw_(&draw),
      patch_(patch),
      layout_(draw.output())
{
}

SurfaceVertex SurfacePatch::vertex(std::size_t i) const
{
    if (layout_.holds<DisplacedVertex<float>>()) {
        auto const v = load_column<DisplacedVertex<float>>(patch_.outputs + i, patch_.stride);
        return {{v.position.x, v.position.y, v.position.z},
                as_vector(v.normal),
                as_vector(v.base),
                {v.coordinates.x, v.coordinates.y}};
    }
    if (layout_.holds<CurvedVertex<float>>()) {
        auto const v = load_column<CurvedVertex<float>>(patch_.outputs + i, patch_.stride);
        glm::vec3 const p(v.position.x, v.position.y, v.position.z);
        return {p, as_vector(v.normal), p, {}, v.curvature};
    }
    if (!layout_.holds<ShadedVertex<float>>())
        throw Error("the draw '" + draw_->name + "' writes vertices that are no surface's");
    auto const v = load_column<ShadedVertex<float>>(patch_.outputs + i, patch_.stride);
    glm::vec3 const p(v.position.x, v.position.y, v.position.z);
    return {p, as_vector(v.normal), p};
}

std::vector<float> SurfacePatch::scalars(std::size_t i) const
{
    std::vector<float> out(std::size_t(layout_.floats));
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = patch_.outputs[k * patch_.stride + i];
    return out;
}

ListStatistics run_commands(CommandList const& list, ThreadPool const& threads,
                            CommandOptions const& given)
{
    DrawMemory own; // serves draw after draw
    CommandOptions options = given;
    if (!options.memory) options.memory = &own;
    ListStatistics out;
    std::size_t const all = list.patches();
    std::size_t done = 0;
    auto const count = [&](CommandStatistics const& c) {
        out.total += c.statistics;
        bool const like = !out.commands.empty() && out.commands.back().kind == c.kind &&
                          out.commands.back().name == c.name;
        if (!like) out.commands.push_back({c.kind, c.name, 0, {}});
        out.commands.back() += c;
    };
    for (Command const& c : list.commands) {
        if (Dispatch const* const d = std::get_if<Dispatch>(&c)) {
            count({"dispatch", d->name, 1, dispatch(d->shader, d->groups, threads)});
            continue;
        }
        if (DrawBatch const* const b = std::get_if<DrawBatch>(&c)) {
            if (b->count) count(run_batch(*b, threads, options));
            continue;
        }
        Draw const& d = std::get<Draw>(c);
        DrawProgress progress;
        if (options.progress && d.shows_surface())
            progress = [&](std::size_t n, std::size_t) { options.progress(done + n, all); };
        count(counted(d, run_draw(d, threads, options, progress)));
        done += d.patches.size();
    }
    return out;
}

} // namespace tessemu
