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
    std::string vertex_cache = "fifo:16", tess_edge = "none";
    std::string reproduce, models = ".";
    std::string domain = "quad", primitive = "triangle_cw", batch;
    std::vector<double> factors;
    std::vector<std::string> set;
    std::string other;
    double tess = 8, tolerance = 0;
    int lanes = kNativeLanes, threads = 0, samples = 1, level = 4;
    bool weld = false, all = false;
};

// Each throws Error that names the option, the value and what is allowed.
std::pair<int, int> parse_size(std::string const& text);
/// auto, from=X,Y,Z, or eye=X,Y,Z with target=, up=, focal=, joined by colons.
Camera parse_camera(std::string const& text, ControlMesh const& mesh, float width_over_height);
Machine parse_machine(Options const& o);
std::map<std::string, double> parse_parameters(Options const& o);
/// none, pixels=P or distance=D
AdaptiveFactors parse_tess_edge(std::string const& text);
CullMode parse_cull(std::string const& text);

} // namespace tessemu
