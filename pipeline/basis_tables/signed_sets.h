// Union-find over numbers that are equal or opposite: what symmetry enforcement makes of entries.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace tessemu {

/// Sets of numbers that are equal or opposite; those that are their own opposite are 0.
class SignedSets {
public:
    explicit SignedSets(std::size_t size) : parent_(size), is_opposite_(size, 0), is_zero_(size, 0)
    {
        for (std::size_t i = 0; i < size; ++i) parent_[i] = i;
    }
    /// The least of a number's set, and whether the number is its opposite.
    std::pair<std::size_t, bool> root(std::size_t i)
    {
        std::size_t r = i;
        bool opposite = false;
        while (parent_[r] != r) opposite ^= is_opposite_[r] != 0, r = parent_[r];
        bool rest = opposite;
        while (parent_[i] != r && i != r) { // compress
            std::size_t const next = parent_[i];
            bool const here = is_opposite_[i] != 0;
            parent_[i] = r, is_opposite_[i] = rest;
            rest ^= here;
            i = next;
        }
        return {r, opposite};
    }
    void join(std::size_t a, std::size_t b, bool opposite = false)
    {
        auto const [ra, oa] = root(a);
        auto const [rb, ob] = root(b);
        bool const turned = oa ^ ob ^ opposite;
        if (ra == rb) {
            is_zero_[ra] |= turned;
            return;
        }
        auto const [low, high] = std::minmax(ra, rb);
        parent_[high] = low;
        is_opposite_[high] = turned;
        is_zero_[low] |= is_zero_[high];
    }
    void set_zero(std::size_t i) { is_zero_[root(i).first] = 1; }
    bool is_zero(std::size_t root_) const { return is_zero_[root_]; }
    std::size_t size() const { return parent_.size(); }

private:
    std::vector<std::size_t> parent_;
    std::vector<char> is_opposite_, is_zero_;
};

} // namespace tessemu
