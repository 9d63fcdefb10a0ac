// Samples of limit surfaces that OpenSubdiv made: tests/golden/limit/*.csv.gz.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/model.h"
#include "tests/support/files.h"
#include "tests/support/gzip.h"

#include <glm/vec3.hpp>

#include <sstream>
#include <string>
#include <vector>

namespace tessemu::test {

struct LimitSamples {
    struct Sample {
        std::uint32_t face; ///< of the file, from 0 on
        int sub;            ///< the corner of a face that is no quad, or triangle of Loop's
        double u, v;        ///< from corner 0 to corners 1 and 3, or 2 of a triangle
        glm::dvec3 position, normal; ///< normal: 0 where there is none
        std::string line;
    };
    double diagonal = 0; ///< of the cage's box
    std::vector<Sample> samples;
};

inline LimitSamples read_limit_samples(std::filesystem::path const& path)
{
    LimitSamples out;
    std::istringstream in(read_gzip(path));
    std::string line;
    std::getline(in, line);
    out.diagonal = std::stod(line.substr(line.find("bbox_diag=") + 10));
    std::getline(in, line);
    while (std::getline(in, line)) {
        double c[10];
        std::istringstream row(line);
        for (double& x : c) {
            row >> x;
            row.ignore();
        }
        out.samples.push_back({std::uint32_t(c[0]),
                               int(c[1]),
                               c[2],
                               c[3],
                               {c[4], c[5], c[6]},
                               {c[7], c[8], c[9]},
                               line});
    }
    return out;
}

/// A file's positions in double: the reader's are floats.
inline std::vector<glm::dvec3> exact_positions(std::filesystem::path const& obj)
{
    std::vector<glm::dvec3> out;
    std::istringstream in(read_text(obj));
    for (std::string line, word; std::getline(in, line);) {
        std::istringstream words(line);
        glm::dvec3 p;
        if (words >> word && word == "v" && words >> p.x >> p.y >> p.z) out.push_back(p);
    }
    return out;
}

/// The boundary rule of the samples, where the file names none, is edge only.
inline ControlMesh mesh_of_samples(std::filesystem::path const& obj)
{
    ControlMesh mesh = load_model(obj.string()).mesh;
    if (read_text(obj).find("t interpolateboundary") == std::string::npos)
        mesh.rules.boundary = BoundaryRule::EdgeOnly;
    return mesh;
}

} // namespace tessemu::test
