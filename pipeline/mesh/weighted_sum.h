// A point as a sum of weighted points, by their numbers: what masks make of few points of many.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace tessemu {

/// \cost  of a sum, its new terms; of a product, all
class WeightedSum {
public:
    WeightedSum() = default;
    explicit WeightedSum(std::uint32_t point) : terms_{{point, 1}} {}

    struct Term {
        std::uint32_t point;
        double weight;
    };
    /// By ascending point, each once.
    std::vector<Term> terms() const
    {
        std::vector<Term> sorted = terms_, out;
        std::stable_sort(sorted.begin(), sorted.end(),
                         [](Term const& a, Term const& b) { return a.point < b.point; });
        for (Term const& t : sorted)
            if (!out.empty() && out.back().point == t.point)
                out.back().weight += t.weight;
            else
                out.push_back(t);
        return out;
    }

    /// Each point becomes one term.
    void merge() { terms_ = terms(); }

    WeightedSum& operator+=(WeightedSum const& o)
    {
        terms_.insert(terms_.end(), o.terms_.begin(), o.terms_.end());
        return *this;
    }
    WeightedSum& operator-=(WeightedSum const& o) { return *this += o * -1; }
    WeightedSum& operator*=(double s)
    {
        for (Term& t : terms_) t.weight *= s;
        return *this;
    }
    WeightedSum& operator/=(double s)
    {
        for (Term& t : terms_) t.weight /= s;
        return *this;
    }
    friend WeightedSum operator+(WeightedSum a, WeightedSum const& b) { return a += b; }
    friend WeightedSum operator-(WeightedSum a, WeightedSum const& b) { return a -= b; }
    friend WeightedSum operator*(WeightedSum a, double s) { return a *= s; }
    friend WeightedSum operator*(double s, WeightedSum a) { return a *= s; }
    friend WeightedSum operator/(WeightedSum a, double s) { return a /= s; }

private:
    std::vector<Term> terms_;
};

} // namespace tessemu
