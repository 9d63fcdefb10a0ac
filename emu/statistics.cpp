// SPDX-License-Identifier: Apache-2.0
#include "emu/statistics.h"

#include <algorithm>

namespace tessemu {

char const* name_of(ResourceKind kind)
{
    switch (kind) {
    case ResourceKind::Vertex:
        return "vertex";
    case ResourceKind::Index:
        return "index";
    case ResourceKind::ControlPoint:
        return "control_point";
    case ResourceKind::PatchConstant:
        return "patch_constant";
    case ResourceKind::Buffer:
        return "buffer";
    case ResourceKind::Texture:
        return "texture";
    default:
        return "shared";
    }
}

PipelineStatistics& PipelineStatistics::operator+=(PipelineStatistics const& o)
{
    IAVertices += o.IAVertices, IAPrimitives += o.IAPrimitives, VSInvocations += o.VSInvocations;
    HSInvocations += o.HSInvocations, DSInvocations += o.DSInvocations;
    GSInvocations += o.GSInvocations, GSPrimitives += o.GSPrimitives;
    CInvocations += o.CInvocations, CPrimitives += o.CPrimitives;
    PSInvocations += o.PSInvocations, CSInvocations += o.CSInvocations;
    HSControlPointInvocations += o.HSControlPointInvocations;
    HSPatchConstantInvocations += o.HSPatchConstantInvocations;
    return *this;
}

StageStatistics& StageStatistics::operator+=(StageStatistics const& o)
{
    invocations += o.invocations;
    flops += o.flops;
    output_bytes += o.output_bytes;
    for (FetchStatistics const& f : o.fetches) {
        auto const it = std::find_if(fetches.begin(), fetches.end(), [&](FetchStatistics const& m) {
            return m.resource == f.resource && m.kind == f.kind;
        });
        if (it == fetches.end()) {
            fetches.push_back(f);
            continue;
        }
        it->count += f.count, it->bytes += f.bytes, it->unique_bytes += f.unique_bytes;
    }
    return *this;
}

DrawStatistics& DrawStatistics::operator+=(DrawStatistics const& o)
{
    pipeline += o.pipeline;
    samples_passed += o.samples_passed;
    shared_out_of_range += o.shared_out_of_range;
    tess_factors_above_max += o.tess_factors_above_max;
    for (std::size_t i = 0; i < stream_output.size(); ++i) {
        stream_output[i].NumPrimitivesWritten += o.stream_output[i].NumPrimitivesWritten;
        stream_output[i].PrimitiveStorageNeeded += o.stream_output[i].PrimitiveStorageNeeded;
    }
    if (stages.empty()) {
        stages = o.stages;
        return *this;
    }
    for (StageStatistics const& s : o.stages) {
        auto const it = std::find_if(stages.begin(), stages.end(),
                                     [&](StageStatistics const& m) { return m.stage == s.stage; });
        if (it == stages.end())
            stages.push_back(s);
        else
            *it += s;
    }
    return *this;
}

StageCounters& StageCounters::operator+=(StageCounters const& o)
{
    invocations += o.invocations;
    flops += o.flops;
    input_fetches += o.input_fetches, input_touched += o.input_touched;
    constant_fetches += o.constant_fetches, constant_touched += o.constant_touched;
    factor_fetches += o.factor_fetches, factor_touched += o.factor_touched;
    output_fetches += o.output_fetches, output_touched += o.output_touched;
    if (buffers.size() < o.buffers.size()) buffers.resize(o.buffers.size());
    for (std::size_t i = 0; i < o.buffers.size(); ++i)
        buffers[i].fetches += o.buffers[i].fetches, buffers[i].writes += o.buffers[i].writes;
    shared_loads += o.shared_loads, shared_stores += o.shared_stores;
    shared_out_of_range += o.shared_out_of_range;
    features |= o.features;
    return *this;
}

StageBuffers::StageBuffers(std::vector<ResourceInfo> resources) : resources_(std::move(resources))
{
    for (ResourceInfo const& r : resources_) {
        touched_.push_back(std::make_unique<TouchedElements>(r.elements));
        slots_ = std::max(slots_, std::uint32_t(r.slot) + 1);
    }
}

void StageBuffers::bind(FetchSlot* slots) const
{
    std::fill_n(slots, slots_, FetchSlot{0, 0, nullptr});
    for (std::size_t i = 0; i < resources_.size(); ++i)
        slots[resources_[i].slot].touched = touched_[i].get();
}

void StageBuffers::report(StageCounters const& counters, StageStatistics& out) const
{
    for (std::size_t i = 0; i < resources_.size(); ++i) {
        ResourceInfo const& r = resources_[i];
        std::uint64_t const n = counters.of_buffer(r.slot).fetches;
        out.fetches.push_back(
            {r.name, r.kind, n, n * r.element_bytes, touched_[i]->count() * r.element_bytes});
    }
}

std::uint64_t StageBuffers::written_bytes(StageCounters const& counters) const
{
    std::uint64_t bytes = 0;
    for (ResourceInfo const& r : resources_)
        bytes += counters.of_buffer(r.slot).writes * r.element_bytes;
    return bytes;
}

} // namespace tessemu
