// Contracted<T>: a scalar on which products that feed sums may be fused, as shader compilers do.
//
// A product is a proxy; a sum that meets one asks the thread whether it takes it, as a multiply-add
// with one rounding, or rounds it first. Anything else rounds it. The answer is the same
// everywhere, or decided site by site from a seed. A site is a place in the source: loop<T>() makes
// every turn of a loop the same sites, Routine<T> makes a shared function number its sums from its
// own start for every caller, and when() numbers a branch whether or not it is taken.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/counted.h"

#include <type_traits>
#include <utility>

namespace tessemu {

/// What the shader compiler does to a product that feeds a sum (choice I-6).
enum class Contraction {
    None,  ///< two roundings
    All,   ///< one rounding wherever a sum can take the product
    Mixed, ///< site by site, from a seed; for testing shaders
};

namespace detail {
constexpr std::uint64_t mix(std::uint64_t a, std::uint64_t b)
{
    std::uint64_t x = a ^ (b + 0x9e3779b97f4a7c15u + (a << 6) + (a >> 2));
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}
} // namespace detail

/// The rule that the thread's sums follow, and where in the source it is.
class SiteState {
public:
    constexpr SiteState() = default;
    constexpr SiteState(Contraction c, std::uint64_t seed) : contraction_(c), seed_(seed)
    {
        enter(0, 0);
    }

    /// A numbering of its own from here on, whose next site is `next`.
    constexpr void enter(std::uint64_t scope, std::uint64_t next)
    {
        scope_ = scope, next_ = next;
        key_ = detail::mix(seed_, scope);
    }
    /// The name of a scope that is entered here.
    std::uint64_t inner_scope() const { return detail::mix(scope_, next_); }
    std::uint64_t named_scope(std::uint64_t name) const { return detail::mix(seed_, name); }
    void restart() { next_ = 0; }
    void skip_site() { ++next_; }

