// The stencil form of a scheme (LOOP09 4.3): patches sorted by connectivity type, a table of
// weights for each type, an index buffer for each kind and number of inputs. A scheme derives from
// it and says what kinds of patches it has, their stencils and the shaders that draw them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/commands/patch_mesh.h"
#include "pipeline/forms/patch_stencils.h"
#include "shaders_cpp/stencil_form/stencil_hull_shader.h"

namespace tessemu {

/// What a draw's hull shader reads besides the vertices; see StencilHullShader.
struct StencilBuffers {
    std::span<float const> weights;
    std::span<std::uint32_t const> zero_masks, patches;
    std::span<std::uint8_t const> order;
};

class StencilForm : public PatchMesh {
public:
    /// Patches of one kind and one number of inputs: an index buffer of their own, sorted by type.
    struct Group {
        std::size_t kind;
        int inputs;
        std::vector<PatchPlace> patches;
        std::vector<std::uint32_t> indices;
        std::vector<std::uint32_t> words; ///< StencilPatchWords
        std::vector<std::uint8_t> order;
    };
    struct Tables {
        std::vector<float> weights;            ///< [type][input][row], then the type's constants
        std::vector<std::uint32_t> zero_masks; ///< [type][row]
        std::vector<Group> groups;
    };

    CommandList commands(SurfaceSettings const& settings) const final
    {
        return commands(settings, tables_);
    }
    /// With other tables for the same patches; they must outlive the list.
    CommandList commands(SurfaceSettings const& settings, Tables const& tables) const;
    Tables const& tables() const { return tables_; }

    std::vector<PatchCount> patch_counts() const final;
    std::vector<std::string> warnings() const final { return warnings_; }

protected:
    StencilForm(std::shared_ptr<RefinedMesh const> mesh, std::vector<PatchKind> kinds)
        : PatchMesh(std::move(mesh)),
          kinds_(std::move(kinds))
    {
    }
    /// Makes the tables: the last line of the scheme's constructor. Throws LimitError for a patch
    /// with more than 32 inputs.
    /// \cost  a table for each connectivity type, then linear in the faces
    void make_tables();

    // What a scheme says. Kinds are numbers in the constructor's list.
    virtual std::size_t kind_of(std::uint32_t face) const = 0;
    virtual PatchStencils stencils(std::size_t kind, Neighbourhood const& patch) const = 0;
    virtual HullShader hull_shader(std::size_t kind, StencilBuffers const& buffers,
                                   SurfaceSettings const& settings) const = 0;
    virtual DomainShader domain_shader(std::size_t kind, SurfaceSettings const& settings) const = 0;

private:
    struct Type {
        std::size_t kind;
        int inputs, rows;
        int corner_row[4];
        std::size_t first_weight, first_mask;
    };
    Type add_type(std::uint32_t face, Neighbourhood const& n);
    void add_patch(Group& g, Type const& t, Neighbourhood const& n, std::uint32_t face);

    std::vector<PatchKind> kinds_;
    Tables tables_;
    std::vector<Type> types_;
    std::vector<std::string> warnings_;
};

/// A hull shader with a StencilHullShader's members on the buffers of a kind.
template <class Shader>
HullShader stencil_hull_shader(StencilBuffers const& buffers, int sums,
                               SurfaceSettings const& settings)
{
    Shader hs;
    hs.points = sums;
    hs.weights = {buffers.weights, 0, "stencil_weights"};
    hs.zero_masks = {buffers.zero_masks, 1, "zero_masks"};
    hs.patches = {buffers.patches, 2, "patch_words"};
    hs.order = {buffers.order, 3, "order"};
    hs.factors = settings.factor_rule();
    return bind_hull_shader(hs, settings.machine);
}

} // namespace tessemu
