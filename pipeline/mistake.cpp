// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mistake.h"

namespace tessemu {

std::string_view name_of(Mistake mistake)
{
    switch (mistake) {
    case Mistake::Order:
        return "order";
    case Mistake::Contraction:
        return "contraction";
    case Mistake::Factors:
        return "factors";
    case Mistake::Normals:
        return "normals";
    case Mistake::Fold:
        return "fold";
    case Mistake::Weights:
        return "weights";
    case Mistake::TopLeft:
        return "topleft";
    default:
        return "none";
    }
}

std::optional<Mistake> mistake_from_name(std::string_view name)
{
    if (name == "none") return Mistake::None;
    for (Mistake m : kMistakes)
        if (name_of(m) == name) return m;
    return {};
}

} // namespace tessemu
