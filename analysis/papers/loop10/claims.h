// The claims of LOOP10 about its figure 5, decided from predicted frames.
//
// "About equal" is within 15 % of frames a second. Low rates are factors below 4, dense rates 16
// and 32; both are the paper's words. After k steps the factors 1 to 2^k are one frame, which
// counts once.
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
    int factor = 1;         ///< of its patches

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

/// Under one reading of what the paper leaves open; by the figure's factor.
struct Figure5Times {
    struct Step {
        double seconds = 0; ///< of a frame with subdivision: what it takes longer
        std::string bound;  ///< of the counted work
    };
    ByGpuModel<std::array<ByFactor<FrameTime>, kFigure5Curves>> frame;
    ByGpuModel<Step> step;
    /// The share of a Gregory2 frame that sorting by valence saves; below 0: it costs.
    ByGpuModel<ByFactor<double>> sorting_gain;
};

/// What the claims need besides, under any reading.
struct Figure5Measures {
    struct RegularQuads {
        double gain = 0;   ///< shaders' seconds as Bezier patches over those as B-splines; 0: none
        std::string bound; ///< as B-splines
    };
    /// Of Stam, by the factor of a patch.
    ByGpuModel<ByFactor<RegularQuads>> regular_quads;
    /// Domain points in what was an extraordinary face before the first step, at factor 32 of it.
    struct Samples {
        std::uint64_t regular = 0, all = 0;
    };
    std::array<Samples, kFigure5Models> samples;
    /// The largest share of lanes that wait in a kernel, unsorted.
    ByGpuModel<double> lost_lanes;
};

/// (a) to (m), as one reading has them.
std::vector<PaperClaim> loop10_claims(Figure5Times const& times, Figure5Measures const& measures);

/// (a) to (m), by two readings of a step of subdivision: with the overheads that are fitted to
/// table 1, and with its counted work alone. No frame without a step has an overhead, for nobody
/// published one. So what fails with the fit and not without it hangs on what a frame costs
/// whatever it draws, and cannot follow from counters.
std::vector<PaperClaim> loop10_claims(Figure5Times const& fitted, Figure5Times const& counted,
                                      Figure5Measures const& measures);

} // namespace tessemu
