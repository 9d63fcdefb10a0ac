// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/bolz/grid.h"

#include <algorithm>

namespace tessemu {

namespace {

struct Place {
    int x, y;
};

// A side of a grid of n segments as seen with the side below: edge k's own frame.
Place turned(int k, int n, Place p)
{
    switch (k) {
    case 0:
        return p;
    case 1:
        return {n - p.y, p.x};
    case 2:
        return {n - p.x, n - p.y};
    default:
        return {p.y, n - p.x};
    }
}

class Builder {
public:
    explicit Builder(GridLevels const& levels)
        : n_(1 << levels.inside),
          number_(std::size_t(n_ + 1) * std::size_t(n_ + 1), kUnused)
    {
        if (levels.is_regular()) {
            add_cells(0, n_);
        } else {
            add_cells(1, n_ - 1);
            for (int k = 0; k < 4; ++k) zip(k, levels.inside - levels.edges[std::size_t(k)]);
        }
    }

    PatchGrid take(bool regular)
    {
        PatchGrid out;
        std::uint32_t count = 0;
        TessellatedPatch& patch = out.points.patch;
        for (int y = 0; y <= n_; ++y)
            for (int x = 0; x <= n_; ++x) {
                std::uint32_t& number = number_[at({x, y})];
                if (number == kUnused) continue;
                number = count++;
                if (!regular) out.places.push_back(std::uint32_t(x + (y << 8)));
                auto const fixed = [&](int i) {
                    return std::uint32_t(i) * (kFixedOne / std::uint32_t(n_));
                };
                patch.u.push_back(fixed(x));
                patch.v.push_back(fixed(y));
                out.points.u.push_back(float(x) / float(n_));
                out.points.v.push_back(float(y) / float(n_));
            }
        for (std::size_t p : corners_) patch.indices.push_back(number_[p]);
        return out;
    }

private:
    static constexpr std::uint32_t kUnused = 0xffffffffu;

    std::size_t at(Place p) const { return std::size_t(p.y * (n_ + 1) + p.x); }
    void add(Place a, Place b, Place c)
    {
        for (Place p : {a, b, c}) {
            corners_.push_back(at(p));
            number_[at(p)] = 0;
        }
    }
    void add_cells(int first, int last)
    {
        for (int y = first; y < last; ++y)
            for (int x = first; x < last; ++x) {
                add({x, y}, {x + 1, y}, {x + 1, y + 1});
                add({x, y}, {x + 1, y + 1}, {x, y + 1});
            }
    }
    // From edge k, with a point at every 2^coarser-th place, to the row inside; on goes whichever
    // of both has its next segment's middle first.
    void zip(int k, int coarser)
    {
        int const step = 1 << coarser;
        auto const place = [&](int x, int y) { return turned(k, n_, {x, y}); };
        for (int outer = 0, inner = 1; outer < n_ || inner < n_ - 1;) {
            bool const along_edge =
                inner >= n_ - 1 || (outer < n_ && 2 * outer + step <= 2 * inner + 1);
            if (along_edge) {
                add(place(outer, 0), place(outer + step, 0), place(inner, 1));
                outer += step;
            } else {
                add(place(outer, 0), place(inner + 1, 1), place(inner, 1));
                ++inner;
            }
        }
    }

    int n_;
    std::vector<std::uint32_t> number_; // of a place
    std::vector<std::size_t> corners_;  // three a triangle
};

} // namespace

PatchGrid make_patch_grid(GridLevels const& levels)
{
    bool const regular = levels.is_regular();
    return Builder(levels).take(regular);
}

} // namespace tessemu
