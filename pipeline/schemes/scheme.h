// A scheme: a paper's way from a control mesh to draws.
//
// A scheme is a class in a folder of its own beside this file, its shaders are in the folder of the
// same name in shaders_cpp, and one line of registry.cpp makes it known. What meshes it takes and
// which parameters it has is data: the registry refuses, refines, warns and lists from it.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/commands/patch_mesh.h"
#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/mesh/file_lines.h"
#include "pipeline/mesh/placement.h"
#include "pipeline/mesh/warnings.h"

#include <limits>
#include <map>
#include <optional>
#include <variant>

namespace tessemu {

class BasisTableStore;

/// A free choice that a user may set: a number within limits, or one of some words.
struct SchemeParameter {
    std::string name, meaning;
    std::optional<double> default_value = 0.0; ///< none: has a value only where one is given
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    std::vector<std::string> words = {}; ///< not empty: one of these, the first by default
};

/// Resolved values of a scheme's parameters.
class Parameters {
public:
    using Value = std::variant<double, std::string>;

    double number(std::string const& name) const { return std::get<double>(values_.at(name)); }
    /// Of a number that has no default.
    std::optional<double> number_if_given(std::string const& name) const
    {
        auto const found = values_.find(name);
        if (found == values_.end()) return {};
        return std::get<double>(found->second);
    }
    std::string const& word(std::string const& name) const
    {
        return std::get<std::string>(values_.at(name));
    }
    std::map<std::string, Value> const& values() const { return values_; }
    void set(std::string const& name, Value value) { values_[name] = std::move(value); }

private:
    std::map<std::string, Value> values_;
};

/// What meshes a scheme takes.
struct MeshRequirements {
    /// Without quads: other faces are cut into triangles, with a warning.
    bool quads = true, triangles = true, boundary = true;
    bool creases = false, corners = false; ///< honoured; otherwise drawn smooth, with a warning
    std::uint32_t edges = kAnyNumber;      ///< at a vertex, at most
    static constexpr std::uint32_t kAnyNumber = std::numeric_limits<std::uint32_t>::max();
    /// Steps of subdivision that the scheme asks for: of a mesh of triangles and quads, and where a
    /// face has more sides.
    int steps = 0, steps_with_polygons = 1;
    /// And where a face is a triangle; without a value: `steps`.
    std::optional<int> steps_with_triangles = {};
    RefinementStep step = catmull_clark_step;
};

struct SchemeInfo {
    std::string name;    ///< as on the command line
    std::string paper;   ///< "LOOP09"
    std::string section; ///< "3, 4.3, 4.6"
    std::string summary;
    MeshRequirements takes = {};
    std::vector<SchemeParameter> parameters = {};
    /// Parameters under which patches that meet give their shared points equal bits, where the
    /// defaults do not promise it: those of a scheme that draws as its paper does.
    std::vector<std::pair<std::string, std::string>> watertight_with = {};
    /// Whether hull shader, tessellator and domain shader make its points. Otherwise it takes one
    /// number of segments, no partitioning, no factors by edge and no Direct3D 10 path.
    bool tessellator = true;
    /// Why it has no mean curvature to show; empty: it has (shaders_cpp/curvature.h).
    std::string no_curvature = "its domain shaders give no second derivatives";
};

/// What a scheme may use while it builds; each may be none.
struct BuildServices {
    BasisTableStore* tables = nullptr; ///< where basis-function tables are kept
    WarningSink warn = {};             ///< hears what is worth telling before the build is done
    RefinementProgress progress = {};
    ThreadPool const* threads = nullptr; ///< that help; without any the calling thread builds alone
};

class Scheme {
public:
    virtual ~Scheme() = default;
    virtual SchemeInfo info() const = 0;
    /// Sets the mesh's rules of subdivision from the parameters, all of info().parameters, before a
    /// step is taken. May warn, and throw MeshError for a mesh to which those rules do not apply.
    virtual void set_rules(ControlMesh& /*mesh*/, Parameters const& /*parameters*/,
                           WarningSink const& /*warn*/) const
    {
    }
    /// Of subdivision, beyond what info().takes asks for.
    virtual int more_steps(Parameters const& /*parameters*/) const { return 0; }
    /// \param mesh        that meets info().takes
    /// \param parameters  all of info().parameters
    /// \param services    not kept
    virtual std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const> mesh,
                                             Parameters const& parameters,
                                             BuildServices const& services) const = 0;
};

/// All schemes in the order of the papers.
std::vector<std::unique_ptr<Scheme>> const& schemes();
/// Throws Error that lists the known names.
Scheme const& find_scheme(std::string_view name);
/// Throws Error that says why, and which schemes have it, where a scheme has no curvature to show.
void check_curvature(SchemeInfo const& info);
/// "quads and triangles, closed meshes only; creases are drawn smooth"
std::string in_words(MeshRequirements const& takes);

/// "sort", which every scheme has where steps of subdivision are taken.
SchemeParameter const& sort_parameter();
/// "coordinates", which every scheme has where steps are taken of a mesh that has some.
SchemeParameter const& coordinates_parameter();

/// NAME, VALUE as a user wrote them.
using ParameterTexts = std::vector<std::pair<std::string, std::string>>;
/// The scheme's parameters, those not given at their defaults, where they have one;
/// sort_parameter() and coordinates_parameter() where they are given. Throws Error that names the parameter, the value and what is
/// allowed.
Parameters resolve_parameters(SchemeInfo const& info, ParameterTexts const& given);

/// A mesh under a scheme: what draws, checks and comparisons start from.
struct SchemeOnMesh {
    std::shared_ptr<RefinedMesh const> mesh;
    std::unique_ptr<PatchMesh> patches;
    Parameters parameters;             ///< with sort_parameter() where steps are taken
    std::vector<std::string> warnings; ///< what was refined, what could not be honoured
};

struct BuildOptions {
    /// Steps of subdivision beyond those that the scheme asks for, 0 to 6.
    int subdivide = 0;
    ParameterTexts set = {};
    /// Joins vertices that lie within this distance, in the file's units, before all else.
    std::optional<double> join = {};
    Placement placement = {}; ///< of the mesh in its file
    /// Refuses a mesh that would have to be cut, to lose faces, or to be drawn in another way.
    bool strict = false;
    /// Of the mesh's file, for warnings.
    FileLines lines = {};
    /// Hears the warnings, those before an error before it is thrown.
    WarningSink warn = {};
    RefinementProgress progress = {};
    BasisTableStore* tables = nullptr;   ///< for schemes that use some
    ThreadPool const* threads = nullptr; ///< that help to build; none: the calling thread alone
};

/// Joins vertices if asked to, makes the mesh a manifold, checks it, sorts and refines it as
/// options and scheme ask, and builds. Throws MeshError for a mesh that the scheme does not take,
/// or, if strict, that is no manifold, naming a face of the given mesh; LimitError; Error, also for
/// a sort or smooth coordinates that are asked for where no step is taken.
SchemeOnMesh build_scheme(Scheme const& scheme, ControlMesh mesh, BuildOptions const& options = {});
/// The mesh alone, refined as for the scheme, whether it takes it or not: `patches` is none.
SchemeOnMesh refine_for_scheme(Scheme const& scheme, ControlMesh mesh,
                               BuildOptions const& options = {});
/// The mesh alone after options.subdivide steps and no more: parameters are sort_parameter() and coordinates_parameter().
SchemeOnMesh refine_for_no_scheme(RefinementStep step, ControlMesh mesh,
                                  BuildOptions const& options = {});

} // namespace tessemu
