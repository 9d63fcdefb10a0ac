// GPUs as JSON files, each number with its source.
//
//     {"name": "...", "about": "...",
//      "clocks": {"core": {"value": 576e6, "source": "..."}},
//      "arithmetic": {"value": 192, "per": "core", "source": "..."},   // per a clock, or "second"
//      "special": ..., "fetch": {"any": ..., "texture": ...}, "bandwidth": ...,
//      "tessellator": ..., "tessellated_triangles": ..., "setup": ..., "raster": ...,
//      "cache_bytes": {"value": 229376, "source": "..."}, "group_width": ..., "vertex_cache": ...,
//      "overhead": {"value": 0.6e-3, "per": "draw", "source": "..."}}
//
// Of a GPU whose shaders are assembly of four-wide instructions:
//
//     {"issues": {"pixel_shader": {"value": 2, "per": "core", "source": "..."}},
//      "components": {"value": 3, "source": "..."}, "fragment_batch": ...,
//      "target_switches": {"value": 200, "per": "second", "source": "..."}, "bus": ...,
//      "stages": {"value": ["vertex_shader", ...], "source": "..."}, "cpu_stages": ...}
//
// What is left out bounds nothing.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/gpu_model.h"

#include <string_view>
#include <vector>

namespace tessemu {

struct BuiltinGpu {
    std::string_view name, json;
};
std::vector<BuiltinGpu> const& builtin_gpus();

/// \param name  for messages
/// Throws FormatError that names the number: unknown, without a source, not above 0.
GpuModel parse_gpu_model(std::string_view json, std::string const& name);
/// A file if there is one, else a built-in description.
GpuModel load_gpu_model(std::string const& path_or_name);

} // namespace tessemu