    /// Whether the next sum takes its product.
    bool fuses()
    {
        if (contraction_ != Contraction::Mixed) return contraction_ == Contraction::All;
        return detail::mix(key_, next_++) & 1;
    }

private:
    Contraction contraction_ = Contraction::None;
    std::uint64_t seed_ = 0, scope_ = 0, next_ = 0;
    std::uint64_t key_ = 0; ///< of the seed and the scope
};
constinit inline thread_local SiteState site_state{};

/// Numbers the sites of a piece of source that is entered here, and restores the caller's
/// numbering.
template <class T> class SiteScope {
public:
    SiteScope()
    {
        if constexpr (ScalarTraits<T>::kSites) enter(site_state.inner_scope());
    }
    explicit SiteScope(std::uint64_t name)
    {
        if constexpr (ScalarTraits<T>::kSites) enter(site_state.named_scope(name));
    }
    ~SiteScope()
    {
        if constexpr (ScalarTraits<T>::kSites) {
            site_state = outer_;
            site_state.skip_site();
        }
    }
    void restart()
    {
        if constexpr (ScalarTraits<T>::kSites) site_state.restart();
    }
    SiteScope(SiteScope const&) = delete;
    SiteScope& operator=(SiteScope const&) = delete;

private:
    void enter(std::uint64_t scope)
    {
        outer_ = site_state;
        site_state.enter(scope, 0);
    }
    struct Nothing {};
    [[no_unique_address]] std::conditional_t<ScalarTraits<T>::kSites, SiteState, Nothing> outer_;
};

/// A group of invocations starts at the shader's first line, with these lanes.
///
/// \param first_site  of the sites that follow; not 0 where a piece of the shader went before
template <class T> void begin_group(std::uint32_t active_bits, std::uint64_t first_site = 0)
{
    execution.activate(active_bits);
    if constexpr (ScalarTraits<T>::kSites) site_state.enter(first_site, first_site);
}

template <class T> struct Contracted {
    T value;

    struct Product {
        T a, b;
        operator Contracted() const { return T(a * b); }
        friend Product operator-(Product p) { return {T(-p.a), p.b}; }
    };

    Contracted() = default;
    Contracted(T v) : value(v) {}
    Contracted(float v) requires(!std::same_as<T, float>) : value(v) {}
    explicit Contracted(int_of<T> i) requires(!std::same_as<int_of<T>, std::int32_t>) : value(T(i))
    {
    }

    friend Product operator*(Contracted a, Contracted b) { return {a.value, b.value}; }

    friend Contracted operator+(Contracted a, Contracted b) { return T(a.value + b.value); }
    friend Contracted operator+(Product p, Contracted c) { return fuse(p.a, p.b, c.value); }
    friend Contracted operator+(Contracted c, Product p) { return fuse(p.a, p.b, c.value); }
    friend Contracted operator+(Product p, Product q) { return fuse(p.a, p.b, T(q.a * q.b)); }
    friend Contracted operator-(Contracted a, Contracted b) { return T(a.value - b.value); }
    friend Contracted operator-(Product p, Contracted c) { return fuse(p.a, p.b, T(-c.value)); }
    friend Contracted operator-(Contracted c, Product p) { return fuse(T(-p.a), p.b, c.value); }
    friend Contracted operator-(Product p, Product q) { return fuse(p.a, p.b, T(-T(q.a * q.b))); }

    friend Contracted operator/(Contracted a, Contracted b) { return T(a.value / b.value); }
    friend Contracted operator-(Contracted a) { return T(-a.value); }
    friend Contracted mad(Contracted a, Contracted b, Contracted c)
    {
        return T(mad(a.value, b.value, c.value));
    }
    friend Contracted sqrt(Contracted a) { return T(sqrt(a.value)); }
    friend Contracted floor(Contracted a) { return T(floor(a.value)); }
    friend Contracted abs(Contracted a) { return T(abs(a.value)); }
    friend Contracted min(Contracted a, Contracted b) { return T(min(a.value, b.value)); }
    friend Contracted max(Contracted a, Contracted b) { return T(max(a.value, b.value)); }
    friend mask_of<T> operator<(Contracted a, Contracted b) { return a.value < b.value; }
    friend mask_of<T> operator>(Contracted a, Contracted b) { return a.value > b.value; }
    friend mask_of<T> operator<=(Contracted a, Contracted b) { return a.value <= b.value; }
    friend mask_of<T> operator>=(Contracted a, Contracted b) { return a.value >= b.value; }
    friend mask_of<T> operator==(Contracted a, Contracted b) { return a.value == b.value; }
    friend mask_of<T> operator!=(Contracted a, Contracted b) { return a.value != b.value; }
    friend Contracted select(mask_of<T> m, Contracted a, Contracted b)
    {
        return T(select(m, a.value, b.value));
    }

private:
    // Out of line: a shader has hundreds of sums, and the question is asked at each.
    [[gnu::noinline]] static Contracted fuse(T a, T b, T c)
    {
        if (site_state.fuses()) return T(mad(a, b, c));
        return T(T(a * b) + c);
    }
};

template <class T> struct ScalarTraits<Contracted<T>> : ScalarTraits<T> {
    static constexpr bool kSites = true;
};

/// The lanes (or the number) inside a scalar's wrappers.
template <int N> Lanes<N> lanes_value(Lanes<N> x)
{
    return x;
}
inline float lanes_value(float x)
{
    return x;
}
template <class T> auto lanes_value(Counted<T> x)
{
    return lanes_value(x.value);
}
template <class T> auto lanes_value(Contracted<T> x)
{
    return lanes_value(x.value);
}

/// HLSL's asuint: the bits of a number, as a signed integer. A scalar without values (a tally)
/// gives 0.
template <class T> constexpr int_of<T> asuint(T const& x)
{
    if constexpr (requires { lanes_value(x); }) {
        auto const v = lanes_value(x);
        if constexpr (std::same_as<std::remove_cvref_t<decltype(v)>, float>) {
            return int_of<T>(std::bit_cast<std::int32_t>(v));
        } else {
            int_of<T> bits;
            static_assert(sizeof bits.raw == sizeof v.raw);
            __builtin_memcpy(&bits.raw, &v.raw, sizeof bits.raw);
            return bits;
        }
    } else {
        return int_of<T>(0);
    }
}

} // namespace tessemu
