// SPDX-License-Identifier: Apache-2.0
#include "cli/options.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>

namespace tessemu {

void refuse(std::string const& text, std::string const& option, std::string const& allowed)
{
    throw Error(option + " is '" + text + "', it must be " + allowed);
}

double any_number(std::string const& text, std::string const& option)
{
    std::string_view const digits = std::string_view(text).substr(text.starts_with('+') ? 1 : 0);
    double x = 0;
    auto const [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), x);
    if (error != std::errc() || end != digits.data() + digits.size())
        throw Error(option + ": '" + text + "' is not a number");
    return x;
}

double finite_number(std::string const& text, std::string const& option)
{
    double const x = any_number(text, option);
    if (!std::isfinite(x)) throw Error(option + ": '" + text + "' is not a number");
    return x;
}

std::int64_t whole_number(std::string const& text, std::string const& option, std::int64_t low,
                          std::int64_t high)
{
    std::int64_t x = 0;
    auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (error == std::errc::invalid_argument || end != text.data() + text.size())
        throw Error(option + ": '" + text + "' is not a whole number");
    if (error != std::errc() || x < low || x > high)
        throw Error(fmt::format("{} is {}, it must be {} to {}", option, text, low, high));
    return x;
}

std::vector<std::string> split(std::string const& text, char separator)
{
    std::vector<std::string> parts(1);
    for (char c : text) {
        if (c == separator)
            parts.emplace_back();
        else
            parts.back() += c;
    }
    return parts;
}

std::string output_path(std::string const& text, std::string const& option)
{
    if (text.empty()) refuse(text, option, "a file's name, or - for standard output");
    return text;
}

namespace {

Scheme const* parse_scheme(std::string const& text, std::string const&)
{
    return &find_scheme(text);
}

std::pair<std::string, std::string> parse_parameter(std::string const& text,
                                                    std::string const& option)
{
    std::size_t const equals = text.find('=');
    if (equals == std::string::npos) refuse(text, option, "NAME=VALUE");
    return {text.substr(0, equals), text.substr(equals + 1)};
}

ShadingRequest::Products parse_contraction(std::string const& text, std::string const& option)
{
    if (text == "none") return {};
    if (text == "all") return {Contraction::All, 0};
    std::string const mixed = "mixed:";
    if (!text.starts_with(mixed)) refuse(text, option, "none, all or mixed:SEED");
    double const seed = finite_number(text.substr(mixed.size()), option + " mixed");
    if (seed < 0 || seed != std::floor(seed) || seed > 9e15)
        throw Error(option + ": the seed must be a whole number, 0 or above");
    return {Contraction::Mixed, std::uint64_t(seed)};
}

int parse_lanes(std::string const& text, std::string const& option)
{
    int const lanes = int(whole_number(text, option, INT32_MIN, INT32_MAX));
    try {
        check_lanes(lanes);
    } catch (Error const& e) {
        throw Error(std::string("--") + e.what());
    }
    return lanes;
}

double parse_tess(std::string const& text, std::string const& option)
{
    double const x = any_number(text, option);
    if (!(x > 0 && x <= kMaxTessFactor))
        throw Error(
            fmt::format("{} is {}, it must be above 0 and at most {}", option, x, kMaxTessFactor));
    return x;
}

Partitioning parse_partitioning(std::string const& text, std::string const& option)
{
    auto const p = partitioning_from_name(text);
    if (!p) refuse(text, option, "integer, pow2, fractional_odd or fractional_even");
    return *p;
}

constexpr char const* kPartitioningHelp =
    "integer, pow2, fractional_odd, fractional_even; pow2 acts as integer, and 5 stays 5: rounding "
    "to powers of two is the hull shader's part (R59)";

DisplaceRequest::Heights parse_heights(std::string const& text, std::string const&)
{
    using Kind = DisplaceRequest::Heights::Kind;
    if (text == "none") return {};
    if (text == "studs") return {Kind::Studs, ""};
    return {Kind::Image, text};
}

// Finite as a float too.
double parse_finite(std::string const& text, std::string const& option)
{
    double const x = any_number(text, option);
    if (!std::isfinite(float(x)))
        throw Error(fmt::format("{} is {}, it must be a finite number", option, x));
    return x;
}

double parse_distance(std::string const& text, std::string const& option)
{
    double const x = finite_number(text, option);
    if (x < 0) throw Error(fmt::format("{} is {}, it must be 0 or more", option, text));
    return x;
}

PictureSize parse_size(std::string const& text, std::string const& option)
{
    auto const parts = split(text, 'x');
    if (parts.size() != 2) refuse(text, option, "WIDTHxHEIGHT");
    int out[2];
    for (std::size_t i = 0; i < 2; ++i) {
        double const x = finite_number(parts[i], option);
        if (x != std::floor(x) || x < 1 || x > ColorTarget::kMaxSize)
            throw Error(fmt::format("{}: {} is not a whole number from 1 to {}", option, parts[i],
                                    ColorTarget::kMaxSize));
        out[i] = int(x);
    }
    return {out[0], out[1]};
}

glm::dvec3 parse_point(std::string const& text, std::string const& option)
{
    auto const parts = split(text, ',');
    if (parts.size() != 3) throw Error(option + ": '" + text + "' is not X,Y,Z");
    return {finite_number(parts[0], option), finite_number(parts[1], option),
            finite_number(parts[2], option)};
}

// Of whatever length.
glm::vec3 parse_direction(std::string const& key, std::string const& text,
                          std::string const& option)
{
    glm::dvec3 const d = parse_point(text, option);
    int exponent = 0;
    std::frexp(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}), &exponent);
    if (d == glm::dvec3(0)) throw Error(option + ": " + key + "=" + text + " is no direction");
    if (std::abs(exponent) <= 20) return glm::vec3(d);
    return {float(std::ldexp(d.x, -exponent)), float(std::ldexp(d.y, -exponent)),
            float(std::ldexp(d.z, -exponent))};
}

