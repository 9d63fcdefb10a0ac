// Meshes for tests that run over all schemes.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/model.h"
#include "pipeline/mesh/builtin_models.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/files.h"
#include "tests/support/sanitized.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tessemu::test {

/// Those whose points hull shader, tessellator and domain shader make.
inline std::vector<Scheme const*> tessellated_schemes()
{
    std::vector<Scheme const*> out;
    for (auto const& scheme : schemes())
        if (scheme->info().tessellator) out.push_back(scheme.get());
    EXPECT_FALSE(out.empty());
    return out;
}

/// As it is: a scheme of triangles would cut other faces.
inline bool takes(Scheme const& scheme, ControlMesh const& mesh)
{
    for (std::size_t f = 0; f < mesh.faces(); ++f)
        if (!scheme.info().takes.quads && mesh.face(f).size() != 3) return false;
    try {
        build_scheme(scheme, mesh);
    } catch (MeshError const&) { // tests/pipeline/schemes_test.cpp holds the scheme to its word
        return false;
    }
    return true;
}
/// Whether a scheme takes a model; a built-in's name, or a path.
inline bool takes(Scheme const& scheme, std::string const& model)
{
    return takes(scheme, load_model(model).mesh);
}

/// With the parameters under which the scheme promises equal bits on shared edges.
inline SchemeOnMesh build_watertight(Scheme const& scheme, ControlMesh mesh)
{
    return build_scheme(scheme, std::move(mesh), {.set = scheme.info().watertight_with});
}

/// The built-in cages that a scheme takes, which are quads, triangles or both, open and closed; with
/// sanitizers the first. The test fails where there is none.
inline std::vector<std::string> cages_of(Scheme const& scheme)
{
    std::vector<std::string> out;
    for (BuiltinModel const& model : builtin_models()) {
        if (kSlow && !out.empty()) break;
        if (takes(scheme, std::string(model.name))) out.emplace_back(model.name);
    }
    EXPECT_FALSE(out.empty()) << scheme.info().name << " takes no built-in cage";
    return out;
}

/// And a model of more than a thousand faces, where the shared folder has one that it takes and the
/// scheme's own steps do not make as many of a cage.
inline std::vector<std::string> models_of(Scheme const& scheme)
{
    std::vector<std::string> out = cages_of(scheme);
    if (kSlow || scheme.info().takes.steps > 1) return out;
    for (char const* large : {"models/bigguy.obj", "models/knight_tri_1k.obj"})
        if (std::filesystem::exists(shared(large)) && takes(scheme, shared(large).string())) {
            out.push_back(shared(large).string());
            break;
        }
    return out;
}

/// A cage without a boundary: quads where the scheme takes them, else triangles.
inline std::string closed_cage_of(Scheme const& scheme)
{
    for (char const* model : {"golem", "spindle"})
        if (takes(scheme, model)) return model;
    ADD_FAILURE() << scheme.info().name << " takes no closed cage";
    return "golem";
}

} // namespace tessemu::test
