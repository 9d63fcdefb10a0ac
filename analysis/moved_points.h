// A surface whose points are moved, so that what is too small to be seen shows.
//
// A decorator: a patch mesh whose draws are another's with a move behind the end of their domain
// shader, or of their vertex shader where no tessellator makes the points. The draws themselves
// give points in object space and know nothing of it.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/commands/patch_mesh.h"

namespace tessemu {

struct PointMoves {
    /// Every point goes so far along its normal, out or in by the parity of its bits: points that
    /// differ in a last bit come apart. 0: none moves.
    float parity = 0;
    /// x/w and y/w are rounded to multiples of 1/lattice, so that edges run through many samples.
    /// 0: they are not.
    float lattice = 0;
};

class MovedPoints final : public PatchMesh {
public:
    /// Refers to `patches`, whose points may be moved ones already.
    MovedPoints(PatchMesh const& patches, PointMoves const& moves)
        : PatchMesh(patches.shared_mesh()),
          patches_(patches),
          moves_(moves)
    {
    }
    /// Throws Error where a draw writes neither ShadedVertex nor DisplacedVertex records.
    CommandList commands(SurfaceSettings const& settings) const override;
    std::vector<PatchCount> patch_counts() const override { return patches_.patch_counts(); }
    bool has_creases() const override { return patches_.has_creases(); }
    std::vector<std::string> warnings() const override { return patches_.warnings(); }

private:
    PatchMesh const& patches_;
    PointMoves moves_;
};

} // namespace tessemu
