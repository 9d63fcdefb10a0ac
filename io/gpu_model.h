// A GPU as a few rates: what a cost estimate knows of hardware.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/memory.h"
#include "emu/vertex_cache.h"

#include <limits>
#include <map>
#include <string>

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
    /// Where each number comes from, by its place in the file.
    std::map<std::string, std::string> sources;

    double fetch_rate(ResourceKind kind) const
    {
        auto const it = fetch.find(kind);
        return it == fetch.end() ? any_fetch : it->second;
    }
};

} // namespace tessemu
