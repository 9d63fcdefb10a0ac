// Options as the user wrote them, and what they mean.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/frame.h"

namespace tessemu {

struct Options {
    std::string model, output, json;
    std::string scheme = "gregory-stencil", partitioning = "fractional_odd", size = "1024x1024";
    std::string camera = "auto", view = "lit", normals = "frozen", contraction = "none",
                cull = "none";
    std::string vertex_cache = "fifo:16", tess_edge = "none", displace = "none", animate = "none",
                error_max = "auto", mistake = "none";
    std::string reproduce, models = ".", machine = "gtx260";
    std::string domain = "quad", primitive = "triangle_cw", batch;
    std::vector<double> factors;
    std::vector<std::string> set;
    std::string other;
    double tess = 8, tolerance = 0, phase = 0;
    std::optional<double> displace_scale, parity;
    std::int64_t rays = 200000, mistaken_face = 0;
    std::optional<int> level;
    int lanes = kNativeLanes, threads = 0, samples = 1, frames = 1, direct3d = 11;
    bool weld = false, all = false, geometry_only = false;
};

// Each throws Error that names the option, the value and what is allowed.
std::pair<int, int> parse_size(std::string const& text);
/// auto, from=X,Y,Z, or eye=X,Y,Z with target=, up=, focal=, joined by colons.
Camera parse_camera(std::string const& text, std::span<glm::vec3 const> points,
                    float width_over_height);
Machine parse_machine(Options const& o);
std::map<std::string, double> parse_parameters(Options const& o);
/// auto, or POSITION,ANGLE: what is red; nothing for auto
std::optional<std::pair<double, double>> parse_error_max(std::string const& text);
/// none, pixels=P or distance=D
AdaptiveFactors parse_tess_edge(std::string const& text);
/// none, studs, or the path of an image; nothing for none. May read the file.
std::shared_ptr<Displacement const> parse_displacement(Options const& o, Topology const& topology);
/// The poses of the frames asked for; one without a pose where nothing is animated.
struct FramePose {
    double phase = 0;
    std::shared_ptr<Pose const> pose;
};
std::vector<FramePose> parse_frames(Options const& o, ControlMesh const& mesh);
CullMode parse_cull(std::string const& text);

} // namespace tessemu
