// What several verbs ask for: their options as typed values, and how text becomes them.
//
// Parsers take (text, option) and throw Error that names the option, the text and what is allowed.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/command_line.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/scheme.h"

namespace tessemu {

/// MODEL, --scheme, --set, --subdivide, --join, --strict, --table-cache
struct ModelRequest {
    std::string model; ///< a path, "-" or a built-in's name
    Scheme const* scheme = nullptr;
    BuildOptions build;
    /// Folder of basis-function tables; "none"; without a value the user's own.
    std::optional<std::string> table_cache;
};

/// --normals, --contraction, --lanes
struct ShadingRequest {
    enum class Normals { Frozen, True, Displaced };
    struct Products { ///< what becomes of those that feed sums
        Contraction contraction = Contraction::None;
        std::uint64_t seed = 0;
    };
    Normals normals = Normals::Frozen;
    Products products;
    int lanes = kNativeLanes;

    Machine machine() const { return {lanes, products.contraction, products.seed}; }
};

/// --displace, --displace-scale, --displace-wrap
struct DisplaceRequest {
    struct Heights {
        enum class Kind { None, Studs, Image };
        Kind kind = Kind::None;
        std::string image; ///< its path
    };
    Heights heights;
    std::optional<double> scale; ///< of a white texel; by default a share of the model's diagonal
    std::optional<HeightWrap> wrap; ///< of an image; by default it repeats
};

/// --animate, --phase, and of draw --frames
struct AnimateRequest {
    enum class Motion { None, Sway };
    Motion motion = Motion::None;
    double phase = 0;
    int frames = 1;
};

inline constexpr double kDefaultTessFactor = 8;

/// What verbs that tessellate a surface share.
struct SurfaceRequest {
    ModelRequest model;
    ShadingRequest shading;
    std::optional<double> tess;               ///< by default kDefaultTessFactor
    std::optional<Partitioning> partitioning; ///< by default fractional_odd
    DisplaceRequest displace;
    AnimateRequest animate;
    bool direct3d10 = false;
    std::optional<RefinementPattern> pattern;     ///< of that path; by default the tessellator's
    std::optional<VertexCacheModel> vertex_cache; ///< where the verb models one
};

/// --size
struct PictureSize {
    int width = 0, height = 0;
    float aspect() const { return float(width) / float(height); }
};

/// --camera
struct CameraRequest {
    glm::vec3 from{0.5f, 0.5f, 1.0f};      ///< direction to the eye, where the model is framed
    std::optional<glm::dvec3> eye, target; ///< in the frame of the model's file
    std::optional<glm::vec3> up;
    std::optional<float> focal;

    bool is_placed() const { return eye || target || up || focal; }
};

/// --size, --camera, --tess-edge
struct PictureRequest {
    PictureSize size;
    CameraRequest camera;
    AdaptiveFactors tess_edge; ///< distances in the frame of the model's file
};

/// -j, --json
struct RunRequest {
    int threads = 0;
    std::string json; ///< empty: none; "-": standard output
};

void add_options(Verb& verb, ModelRequest& o);
/// MODEL, --set, --join, --strict alone: for no scheme. \param parameters  what --set may be
void add_mesh_options(Verb& verb, ModelRequest& o, std::string const& parameters);
/// What a verb offers of --normals.
enum class NormalWords { Smooth, AndDisplaced };
void add_options(Verb& verb, ShadingRequest& o, NormalWords words = NormalWords::Smooth);
/// --contraction, --lanes alone
void add_machine(Verb& verb, ShadingRequest& o);
/// With the model's and the shading's.
void add_options(Verb& verb, SurfaceRequest& o, NormalWords words = NormalWords::Smooth);
/// --lanes, --table-cache of all cases of a sweep
void add_machine_of_sweep(Verb& verb, int& lanes, std::optional<std::string>& table_cache);
void add_options(Verb& verb, PictureRequest& o);
void add_options(Verb& verb, RunRequest& o);
void add_partitioning(Verb& verb, Partitioning& partitioning);
void add_vertex_cache(Verb& verb, SurfaceRequest& o);
void add_json(Verb& verb, std::string& path);
/// Of a comparison: 1 to 6.
void add_level(Verb& verb, int& level, std::string const& about);

/// Throws Error where an option needs another one.
void check_request(SurfaceRequest const& o);

// Settings by name, as a user writes them and results hold them.
std::string name_of(ShadingRequest::Normals normals);
std::string name_of(ShadingRequest::Products const& products);
std::string name_of(AdaptiveFactors const& factors);
std::string name_of(DisplaceRequest::Heights const& heights); ///< an image without its folder
std::string name_of(HeightWrap wrap);
std::string name_of(AnimateRequest::Motion motion);

[[noreturn]] void refuse(std::string const& text, std::string const& option,
                         std::string const& allowed);

/// A finite number. Refuses any other text.
double finite_number(std::string const& text, std::string const& option);
/// The same, or infinite or NaN, for options that name their own limits.
double any_number(std::string const& text, std::string const& option);
std::int64_t whole_number(std::string const& text, std::string const& option, std::int64_t low,
                          std::int64_t high);
std::vector<std::string> split(std::string const& text, char separator);

/// Where a result goes: not empty.
std::string output_path(std::string const& text, std::string const& option);

/// Parser of a whole number.
template <class Int> auto whole(Int low, Int high)
{
    return [low, high](std::string const& text, std::string const& option) {
        return Int(whole_number(text, option, low, high));
    };
}

/// Parser of one of some words.
template <class T> auto one_of(std::vector<std::pair<std::string, T>> words)
{
    return [words = std::move(words)](std::string const& text, std::string const& option) {
        std::vector<std::string> allowed;
        for (auto const& [word, value] : words) {
            if (word == text) return value;
            allowed.push_back(word);
        }
        refuse(text, option, in_words(allowed));
    };
}

} // namespace tessemu
