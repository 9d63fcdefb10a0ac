// The pipeline: stages bound together, checked against Direct3D 11's limits, and drawn with.
//
//     IA -> vertex cache -> VS -> HS -> tessellator -> DS -> GS -> SO
//                                                             -> assembly -> raster -> PS -> OM
//
// Results equal serial execution in submission order, whatever the number of threads (R1). A draw
// streams patches in waves, so memory does not grow with the number of patches.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_points.h"
#include "emu/domain_shader.h"
#include "emu/geometry_shader.h"
#include "emu/graphics_state.h"
#include "emu/hull_shader.h"
#include "emu/input_assembler.h"
#include "emu/parallel.h"
#include "emu/pixel_shader.h"
#include "emu/stream_output.h"
#include "emu/vertex_cache.h"
#include "emu/vertex_shader.h"

#include <optional>

namespace tessemu {

/// Shaders and state. Hull and domain shader are both there or both absent (R3).
struct GraphicsPipelineDesc {
    VertexShader vertex_shader;
    HullShader hull_shader;
    DomainShader domain_shader;
    DomainEpilog domain_epilog; ///< the domain shader's end, where it is compiled apart from it
    GeometryShader geometry_shader;
    std::optional<StreamOutputDesc> stream_output;
    PixelShader pixel_shader; ///< none: depth and stencil only (R5)
    Partitioning partitioning = Partitioning::FractionalOdd;
    OutputPrimitive output_primitive = OutputPrimitive::TriangleCw;
    int input_control_points = 0; ///< of the patch topology that is drawn

    /// What the domain shader hands on, by its epilog if it has one.
    OutputLayout domain_output() const
    {
        return domain_epilog ? domain_epilog->output() : domain_shader->output();
    }
    /// Buffers and textures of the domain shader and its epilog.
    std::vector<ResourceInfo> domain_resources() const;
};

class GraphicsPipeline {
public:
    /// Checks what D3D11 checks when a pipeline is created. Throws LimitError or Error that names
    /// the stage, the value and the limit.
    explicit GraphicsPipeline(GraphicsPipelineDesc desc);
    GraphicsPipelineDesc const& desc() const { return desc_; }

private:
    GraphicsPipelineDesc desc_;
};

/// A tessellated patch as the domain shader left it.
struct ShadedPatch {
    std::uint32_t primitive_id;
    DomainPoints const* points; ///< domain points and connectivity
    float const* outputs;       ///< component k of point i at [k * stride + i]
    std::size_t stride;
};

/// Receives shaded patches one by one in submission order.
using PatchVisitor = std::function<void(ShadedPatch const&)>;

/// Receives (done, all) primitives now and then.
using DrawProgress = std::function<void(std::size_t, std::size_t)>;

/// Working memory that draws reuse, one draw at a time; draws without it allocate their own.
class DrawMemory {
public:
    DrawMemory();
    ~DrawMemory();
    DrawMemory(DrawMemory&&) noexcept;
    DrawMemory& operator=(DrawMemory&&) noexcept;

    struct Parts;
    Parts& parts() { return *parts_; }

private:
    std::unique_ptr<Parts> parts_;
};

/// Mistakes to plant in a draw, for tests of whatever looks for cracks. Patches by primitive id.
struct DrawMistakes {
    static constexpr std::int64_t kNone = -1;
    std::int64_t other_factor = kNone;     ///< its edge 0 gets a tess factor two larger
    std::int64_t reversed_winding = kNone; ///< its triangles are turned over
    bool inclusive_edges = false; ///< of all triangles: a sample on an edge belongs to both
};

struct DrawOptions {
    VertexCacheModel vertex_cache = {};
    DrawProgress progress = {};
    DrawMemory* memory = nullptr;
    std::span<StreamOutputBuffer> stream_output = {}; ///< at most 4; `filled` moves on
    DrawMistakes mistakes = {};
};

/// Draws. Either part may be absent: without `raster` rasterization is off, without `visit` nobody
/// looks at the patches. Throws LimitError or Error for a call that does not fit the pipeline.
DrawStatistics draw(GraphicsPipeline const& pipeline, DrawCall const& call,
                    RasterTarget const* raster, PatchVisitor const& visit,
                    ThreadPool const& threads, DrawOptions const& options = {});

/// Whether anything reaches the rasterizer (R5).
bool rasterization_is_on(GraphicsPipelineDesc const& pipeline, RasterTarget const* target);
/// What a draw needs of its pipeline and targets. Throws LimitError or Error.
void check_draw(GraphicsPipelineDesc const& pipeline, DrawCall const& call,
                RasterTarget const* target, std::size_t stream_output_buffers);

} // namespace tessemu
