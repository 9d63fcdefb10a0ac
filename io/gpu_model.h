// A GPU as a few rates: what a cost estimate knows of hardware.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/memory.h"
#include "emu/vertex_cache.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace tessemu {

/// Rates are per second; one that nobody knows is infinite and bounds nothing.
struct GpuModel {
    static constexpr double kUnknown = std::numeric_limits<double>::infinity();
    std::string name, about;
    double arithmetic = kUnknown; ///< additions, multiplications, multiply-adds of one lane
    double special = kUnknown;    ///< divisions and square roots
    double any_fetch = kUnknown;  ///< of up to 16 bytes, by kinds that `fetch` does not list
    std::map<ResourceKind, double> fetch;
    double bandwidth = kUnknown; ///< bytes to and from memory
    double cache_bytes = 0;      ///< in front of buffers and textures
    double tessellator = kUnknown, tessellated_triangles = kUnknown; ///< its points, its triangles
    double setup = kUnknown, raster = kUnknown;                      ///< triangles, pixels
    int group_width = 1; ///< invocations that run together
    VertexCacheModel vertex_cache;
    double overhead = 0; ///< seconds a draw costs whatever it does

    // Of GPUs whose shaders are assembly of four-wide instructions.
    std::map<std::string, double> issues; ///< instructions, by stage ("pixel_shader")
    /// Scalar operations that an instruction does, where a stage has issues.
    double components = 1;
    double fragment_batch = 1; ///< fragments that run together, all of one draw
    double target_switches = kUnknown;
    double bus = kUnknown; ///< bytes between CPU and GPU

    /// A stage that the GPU lacks is the CPU's, or an error; empty: the GPU has all.
    std::vector<std::string> stages, cpu_stages;
    /// Where each number comes from, by its place in the file.
    std::map<std::string, std::string> sources;

    bool has(std::string const& stage) const
    {
        return stages.empty() || std::find(stages.begin(), stages.end(), stage) != stages.end();
    }
    double fetch_rate(ResourceKind kind) const
    {
        auto const it = fetch.find(kind);
        return it == fetch.end() ? any_fetch : it->second;
    }
};

} // namespace tessemu
