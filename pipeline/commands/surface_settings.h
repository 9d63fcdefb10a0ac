// What a surface is drawn with, whatever looks at it: a picture, a checker, an export.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/machine.h"
#include "emu/tessellator.h"
#include "pipeline/mesh/animation.h"
#include "shaders_cpp/projection.h"
#include "shaders_cpp/tess_factor_rule.h"

namespace tessemu {

class Displacement;

/// Where the points of a patch come from on the Direct3D 10 path.
enum class RefinementPattern {
    Tessellator, ///< the tessellator's, of the tess factor and partitioning
    Uniform,     ///< all at i/n, n the tess factor rounded up to a power of two
};

struct SurfaceSettings {
    float tess_factor = 1;        ///< uniform; every edge and the inside of a patch
    TessFactorRule adaptive_rule; ///< instead of it, unless its kind is Uniform
    Partitioning partitioning = Partitioning::FractionalOdd;
    RefinementPattern pattern = RefinementPattern::Tessellator; ///< Direct3D 10 path only
    Machine machine;
    bool true_normals = false; ///< interior normals of the rational surface, not of frozen F
    std::shared_ptr<Displacement const> displacement; ///< none: the smooth surface
    std::shared_ptr<Pose const> pose;                 ///< none: the mesh at rest
    Matrix4 view_projection = kIdentity;              ///< from object space to clip space
    bool curvature = false; ///< with mean curvature where there is any; no displacement then

    TessFactorRule factor_rule() const
    {
        TessFactorRule rule = adaptive_rule;
        rule.uniform = tess_factor;
        return rule;
    }
};

} // namespace tessemu