float parse_focal(std::string const& text, std::string const& option)
{
    float const focal = float(finite_number(text, option));
    if (!(focal > 0 && std::isfinite(focal)))
        throw Error(option + " is " + text + ", it must be above 0, in single precision");
    return focal;
}

CameraRequest parse_camera(std::string const& text, std::string const& option)
{
    CameraRequest out;
    if (text == "auto") return out;
    for (std::string const& part : split(text, ':')) {
        std::size_t const equals = part.find('=');
        std::string const key = part.substr(0, equals);
        std::string const value = equals == std::string::npos ? "" : part.substr(equals + 1);
        if (key == "from")
            out.from = parse_direction(key, value, option);
        else if (key == "eye")
            out.eye = parse_point(value, option);
        else if (key == "target")
            out.target = parse_point(value, option);
        else if (key == "up")
            out.up = parse_direction(key, value, option);
        else if (key == "focal")
            out.focal = parse_focal(value, option + ": focal");
        else
            throw Error(option + ": '" + part +
                        "' is not auto, from=, eye=, target=, up= or focal=");
    }
    return out;
}

AdaptiveFactors parse_tess_edge(std::string const& text, std::string const& option)
{
    if (text == "none") return {};
    std::size_t const equals = text.find('=');
    std::string const key = text.substr(0, equals);
    if (equals == std::string::npos || (key != "pixels" && key != "distance"))
        refuse(text, option, "none, pixels=P or distance=D");
    double const value = finite_number(text.substr(equals + 1), option + " " + key);
    if (!(value > 0 && (key == "distance" || value < 1e30)))
        throw Error(fmt::format("{}: {} is {}, it must be above 0", option, key, value));
    return {key == "pixels" ? AdaptiveFactors::Kind::Pixels : AdaptiveFactors::Kind::Distance,
            value};
}

VertexCacheModel parse_vertex_cache(std::string const& text, std::string const&)
{
    return vertex_cache_from_name(text);
}

std::string parse_table_cache(std::string const& text, std::string const& option)
{
    if (text.empty()) throw Error(option + " is empty, it must be a folder or none");
    return text;
}

void add_table_cache(Verb& verb, std::optional<std::string>& folder)
{
    verb.option("--table-cache", folder, parse_table_cache,
                "folder where a scheme's basis-function tables are kept from run to run, or none "
                "[$XDG_CACHE_HOME/tessemu, else ~/.cache/tessemu]");
}

void add_lanes(Verb& verb, int& lanes)
{
    verb.option("--lanes", lanes, parse_lanes, "4, 8 or 16; changes no result",
                std::to_string(kNativeLanes));
}

} // namespace

