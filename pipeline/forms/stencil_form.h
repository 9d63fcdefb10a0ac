// The stencil form of a scheme (LOOP09 4.3): patches sorted by connectivity type, a table of
// weights for each type, an index buffer for each kind and number of inputs. A scheme derives from
// it and says what kinds of patches it has, their stencils and the shaders that draw them.
//
// A patch of Direct3D 11 has at most 32 control points. One whose stencils need more vertices is
// wide: a dispatch sums its rows, whatever their length, into a buffer that its draw reads.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/commands/patch_mesh.h"
#include "pipeline/forms/patch_stencils.h"
#include "shaders_cpp/stencil_form/stencil_hull_shader.h"

#include <variant>

namespace tessemu {

/// What a draw's hull shader reads besides the vertices; see SummedRows.
struct StencilBuffers {
    std::span<float const> weights;
    std::span<std::uint32_t const> zero_masks, patches;
    std::span<std::uint8_t const> order;
    std::span<float const> poles; ///< see PoleNormals
};
/// The same of wide patches; see GatheredRows.
struct GatheredBuffers {
    int rows;
    std::span<float const> sums;
    std::span<std::uint32_t const> patches;
    std::span<float const> constants;
    std::span<float const> poles;
};
using RowBuffers = std::variant<StencilBuffers, GatheredBuffers>;

class Neighbourhoods; // stencil_form.cpp

class StencilForm : public PatchMesh {
public:
    /// Edges at a vertex that a scheme of this form takes: the rows of a pole's patches have some
    /// 28 times the square of its valence terms.
    static constexpr std::uint32_t kMostEdges = 2048;

    /// Patches of one kind and one number of inputs: an index buffer of their own, sorted by type.
    struct Group {
        std::size_t kind;
        int inputs;
        std::vector<PatchPlace> patches;
        std::vector<std::uint32_t> indices;
        std::vector<std::uint32_t> words; ///< StencilPatchWords
        std::vector<std::uint8_t> order;
    };
    /// Wide patches of one kind, and their rows as StencilComputeShader reads them.
    struct WideGroup {
        std::size_t kind;
        int points, rows; ///< of a patch
        int min_inputs, max_inputs;
        std::vector<PatchPlace> patches;
        std::vector<std::uint32_t> indices; ///< of the control points among the rows
        std::vector<std::uint32_t> words;   ///< GatheredPatchWords
        std::vector<std::uint32_t> first, vertices;
        std::vector<float> weights, constants;
    };
    struct Tables {
        std::vector<float> weights;            ///< [type][input][row], then the type's constants
        std::vector<std::uint32_t> zero_masks; ///< [type][row]
        std::vector<Group> groups;
        std::vector<WideGroup> wide;
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
    std::optional<AnotherWay> another_way() const final { return another_way_; }
    /// Whether patches are WatertightPatches whose control points begin with p, e+, e-.
    virtual bool has_shared_edges() const { return true; }

protected:
    StencilForm(std::shared_ptr<RefinedMesh const> mesh, std::vector<PatchKind> kinds)
        : PatchMesh(std::move(mesh)),
          kinds_(std::move(kinds))
    {
    }
    /// Patches whose type's table is made before the mesh is looked at.
    struct TypeAhead {
        std::size_t kind;
        ValenceType type;
    };
    /// Makes the tables: the last line of the scheme's constructor. Throws LimitError for wide
    /// patches whose rows have more than 2^28 terms, as around several vertices of 2,000 edges.
    ///
    /// \param threads  that look at neighbourhoods; none: the calling thread alone
    /// \param ahead    of LOOP10's types; tables have other places then and the same rows
    /// \cost  a table for each connectivity type, linear in the faces, and in the terms of wide
    ///        patches' rows: some 28 times the square of a pole's valence
    void make_tables(ThreadPool const* threads, std::vector<TypeAhead> const& ahead = {});

    /// What the scheme itself has to say, beside the form.
    void warn(std::string warning) { warnings_.push_back(std::move(warning)); }
    /// Of several, all but the first are warnings alone.
    void draws_another_way(AnotherWay way)
    {
        if (another_way_)
            warn(std::move(way.what));
        else
            another_way_ = std::move(way);
    }

