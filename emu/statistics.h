// What a draw counted: Direct3D 11's pipeline statistics, and per stage operations and fetches.
//
// All are integers; sums do not depend on the schedule.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/memory.h"
#include "emu/stream_output.h"

#include <algorithm>

namespace tessemu {

/// D3D11_QUERY_DATA_PIPELINE_STATISTICS (rules R156 to R164) and the hull shader's two phases.
struct PipelineStatistics {
    std::uint64_t IAVertices = 0, IAPrimitives = 0, VSInvocations = 0;
    std::uint64_t HSInvocations = 0; ///< patches
    std::uint64_t DSInvocations = 0; ///< once per domain point (I-2)
    std::uint64_t GSInvocations = 0, GSPrimitives = 0;
    std::uint64_t CInvocations = 0, CPrimitives = 0;
    /// Live pixels or samples that were shaded: those that pass where the test comes first (I-16).
    std::uint64_t PSInvocations = 0;
    std::uint64_t CSInvocations = 0;
    std::uint64_t HSControlPointInvocations = 0;  ///< patches times output control points
    std::uint64_t HSPatchConstantInvocations = 0; ///< patches times (fork instances + join)

    PipelineStatistics& operator+=(PipelineStatistics const& o);
    friend bool operator==(PipelineStatistics const&, PipelineStatistics const&) = default;
};

struct StageStatistics {
    std::string stage;
    std::uint64_t invocations = 0;
    FlopCount flops;
    std::vector<FetchStatistics> fetches;
    std::uint64_t output_bytes = 0;

    /// Adds the counts of another draw's same stage; resources are matched by name and kind.
    StageStatistics& operator+=(StageStatistics const& o);
    friend bool operator==(StageStatistics const&, StageStatistics const&) = default;
};

/// Stages in pipeline order, those that ran: input_assembler, vertex_shader, hull_shader,
/// tessellator, domain_shader, geometry_shader, stream_output, rasterizer, pixel_shader,
/// output_merger; compute_shader of a dispatch.
struct DrawStatistics {
    PipelineStatistics pipeline;
    std::vector<StageStatistics> stages;
    std::uint64_t samples_passed = 0; ///< D3D11_QUERY_OCCLUSION (R165)
    std::array<StreamOutputStatistics, 4> stream_output{};
    std::uint64_t shared_out_of_range = 0;    ///< stores past group-shared memory (I-26)
    std::uint64_t tess_factors_above_max = 0; ///< clamped to the hull shader's maximum (I-28)

    DrawStatistics& operator+=(DrawStatistics const& o);
    friend bool operator==(DrawStatistics const&, DrawStatistics const&) = default;
};

/// Counts of one stage by one worker, added up by item when the stage ends.
struct StageCounters {
    std::uint64_t invocations = 0;
    FlopCount flops;
    std::uint64_t input_fetches = 0, input_touched = 0;       ///< control points, vertices
    std::uint64_t constant_fetches = 0, constant_touched = 0; ///< patch constants
    std::uint64_t factor_fetches = 0, factor_touched = 0;     ///< tess factors, by a domain shader
    std::uint64_t output_fetches = 0, output_touched = 0; ///< a hull shader's own control points
    struct BufferCounts {
        std::uint64_t fetches = 0, writes = 0;
    };
    std::vector<BufferCounts> buffers; ///< by slot; none until the stage has run
    std::uint64_t shared_loads = 0, shared_stores = 0, shared_out_of_range = 0;
    std::uint32_t features = 0; ///< ShaderFeature bits that its shader showed

    StageCounters& operator+=(StageCounters const& o);
    BufferCounts of_buffer(int slot) const
    {
        return std::size_t(slot) < buffers.size() ? buffers[std::size_t(slot)] : BufferCounts{};
    }
};

/// Elements of a stage's buffers that a draw touched, one per slot.
class StageBuffers {
public:
    explicit StageBuffers(std::vector<ResourceInfo> resources);
    /// One past the highest slot in use.
    std::uint32_t slots() const { return slots_; }
    /// Makes the first slots() counters the buffers' and sets them to zero.
    void bind(FetchSlot* slots) const;
    /// The buffers' rows of a stage's table.
    void report(StageCounters const& counters, StageStatistics& out) const;
    std::uint64_t written_bytes(StageCounters const& counters) const;

private:
    std::vector<ResourceInfo> resources_;
    std::vector<std::unique_ptr<TouchedElements>> touched_;
    std::uint32_t slots_ = 0;
};

/// A programmable stage's door: flushes denormals (R9), points the thread's counters at the stage,
/// and on leaving adds what was counted to `counters`.
class StageScope {
public:
    StageScope(StageCounters& counters, StageBuffers const& buffers, SiteState const& sites = {})
        : counters_(counters),
          saved_(execution),
          saved_sites_(site_state)
    {
        buffers.bind(slots_);
        execution = Execution{};
        execution.buffers = slots_;
        execution.buffer_slots = buffers.slots();
        site_state = sites;
    }
    ~StageScope()
    {
        counters_.flops += execution.take();
        counters_.features |= execution.features;
        if (counters_.buffers.size() < execution.buffer_slots)
            counters_.buffers.resize(execution.buffer_slots);
        for (std::uint32_t i = 0; i < execution.buffer_slots; ++i)
            counters_.buffers[i].fetches += slots_[i].count,
                counters_.buffers[i].writes += slots_[i].written;
        execution = saved_;
        site_state = saved_sites_;
    }
    StageScope(StageScope const&) = delete;
    StageScope& operator=(StageScope const&) = delete;

private:
    DenormalMode flush_{DenormalMode::Flush};
    StageCounters& counters_;
    FetchSlot slots_[kBufferSlots]; // those in use are set by the buffers
    Execution saved_;
    SiteState saved_sites_;
};

} // namespace tessemu