void add_options(Verb& verb, ModelRequest& o)
{
    add_mesh_options(verb, o,
                     "NAME=VALUE: a parameter of the scheme, or of steps of subdivision: "
                     "sort=valence, the order of their mesh; coordinates=smooth, texture "
                     "coordinates by their masks; again for another one");
    verb.option("--scheme", o.scheme, parse_scheme, "patch scheme, see 'tessemu schemes'",
                "gregory-stencil");
    verb.option(
        "--subdivide", o.build.subdivide, whole(0, 6),
        "steps of subdivision of the mesh before the scheme (Catmull-Clark; before a scheme "
        "of triangles Loop), beyond those that it asks for, 0 to 6; they run as compute "
        "shaders (LOOP10 3) and are counted",
        "0");
}

void add_mesh_options(Verb& verb, ModelRequest& o, std::string const& parameters)
{
    verb.required("MODEL", o.model, plain,
                  "OBJ file, - for standard input, or built-in cage, see 'tessemu models'");
    verb.repeated("--set", o.build.set, parse_parameter, parameters);
    verb.option("--join", o.build.join, parse_distance,
                "join vertices that lie within this distance of each other, in the file's own unit "
                "of length; 0 joins equal positions; the lowest number stays");
    verb.flag("--strict", o.build.strict,
              "refuse a mesh that would have to be cut or lose faces, instead of warning");
    add_table_cache(verb, o.table_cache);
}

void add_machine_of_sweep(Verb& verb, int& lanes, std::optional<std::string>& table_cache)
{
    add_lanes(verb, lanes);
    add_table_cache(verb, table_cache);
}

void add_options(Verb& verb, ShadingRequest& o, NormalWords offered)
{
    using Normals = ShadingRequest::Normals;
    std::vector<std::pair<std::string, Normals>> words{{"frozen", Normals::Frozen},
                                                       {"true", Normals::True}};
    std::string about = "inside a patch: frozen (LOOP09 4.4) or true, of the smooth surface";
    if (offered == NormalWords::AndDisplaced) {
        words.emplace_back("displaced", Normals::Displaced);
        about += "; displaced: of the displaced one, moved along its true normals";
    }
    verb.option("--normals", o.normals, one_of(std::move(words)), about, "frozen");
    add_machine(verb, o);
}

void add_machine(Verb& verb, ShadingRequest& o)
{
    verb.option("--contraction", o.products, parse_contraction,
                "products that feed sums: none, all, mixed:SEED", "none");
    add_lanes(verb, o.lanes);
}

void add_options(Verb& verb, SurfaceRequest& o, NormalWords words)
{
    add_options(verb, o.model);
    verb.option("--tess", o.tess, parse_tess,
                fmt::format("tess factor of every edge and inside, above 0 to 64; not used where "
                            "patches have levels of their own (bolz with --set adapt=D) [{}]",
                            kDefaultTessFactor));
    verb.option("--partitioning", o.partitioning, parse_partitioning,
                std::string(kPartitioningHelp) + " [fractional_odd]");
    add_options(verb, o.shading, words);
    verb.option("--displace", o.displace.heights, parse_heights,
                "along the normal: studs, a pattern in space; or an image on the mesh's texture "
                "coordinates, whose first channel counts as it is; or none",
                "none");
    verb.option("--displace-scale", o.displace.scale, finite_number,
                "displacement of a white texel, in the model's units [0.01 of its diagonal]");
    verb.option("--displace-wrap", o.displace.wrap,
                one_of<HeightWrap>({{"repeat", HeightWrap::Repeat},
                                    {"clamp", HeightWrap::Clamp},
                                    {"mirror", HeightWrap::Mirror}}),
                "of an image, beyond its border: repeat, clamp, mirror [repeat]");
    using Motion = AnimateRequest::Motion;
    verb.option("--animate", o.animate.motion,
                one_of<Motion>({{"none", Motion::None}, {"sway", Motion::Sway}}),
                "sway: bones along the model's longest side, bent by a wave; or none", "none");
    verb.option("--phase", o.animate.phase, parse_finite, "where the motion begins, in periods",
                "0");
    verb.option("--direct3d", o.direct3d10, one_of<bool>({{"10", true}, {"11", false}}),
                "11: hull shader, tessellator, domain shader; 10: geometry shader, stream output, "
                "instances (LOOP09 5)",
                "11");
    verb.option("--pattern", o.pattern,
                one_of<RefinementPattern>({{"tessellator", RefinementPattern::Tessellator},
                                           {"uniform", RefinementPattern::Uniform}}),
                "points of a patch with --direct3d 10: tessellator, Direct3D 11's; uniform, all at "
                "i/n, n being --tess rounded up to a power of two (HOLL10) [tessellator]");
}