    // What a scheme says. Kinds are numbers in the constructor's list.
    virtual std::size_t kind_of(std::uint32_t face) const = 0;
    /// Turns a face's neighbourhood, or numbers its inputs, as the kind's shaders know them; the
    /// same for all faces of a connectivity type. Called on several threads at once.
    virtual void arrange(std::uint32_t, Neighbourhood&) const {}
    /// Hears of each patch when it is added to the tables, in the order in which its kind is drawn.
    virtual void added(std::size_t, std::uint32_t, Neighbourhood const&) {}
    virtual PatchStencils stencils(std::size_t kind, Neighbourhood const& patch) const = 0;
    virtual HullShader hull_shader(std::size_t kind, RowBuffers const& buffers,
                                   SurfaceSettings const& settings) const = 0;
    virtual DomainShader domain_shader(std::size_t kind, SurfaceSettings const& settings) const = 0;
    /// domain_shader() where it reads more than the hull shader's output: appends the dispatches
    /// that make it to the list, in front of the kind's draw.
    ///
    /// \param positions  of the mesh's vertices in the pose that is drawn
    virtual DomainShader prepared_domain_shader(CommandList&, VertexSource const& /*positions*/,
                                                std::size_t kind,
                                                SurfaceSettings const& settings) const
    {
        return domain_shader(kind, settings);
    }
    /// Whether prepared_domain_shader() reads the positions.
    virtual bool reads_positions() const { return false; }

private:
    /// In the buffers of all types.
    struct Table {
        PatchStencils stencils; ///< without their rows
        std::size_t rows, first_weight, first_mask;
    };
    struct Type : Table {
        std::size_t kind;
        int sides;
        std::optional<ValenceType> valences;
        std::size_t patches = 0;

        int inputs() const { return stencils.inputs; }
        bool wide() const { return inputs() > kMaxControlPoints; }
    };
    struct Patch {
        std::uint32_t face, type;
    };
    std::vector<Patch> find_types(Neighbourhoods& neighbourhoods,
                                  std::vector<TypeAhead> const& ahead);
    void reserve_groups();
    Table add_table(std::size_t kind, Neighbourhood const& n);
    void add_patch(Type const& t, Neighbourhood const& n, std::uint32_t face);
    void add_wide_patch(Type const& t, Neighbourhood const& n, std::uint32_t face);
    void add_wide_draws(CommandList& list, SurfaceSettings const& settings, Tables const& tables,
                        VertexSource const& positions, std::span<float const> poles) const;
    std::uint32_t edge_bits(Neighbourhood const& n) const;
    std::uint32_t corner_row(Neighbourhood const& n, int corner, int row) const;

    std::vector<PatchKind> kinds_;
    Poles poles_;
    Tables tables_;
    std::vector<Type> types_;
    std::vector<std::string> warnings_;
    std::optional<AnotherWay> another_way_;
};

/// The rows of patches that are not wide.
template <int kSides> SummedRows<kSides> summed_rows(StencilBuffers const& b)
{
    return {{b.weights, 0, "stencil_weights"},
            {b.zero_masks, 1, "zero_masks"},
            {b.patches, 2, "patch_words"},
            {b.order, 3, "order"}};
}

namespace detail {
template <class Shader>
HullShader bind_stencil_hull_shader(Shader hs, int points, std::span<float const> poles, int slot,
                                    SurfaceSettings const& settings)
{
    hs.points = points;
    hs.poles.normals = {poles, slot, "pole_normals"};
    hs.factors = settings.factor_rule();
    return bind_hull_shader(hs, settings.machine);
}
} // namespace detail

/// A hull shader with a StencilHullShader's members, of patches that are not wide.
///
/// \tparam Shader  of SummedRows
/// \param points   its output control points that are rows
template <class Shader>
HullShader summed_hull_shader(StencilBuffers const& buffers, int points,
                              SurfaceSettings const& settings)
{
    Shader hs;
    hs.rows = summed_rows<Shader::kSides>(buffers);
    return detail::bind_stencil_hull_shader(hs, points, buffers.poles, 4, settings);
}

/// The same on the buffers of a kind, wide or not.
///
/// \tparam Shader  of Rows
template <template <class> class Shader, int kSides>
HullShader stencil_hull_shader(RowBuffers const& buffers, int points,
                               SurfaceSettings const& settings)
{
    auto const* const b = std::get_if<GatheredBuffers>(&buffers);
    if (!b)
        return summed_hull_shader<Shader<SummedRows<kSides>>>(std::get<StencilBuffers>(buffers),
                                                              points, settings);
    Shader<GatheredRows<kSides>> hs;
    hs.rows = {b->rows,
               {b->sums, 0, "stencil_sums"},
               {b->patches, 1, "patch_words"},
               {b->constants, 2, "type_constants"}};
    return detail::bind_stencil_hull_shader(hs, points, b->poles, 3, settings);
}

} // namespace tessemu
