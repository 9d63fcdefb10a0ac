// The shaders of table-driven patches, bound to a machine.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/commands/displacement.h"
#include "shaders_cpp/tables/table_patch.h"

#include <variant>

namespace tessemu {

/// \tparam Samples  TriangleSamples or QuadSamples; each is compiled in a file of its own
template <class Samples> struct TableShaders {
    using Patch = std::variant<TablePatch, TangentTablePatch<Samples::kCorners>>;

    static HullShader hull(TessFactorRule const& factors, Machine const& machine)
    {
        return bind_hull_shader(TableHullShader<Samples::kDomain>{factors}, machine);
    }
    static DomainShader domain(Patch const& patch, Samples const& samples, Machine const& machine)
    {
        return std::visit(
            [&](auto const& p) {
                using Shader = TableDomainShader<Samples, std::remove_cvref_t<decltype(p)>>;
                return bind_domain_shader(Shader{p, samples}, machine);
            },
            patch);
    }
    static VertexShader pattern(Patch const& patch, Samples const& samples,
                                SurfaceEpilog const& epilog, Machine const& machine)
    {
        return std::visit(
            [&](auto const& p, auto const& e) {
                using Shader = TablePatternVertexShader<Samples, std::remove_cvref_t<decltype(p)>,
                                                        std::remove_cvref_t<decltype(e)>>;
                return bind_vertex_shader(Shader{p, samples, e}, machine);
            },
            patch, epilog.shader);
    }
};

extern template struct TableShaders<TriangleSamples>;
extern template struct TableShaders<QuadSamples>;

} // namespace tessemu
