// Contracted<T, Policy>: a scalar on which products that feed sums may be fused, as shader
// compilers do.
//
// A product is a proxy; a sum that meets one becomes a multiply-add with one rounding, anything
// else rounds it. Policy All fuses each; Mixed decides site by site from a seed. A site is a place
// in the source: loop<T>() makes every turn of a loop the same sites, Routine<T> makes a shared
// function number its sums from its own start for every caller, and when() numbers a branch whether
// or not it is taken.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/counted.h"

#include <utility>

namespace tessemu {

/// Where mixed contraction is in the source.
struct SiteState {
    std::uint64_t seed = 0, scope = 0, next = 0;
};
constinit inline thread_local SiteState site_state{};

namespace detail {
constexpr std::uint64_t mix(std::uint64_t a, std::uint64_t b)
{
    std::uint64_t x = a ^ (b + 0x9e3779b97f4a7c15u + (a << 6) + (a >> 2));
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}
} // namespace detail

/// Numbers the sites of a piece of source that is entered here, and restores the caller's
/// numbering.
template <class T> class SiteScope {
public:
    SiteScope() { enter(detail::mix(site_state.scope, site_state.next)); }
    explicit SiteScope(std::uint64_t name) { enter(detail::mix(site_state.seed, name)); }
    ~SiteScope()
    {
        if constexpr (ScalarTraits<T>::kSites) {
            site_state.scope = saved_.scope;
            site_state.next = saved_.next + 1;
        }
    }
    void restart()
    {
        if constexpr (ScalarTraits<T>::kSites) site_state.next = 0;
    }
    SiteScope(SiteScope const&) = delete;
    SiteScope& operator=(SiteScope const&) = delete;

private:
    void enter(std::uint64_t scope)
    {
        if constexpr (ScalarTraits<T>::kSites) {
            saved_ = site_state;
            site_state.scope = scope;
            site_state.next = 0;
        }
    }
    SiteState saved_{};
};

namespace policy {
struct All {
    static constexpr bool kSites = false;
    static bool fuse() { return true; }
};
struct Mixed {
    static constexpr bool kSites = true;
    static bool fuse()
    {
        return detail::mix(detail::mix(site_state.seed, site_state.scope), site_state.next++) & 1;
    }
};
} // namespace policy

template <class T, class Policy> struct Contracted {
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
    friend Contracted operator+(Product p, Contracted c) { return fuse(p, c.value); }
    friend Contracted operator+(Contracted c, Product p) { return fuse(p, c.value); }
    friend Contracted operator+(Product p, Product q) { return fuse(p, T(q.a * q.b)); }
    friend Contracted operator-(Contracted a, Contracted b) { return T(a.value - b.value); }
    friend Contracted operator-(Product p, Contracted c) { return fuse(p, T(-c.value)); }
    friend Contracted operator-(Contracted c, Product p) { return fuse(-p, c.value); }
    friend Contracted operator-(Product p, Product q) { return fuse(p, T(-T(q.a * q.b))); }

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
    static Contracted fuse(Product p, T c)
    {
        if (Policy::fuse()) return T(mad(p.a, p.b, c));
        return T(T(p.a * p.b) + c);
    }
};

template <class T, class Policy> struct ScalarTraits<Contracted<T, Policy>> : ScalarTraits<T> {
    static constexpr bool kSites = Policy::kSites;
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
template <class T, class P> auto lanes_value(Contracted<T, P> x)
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
