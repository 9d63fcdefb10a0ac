// Known mistakes, planted into a patch mesh so that a checker can show that it finds them.
//
// Each is a decorator: a patch mesh whose commands are another's with a shader, a table or an
// option of a draw replaced. What draws knows nothing of them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/watertight.h"

#include <memory>
#include <optional>
#include <string_view>

namespace tessemu {

enum class Mistake {
    None,
    Order,       ///< every patch sums its edges left to right in its own direction
    Contraction, ///< every patch sums its edges in its own direction by mirror pairs,
                 ///< (b0 p0 + b3 p3) + (b1 p1 + b2 p2), which looks symmetric and is not where
                 ///< products are fused; the machine contracts all (docs/watertight.md)
    Factors,     ///< one side of a shared edge gets another tess factor
    Normals,     ///< the patch's own cross product on edges
    Fold,        ///< one patch's winding is reversed
    Weights,     ///< the last bit of one patch's weight for a shared vertex is flipped
    TopLeft,     ///< a sample on an edge belongs to both triangles
};
inline constexpr Mistake kMistakes[] = {Mistake::Order,   Mistake::Contraction, Mistake::Factors,
                                        Mistake::Normals, Mistake::Fold,        Mistake::Weights,
                                        Mistake::TopLeft};
/// "none", "order", "contraction", "factors", "normals", "fold", "weights", "topleft"
std::string_view name_of(Mistake mistake);
std::optional<Mistake> mistake_from_name(std::string_view name);

struct PlantedMistake {
    Mistake kind = Mistake::None;
    std::uint32_t face = 0; ///< of the file's mesh: where one patch has it, the face's first one
};

/// A mistake in the first face that is drawn whose edges all have another such face beyond; where
/// there is none, in the first that is drawn.
PlantedMistake plant_mistake(RefinedMesh const& mesh, Mistake kind);

/// The patches with a mistake; they refer to `patches`. Mistakes of edges are those of the stencil
/// form and the two-stage form, whose patches are WatertightPatches over cubics p, e+, e-.
///
/// \param frame  that they will be drawn with
/// Throws Error where the mistake cannot be planted, and where nothing would have it.
std::unique_ptr<PatchMesh> with_mistake(PatchMesh const& patches, PlantedMistake const& mistake,
                                        FrameSettings const& frame);

/// Why a planted mistake has not been found: the verdicts that find its kind are skipped, or it
/// changes nothing there. Empty where one fails.
std::string why_not_found(Mistake mistake, std::vector<CheckedVerdict> const& verdicts);

} // namespace tessemu
