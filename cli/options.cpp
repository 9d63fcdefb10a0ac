// SPDX-License-Identifier: Apache-2.0
#include "cli/options.h"

#include "io/image_reader.h"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cmath>

namespace tessemu {

namespace {

double number(std::string const& text, std::string const& option)
{
    std::size_t end = 0;
    double x = NAN;
    try {
        x = std::stod(text, &end);
    } catch (std::exception const&) {
        end = 0;
    }
    if (end == 0 || end != text.size() || !std::isfinite(x))
        throw Error(option + ": '" + text + "' is not a number");
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

glm::vec3 parse_vector(std::string const& text)
{
    auto const parts = split(text, ',');
    if (parts.size() != 3) throw Error("--camera: '" + text + "' is not X,Y,Z");
    return {float(number(parts[0], "--camera")), float(number(parts[1], "--camera")),
            float(number(parts[2], "--camera"))};
}

} // namespace

std::pair<int, int> parse_size(std::string const& text)
{
    auto const parts = split(text, 'x');
    if (parts.size() != 2) throw Error("--size is '" + text + "', it must be WIDTHxHEIGHT");
    int out[2];
    for (std::size_t i = 0; i < 2; ++i) {
        double const x = number(parts[i], "--size");
        if (x != std::floor(x) || x < 1 || x > ColorTarget::kMaxSize)
            throw Error(fmt::format("--size: {} is not a whole number from 1 to {}", parts[i],
                                    ColorTarget::kMaxSize));
        out[i] = int(x);
    }
    return {out[0], out[1]};
}

Camera parse_camera(std::string const& text, std::span<glm::vec3 const> points,
                    float width_over_height)
{
    glm::vec3 from(0.5f, 0.5f, 1.0f);
    std::optional<glm::vec3> eye, target, up;
    std::optional<float> focal;
    if (text != "auto") {
        for (std::string const& part : split(text, ':')) {
            std::size_t const equals = part.find('=');
            std::string const key = part.substr(0, equals);
            std::string const value = equals == std::string::npos ? "" : part.substr(equals + 1);
            if (key == "from")
                from = parse_vector(value);
            else if (key == "eye")
                eye = parse_vector(value);
            else if (key == "target")
                target = parse_vector(value);
            else if (key == "up")
                up = parse_vector(value);
            else if (key == "focal")
                focal = float(number(value, "--camera focal"));
            else
                throw Error("--camera: '" + part +
                            "' is not auto, from=, eye=, target=, up= or focal=");
        }
    }
    if (from.x == 0 && from.y == 0 && from.z == 0)
        throw Error("--camera: from=0,0,0 is no direction");
    Camera camera = frame_points(points, from, width_over_height);
    if (target) camera.target = *target;
    if (eye) camera.eye = *eye;
    if (up) camera.up = *up;
    if (focal) camera.focal = *focal;
    if (!(camera.focal > 0)) throw Error("--camera: focal must be above 0");
    if (camera.eye == camera.target) throw Error("--camera: eye and target are the same point");
    if (eye || target) fit_depth_range(camera, points);
    return camera;
}

Machine parse_machine(Options const& o)
{
    Machine m;
    m.lanes = o.lanes;
    if (o.contraction == "all") {
        m.contraction = Contraction::All;
    } else if (o.contraction.starts_with("mixed:")) {
        double const seed = number(o.contraction.substr(6), "--contraction mixed");
        if (seed < 0 || seed != std::floor(seed) || seed > 9e15)
            throw Error("--contraction: the seed must be a whole number, 0 or above");
        m.contraction = Contraction::Mixed;
        m.seed = std::uint64_t(seed);
    } else if (o.contraction != "none") {
        throw Error("--contraction is '" + o.contraction + "', it must be none, all or mixed:SEED");
    }
    return m;
}

std::map<std::string, double> parse_parameters(Options const& o)
{
    std::map<std::string, double> out;
    for (std::string const& s : o.set) {
        std::size_t const equals = s.find('=');
        if (equals == std::string::npos) throw Error("--set is '" + s + "', it must be NAME=VALUE");
        out[s.substr(0, equals)] = number(s.substr(equals + 1), "--set " + s.substr(0, equals));
    }
    return out;
}

std::optional<std::pair<double, double>> parse_error_max(std::string const& text)
{
    if (text == "auto") return {};
    auto const parts = split(text, ',');
    if (parts.size() != 2)
        throw Error("--error-max is '" + text + "', it must be auto or POSITION,ANGLE");
    std::pair const out(number(parts[0], "--error-max"), number(parts[1], "--error-max"));
    if (!(out.first > 0 && out.second > 0))
        throw Error("--error-max is '" + text + "', both must be above 0");
    return out;
}

AdaptiveFactors parse_tess_edge(std::string const& text)
{
    if (text == "none") return {};
    std::size_t const equals = text.find('=');
    std::string const key = text.substr(0, equals);
    if (equals == std::string::npos || (key != "pixels" && key != "distance"))
        throw Error("--tess-edge is '" + text + "', it must be none, pixels=P or distance=D");
    double const value = number(text.substr(equals + 1), "--tess-edge " + key);
    if (!(value > 0 && value < 1e30))
        throw Error(fmt::format("--tess-edge: {} is {}, it must be above 0", key, value));
    return {key == "pixels" ? AdaptiveFactors::Kind::Pixels : AdaptiveFactors::Kind::Distance,
            float(value)};
}

std::shared_ptr<Displacement const> parse_displacement(Options const& o, Topology const& topology)
{
    if (o.displace == "none") {
        if (o.displace_scale) throw Error("--displace-scale needs --displace");
        return {};
    }
    glm::vec3 low(INFINITY), high(-INFINITY);
    for (glm::vec3 const& p : topology.mesh().positions) low = min(low, p), high = max(high, p);
    float const diagonal = glm::length(high - low);
    float const scale = o.displace_scale ? float(*o.displace_scale) : 0.01f * diagonal;
    if (!std::isfinite(scale))
        throw Error(fmt::format("--displace-scale is {}, it must be a finite number", scale));
    if (o.displace == "studs")
        return std::make_shared<Displacement>(Displacement::studs(diagonal / 16, scale));
    HeightImage const image = read_height_image(o.displace);
    try {
        return std::make_shared<Displacement>(topology, image, scale);
    } catch (Error const& e) {
        throw Error(o.model + ": " + e.what());
    }
}

std::vector<FramePose> parse_frames(Options const& o, ControlMesh const& mesh)
{
    if (o.animate != "none" && o.animate != "sway")
        throw Error("--animate is '" + o.animate + "', it must be none or sway");
    if (o.frames < 1 || o.frames > 10000)
        throw Error(fmt::format("--frames is {}, it must be 1 to 10000", o.frames));
    if (!std::isfinite(o.phase))
        throw Error(fmt::format("--phase is {}, it must be a finite number", o.phase));
    if (o.animate == "none") {
        if (o.frames > 1 || o.phase != 0) throw Error("--frames and --phase need --animate");
        return {{}};
    }
    SpineRig const rig(mesh);
    std::vector<FramePose> out;
    for (int i = 0; i < o.frames; ++i) {
        double const phase = o.phase + double(i) / o.frames;
        out.push_back({phase, std::make_shared<Pose>(rig.sway(phase))});
    }
    return out;
}

CullMode parse_cull(std::string const& text)
{
    if (text == "none") return CullMode::None;
    if (text == "back") return CullMode::Back;
    if (text == "front") return CullMode::Front;
    throw Error("--cull is '" + text + "', it must be none, back or front");
}

} // namespace tessemu
