// The claims of LOOP10 about its figure 5, decided from predicted frames.
//
// "About equal" is within 15 %. Low rates are factors below 4, dense rates 16 and 32; both are the
// paper's words.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/papers/loop10/items.h"

namespace tessemu {

/// A predicted frame.
struct FrameTime {
    double seconds = 0;
    double subdivision = 0; ///< of these, the steps of subdivision
    std::string bound;      ///< "domain shader, fetch"

    double rate() const { return 1 / seconds; }
};

inline constexpr std::size_t kFigure5Gpus = 2, kFigure5Models = std::size(kLoop10Models),
                             kFigure5Curves = 4, kFigure5Factors = 6;
inline constexpr int kFigure5Factor[kFigure5Factors] = {1, 2, 4, 8, 16, 32};
// Places in the arrays below.
inline constexpr std::size_t kRadeon5870 = 0, kGtx480 = 1;
inline constexpr std::size_t kGregory1 = 0, kGregory2 = 1, kStam = 2, kBiseptic = 3;

template <class T> using ByGpuModel = std::array<std::array<T, kFigure5Models>, kFigure5Gpus>;
template <class T> using ByFactor = std::array<T, kFigure5Factors>;

struct Figure5Times {
    ByGpuModel<std::array<ByFactor<FrameTime>, kFigure5Curves>> frame;
};

/// What the claims need besides the curves.
struct Figure5Measures {
    struct Step {
        double seconds = 0; ///< of a frame with subdivision: what it takes longer
        double work = 0;    ///< of these, what is counted and not fitted
        std::string bound;  ///< of the counted work
    };
    ByGpuModel<Step> step;
    /// Shaders' seconds of regular patches as Bezier patches over those as B-splines, by the
    /// factor of a patch.
    ByGpuModel<ByFactor<double>> bspline_gain;
    std::string bspline_bound[kFigure5Gpus];
    /// Domain points in what was an extraordinary face before the last step, at factor 32 of it.
    struct Samples {
        std::uint64_t regular = 0, all = 0;
    };
    std::array<Samples, kFigure5Models> samples;
    /// The share of a Gregory2 frame that sorting by valence saves; below 0: it costs.
    ByGpuModel<ByFactor<double>> sorting_gain;
    /// The largest share of lanes that wait in a kernel, unsorted.
    ByGpuModel<double> lost_lanes;
};

/// (a) to (m)
std::vector<PaperClaim> loop10_claims(Figure5Times const& times, Figure5Measures const& measures);

} // namespace tessemu
