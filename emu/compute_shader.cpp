// SPDX-License-Identifier: Apache-2.0
#include "emu/compute_shader.h"

#include "emu/error.h"

namespace tessemu {

namespace {
void check(ComputeProgram const& program, std::array<std::uint32_t, 3> const& groups)
{
    auto const limit = [](char const* thing, std::uint64_t value, std::uint64_t most) {
        if (value > most) throw LimitError(thing, value, most);
    };
    auto const t = program.threads();
    for (int n : t)
        if (n < 1)
            throw Error("threads of a group is " + std::to_string(n) + ", at least 1 is needed");
    limit("threads of a group in x", std::uint64_t(t[0]), 1024);
    limit("threads of a group in y", std::uint64_t(t[1]), 1024);
    limit("threads of a group in z", std::uint64_t(t[2]), 64);
    limit("threads of a group", std::uint64_t(t[0]) * std::uint64_t(t[1]) * std::uint64_t(t[2]),
          1024);
    limit("floats of shared memory", std::uint64_t(program.shared_floats()), kMaxSharedFloats);
    for (std::uint32_t n : groups) limit("groups of a dispatch in one dimension", n, kMaxDispatch);
}
} // namespace

DrawStatistics dispatch(ComputeShader const& shader, std::array<std::uint32_t, 3> groups,
                        ThreadPool const& threads)
{
    ComputeProgram const& program = shader.program();
    check(program, groups);
    StageBuffers const buffers(shader.resources());
    std::uint64_t const all = std::uint64_t(groups[0]) * groups[1] * groups[2];
    constexpr std::uint64_t kPiece = 16;
    std::uint64_t const pieces = program.ordered() ? 1 : (all + kPiece - 1) / kPiece;
    std::vector<StageCounters> counters(std::max<std::uint64_t>(1, pieces));
    threads.parallel_for(std::size_t(all ? pieces : 0), [&](std::size_t i) {
        std::uint64_t const first = program.ordered() ? 0 : i * kPiece;
        std::uint64_t const count = program.ordered() ? all : std::min(kPiece, all - first);
        shader.run(groups, first, count, counters[i], buffers);
    });
    StageCounters sum;
    for (StageCounters const& c : counters) sum += c;

    DrawStatistics stats;
    stats.pipeline.CSInvocations = sum.invocations;
    stats.stages.push_back({"compute_shader", sum.invocations, sum.flops, {}, 0});
    StageStatistics& s = stats.stages.back();
    buffers.report(sum, s);
    if (sum.shared_loads)
        s.fetches.push_back({"group_shared", ResourceKind::Shared, sum.shared_loads,
                             sum.shared_loads * sizeof(float),
                             std::uint64_t(program.shared_floats()) * sizeof(float)});
    s.output_bytes = buffers.written_bytes(sum);
    stats.shared_out_of_range = sum.shared_out_of_range;
    return stats;
}

} // namespace tessemu
