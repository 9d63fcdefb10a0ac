// A subdivision scheme synthesized by tables of basis functions (Hollaender and Boubekeur 2010), of
// any masks.
//
//     skinning ─> the scheme's steps ─> normals ─> domain shader: sums of B_i p_i and B_i n_i
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/forms/table_form.h"

namespace tessemu {

/// \tparam Masks  with limits (limit.h), or WideMasks
template <class Masks> class TableScheme final : public Scheme {
public:
    /// \param info  all but what the table form has in common
    explicit TableScheme(SchemeInfo info) : info_(std::move(info))
    {
        info_.paper = "HOLL10";
        info_.section = "2";
        info_.takes.creases = info_.takes.corners = !WideMasks<Masks>;
        info_.takes.edges = LocalMesh::kMostEdges;
        info_.parameters = TableForm::parameters(!WideMasks<Masks>, info_.takes.steps);
        info_.watertight_with = {{"tables", "enforced"}};
        info_.no_curvature = "its tables have no second derivatives";
    }
    SchemeInfo info() const override { return info_; }
    int more_steps(Parameters const& parameters) const override
    {
        return TableForm::more_steps(parameters, info_.takes.steps);
    }
    std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const> mesh,
                                     Parameters const& parameters,
                                     BuildServices const& services) const override
    {
        return std::make_unique<TableForm>(std::move(mesh), TableForm::rules<Masks>(parameters),
                                           parameters, services);
    }

private:
    SchemeInfo info_;
};

} // namespace tessemu
