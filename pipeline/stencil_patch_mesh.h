// A patch mesh in stencil form (LOOP09 4.3): patches sorted by connectivity type, a table of
// weights for each type, an index buffer for each kind and number of inputs. A scheme says what
// kinds of patches it has and which shaders draw them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/patch_stencils.h"
#include "pipeline/technique.h"
#include "shaders_cpp/stencil_hull_shader.h"

namespace tessemu {

/// What a draw's hull shader reads besides the vertices; see StencilHullShader.
struct StencilBuffers {
    std::span<float const> weights;
    std::span<std::uint32_t const> zero_masks, patches;
    std::span<std::uint8_t const> order;
};

/// Patches of one hull and one domain shader.
struct StencilKind {
    PatchKind kind;
    int sides;
    std::function<std::shared_ptr<HullProgram const>(StencilBuffers const&, PassSettings const&)>
        hull_program;
    std::function<std::shared_ptr<DomainProgram const>(PassSettings const&)> domain_program;
    std::function<PatchStencils(Neighbourhood const&)> stencils;
};

struct StencilScheme {
    std::vector<StencilKind> kinds;
    /// The kind of a face. Throws Error for one that the scheme cannot draw.
    std::function<std::size_t(std::uint32_t face)> kind_of;
    std::vector<std::string> warnings;
};

/// Throws LimitError for a patch with more than 32 inputs. \cost a table per connectivity type,
/// then linear in the faces.
std::unique_ptr<PatchMesh> make_stencil_patch_mesh(Topology const& topology, StencilScheme scheme);

/// A hull shader with a StencilHullShader's members on the buffers of a kind.
template <class Shader>
std::shared_ptr<HullProgram const> stencil_hull_program(StencilBuffers const& buffers, int sums,
                                                        PassSettings const& settings)
{
    Shader hs;
    hs.points = sums;
    hs.weights = {buffers.weights, 0, "stencil_weights"};
    hs.zero_masks = {buffers.zero_masks, 1, "zero_masks"};
    hs.patches = {buffers.patches, 2, "patch_words"};
    hs.order = {buffers.order, 3, "order"};
    hs.factors = settings.factor_rule();
    return make_hull_program(hs, settings.machine);
}

} // namespace tessemu
