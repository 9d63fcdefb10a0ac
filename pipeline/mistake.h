// Known mistakes, planted into a draw so that a checker can show that it finds them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace tessemu {

enum class Mistake {
    None,
    Order,       ///< every patch sums its edges left to right in its own direction
    Contraction, ///< mirror pairs in its own direction, for a machine that contracts
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
    std::uint32_t face = 0; ///< whose patch it is, where it is one patch's
};

} // namespace tessemu
