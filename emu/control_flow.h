// Control flow of a shader: a branch on a mask, a loop, a shared routine.
//
// Lanes never branch; when() runs a piece of work for the lanes that need it, skips it when none
// does and counts the masked lanes only. On scalar machines it is an if.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/contracted.h"
#include "emu/record.h"

namespace tessemu {

namespace detail {
template <class V> struct ScalarIn;
template <ShaderScalar T> struct ScalarIn<T> {
    using type = T;
};
template <template <class> class R, class T>
requires(!ShaderScalar<R<T>>) struct ScalarIn<R<T>> {
    using type = T;
};
template <template <int, class> class R, int n, class T> struct ScalarIn<R<n, T>> {
    using type = T;
};

class Branch {
public:
    explicit Branch(std::uint32_t bits) : saved_(execution.active_bits)
    {
        execution.activate(bits);
    }
    ~Branch() { execution.activate(saved_); }

private:
    std::uint32_t saved_;
};
} // namespace detail

/// The scalar that a record, a vector or a scalar is made of.
template <class V> using scalar_of = typename detail::ScalarIn<V>::type;

namespace detail {
template <class M, class Work, class V> V masked(M mask, Work&& work, V const& otherwise)
{
    SiteScope<scalar_of<V>> const here;
    execution.features |= kBranches;
    std::uint32_t const bits = mask.bits() & execution.active_bits;
    if (bits == 0) return otherwise;
    Branch const branch(bits);
    return select_record(mask, V(work()), otherwise);
}
} // namespace detail

/// `work()` in the lanes of `mask`, `otherwise` in the rest; work under a mask counts its lanes
/// only.
template <class M, class Work, class V> constexpr V when(M mask, Work&& work, V const& otherwise)
{
    using T = scalar_of<V>;
    if constexpr (ScalarTraits<T>::kTally) {
        return mask ? V(work()) : otherwise;
    } else if constexpr (std::integral<M>) { // bool & bool is an int
        SiteScope<T> const here;
        return mask ? V(work()) : otherwise;
    } else {
        return detail::masked(mask, work, otherwise);
    }
}

namespace detail {
template <class M, class Work> void masked_work(M mask, Work&& work)
{
    execution.features |= kBranches;
    std::uint32_t const bits = mask.bits() & execution.active_bits;
    if (bits == 0) return;
    Branch const branch(bits);
    work();
}
} // namespace detail

/// `work()` in the lanes of `mask`: for work that gives no value, such as emitting a vertex. What
/// it writes must honour the active lanes by itself.
template <class T, class M, class Work> constexpr void when(M mask, Work&& work)
{
    SiteScope<T> const here;
    if constexpr (std::integral<M>) {
        if (mask) work();
    } else {
        detail::masked_work(mask, work);
    }
}

namespace detail {
template <class T> class Loop {
public:
    explicit constexpr Loop(int n) : n_(n) {}
    struct End {};
    class Iterator {
    public:
        constexpr Iterator(Loop* loop) : loop_(loop) {}
        constexpr int operator*() const { return i_; }
        constexpr Iterator& operator++()
        {
            ++i_;
            if constexpr (ScalarTraits<T>::kSites) loop_->sites_.restart();
            return *this;
        }
        constexpr bool operator!=(End) const { return i_ < loop_->n_; }

    private:
        Loop* loop_;
        int i_ = 0;
    };
    constexpr Iterator begin() { return {this}; }
    constexpr End end() { return {}; }

private:
    struct NoSites {};
    int n_;
    [[no_unique_address]] std::conditional_t<ScalarTraits<T>::kSites, SiteScope<T>, NoSites> sites_;
};
} // namespace detail

/// for (int i : loop<T>(n)): 0 to n-1; every turn is the same place in the source.
template <class T> constexpr detail::Loop<T> loop(int n)
{
    return detail::Loop<T>(n);
}

/// The turns of a loop whose number differs by lane: as many as the active lane with the largest
/// asks for. What a turn does goes under when(k < n).
template <class T, int N> int longest(IntLanes<N> n)
{
    int turns = 0;
    for (std::uint32_t bits = execution.active_bits; bits; bits &= bits - 1)
        turns = std::max(turns, int(n.raw[std::countr_zero(bits)]));
    return turns;
}

template <class T> constexpr int longest(std::int32_t n)
{
    return n;
}

/// unrolled<n>(body): body(0), ..., body(n-1) with the index a constant, as a shader compiler
/// unrolls; each turn is a place in the source of its own.
template <int kTurns, class Body> constexpr void unrolled(Body&& body)
{
    [&]<int... i>(std::integer_sequence<int, i...>)
    {
        (body(std::integral_constant<int, i>()), ...);
    }
    (std::make_integer_sequence<int, kTurns>());
}

/// Declared first in a routine that several shaders share: one compiled routine, so a contraction
/// decision in it is the same for every caller.
template <class T> class [[maybe_unused]] Routine {
public:
    explicit constexpr Routine(char const* name) : sites_(hash(name)) {}

private:
    struct NoSites {
        explicit constexpr NoSites(std::uint64_t) {}
    };
    static constexpr std::uint64_t hash(char const* s)
    {
        std::uint64_t h = 0xcbf29ce484222325u;
        for (; *s; ++s) h = (h ^ std::uint64_t(*s)) * 0x100000001b3u;
        return h;
    }
    [[no_unique_address]] std::conditional_t<ScalarTraits<T>::kSites, SiteScope<T>, NoSites> sites_;
};

} // namespace tessemu