void add_options(Verb& verb, PictureRequest& o)
{
    verb.option("--size", o.size, parse_size, "WIDTHxHEIGHT in pixels", "1024x1024");
    verb.option("--camera", o.camera, parse_camera,
                "auto, from=X,Y,Z, or eye=X,Y,Z:target=X,Y,Z:up=X,Y,Z:focal=F", "auto");
    verb.option("--tess-edge", o.tess_edge, parse_tess_edge,
                "factors edge by edge: pixels=P, segments of about P pixels; distance=D, --tess at "
                "distance D and falling with it; none: --tess everywhere",
                "none");
}

void add_options(Verb& verb, RunRequest& o)
{
    verb.option("-j", o.threads, whole(0, 1024), "threads; 0: all cores", "0");
    add_json(verb, o.json);
}

void add_partitioning(Verb& verb, Partitioning& partitioning)
{
    verb.option("--partitioning", partitioning, parse_partitioning, kPartitioningHelp,
                "fractional_odd");
}

void add_vertex_cache(Verb& verb, SurfaceRequest& o)
{
    verb.option("--vertex-cache", o.vertex_cache, parse_vertex_cache,
                "none, fifo:N, lru:N, infinite", "fifo:16");
}

void add_json(Verb& verb, std::string& path)
{
    verb.option("--json", path, output_path, "write the result as JSON; '-' is standard output");
}

void add_level(Verb& verb, int& level, std::string const& about)
{
    verb.option("--level", level, whole(1, 6), about, "4");
}

namespace {
void check_tessellator(SurfaceRequest const& o)
{
    SchemeInfo const info = o.model.scheme->info();
    if (info.tessellator) return;
    if (o.partitioning)
        throw Error("--partitioning is the tessellator's, which " + info.name +
                    " does not have; --tess says how many segments an edge of a patch has");
    if (o.direct3d10)
        throw Error("--direct3d 10 is a path around the tessellator, which " + info.name +
                    " does not have");
}
} // namespace

void check_request(SurfaceRequest const& o)
{
    check_tessellator(o);
    if (o.pattern && !o.direct3d10)
        throw Error("--pattern is of instanced patterns, which --direct3d 10 draws; Direct3D 11's "
                    "points are its tessellator's");
    if (o.pattern == RefinementPattern::Uniform && o.partitioning)
        throw Error("--partitioning is the tessellator's; --pattern uniform has all points at i/n");
    if (o.displace.scale && o.displace.heights.kind == DisplaceRequest::Heights::Kind::None)
        throw Error("--displace-scale needs --displace");
    if (o.displace.wrap && o.displace.heights.kind != DisplaceRequest::Heights::Kind::Image)
        throw Error("--displace-wrap needs --displace IMAGE, --displace is " +
                    name_of(o.displace.heights));
    if (o.shading.normals == ShadingRequest::Normals::Displaced &&
        o.displace.heights.kind == DisplaceRequest::Heights::Kind::None)
        throw Error("--normals displaced needs --displace; the smooth surface's normals are true "
                    "and frozen");
    if (o.animate.motion == AnimateRequest::Motion::None &&
        (o.animate.frames > 1 || o.animate.phase != 0))
        throw Error("--frames and --phase need --animate");
}

std::string name_of(ShadingRequest::Normals normals)
{
    using Normals = ShadingRequest::Normals;
    return normals == Normals::Frozen ? "frozen" : normals == Normals::True ? "true" : "displaced";
}

std::string name_of(ShadingRequest::Products const& p)
{
    if (p.contraction == Contraction::None) return "none";
    return p.contraction == Contraction::All ? "all" : "mixed:" + std::to_string(p.seed);
}

std::string name_of(AdaptiveFactors const& f)
{
    if (f.kind == AdaptiveFactors::Kind::None) return "none";
    return fmt::format("{}={}", f.kind == AdaptiveFactors::Kind::Pixels ? "pixels" : "distance",
                       f.value);
}

std::string name_of(DisplaceRequest::Heights const& h)
{
    using Kind = DisplaceRequest::Heights::Kind;
    if (h.kind == Kind::None) return "none";
    return h.kind == Kind::Studs ? "studs" : std::filesystem::path(h.image).filename().string();
}

std::string name_of(HeightWrap wrap)
{
    return wrap == HeightWrap::Repeat ? "repeat" : wrap == HeightWrap::Clamp ? "clamp" : "mirror";
}

std::string name_of(AnimateRequest::Motion motion)
{
    return motion == AnimateRequest::Motion::None ? "none" : "sway";
}

} // namespace tessemu
