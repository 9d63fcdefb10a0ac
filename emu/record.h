// Vectors with HLSL's names, and records: the structs that travel between stages.
//
// A record is a template on its scalar and lists its members once, like a D3D11 input layout:
//
//     template <class T> struct SurfacePoint {
//         float3<T> position, normal;
//         static constexpr auto signature()
//         {
//             return std::tuple{&SurfacePoint::position, &SurfacePoint::normal};
//         }
//     };
//
// Memory holds its components one after the other, in that order.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/scalar.h"

#include <array>
#include <tuple>
#include <type_traits>
#include <typeinfo>

namespace tessemu {

template <class T> struct float2 {
    T x, y;
    constexpr float2() = default;
    constexpr float2(T x_, T y_) : x(x_), y(y_) {}
    template <class U>
    requires(!std::same_as<T, U> && std::convertible_to<U, T>) constexpr float2(float2<U> const& o)
        : x(o.x),
          y(o.y)
    {
    }
};

template <class T> struct float3 {
    T x, y, z;
    constexpr float3() = default;
    constexpr float3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
    template <class U>
    requires(!std::same_as<T, U> && std::convertible_to<U, T>) constexpr float3(float3<U> const& o)
        : x(o.x),
          y(o.y),
          z(o.z)
    {
    }
};

template <class T> struct float4 {
    T x, y, z, w;
    constexpr float4() = default;
    constexpr float4(T x_, T y_, T z_, T w_) : x(x_), y(y_), z(z_), w(w_) {}
    constexpr float4(float3<T> const& v, T w_) : x(v.x), y(v.y), z(v.z), w(w_) {}
    template <class U>
    requires(!std::same_as<T, U> && std::convertible_to<U, T>) constexpr float4(float4<U> const& o)
        : x(o.x),
          y(o.y),
          z(o.z),
          w(o.w)
    {
    }
};

// Component-wise arithmetic. Operands may differ in type because a product may be a proxy
// (emu/contracted.h); the result has the type that the components' operator gives.

template <class A, class B> constexpr auto operator+(float2<A> const& a, float2<B> const& b)
{
    return float2<decltype(a.x + b.x)>{a.x + b.x, a.y + b.y};
}
template <class A, class B> constexpr auto operator-(float2<A> const& a, float2<B> const& b)
{
    return float2<decltype(a.x - b.x)>{a.x - b.x, a.y - b.y};
}
template <class S, class A> constexpr auto operator*(S const& s, float2<A> const& a)
{
    return float2<decltype(s * a.x)>{s * a.x, s * a.y};
}

template <class A, class B> constexpr auto operator+(float3<A> const& a, float3<B> const& b)
{
    return float3<decltype(a.x + b.x)>{a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class A, class B> constexpr auto operator-(float3<A> const& a, float3<B> const& b)
{
    return float3<decltype(a.x - b.x)>{a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class A> constexpr auto operator-(float3<A> const& a)
{
    return float3<decltype(-a.x)>{-a.x, -a.y, -a.z};
}
template <class S, class A> constexpr auto operator*(S const& s, float3<A> const& a)
{
    return float3<decltype(s * a.x)>{s * a.x, s * a.y, s * a.z};
}

template <class A, class B> constexpr auto operator+(float4<A> const& a, float4<B> const& b)
{
    return float4<decltype(a.x + b.x)>{a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
}
template <class S, class A> constexpr auto operator*(S const& s, float4<A> const& a)
{
    return float4<decltype(s * a.x)>{s * a.x, s * a.y, s * a.z, s * a.w};
}

/// body(of) for x, y and z in turn, where of(v) is that component of a float3. Long sums written
/// this way need a third of the registers that they need as float3 arithmetic.
template <class Body> constexpr void components(Body&& body)
{
    body([](auto& v) -> auto& { return v.x; });
    body([](auto& v) -> auto& { return v.y; });
    body([](auto& v) -> auto& { return v.z; });
}

/// 3 multiplications, 2 additions, left to right.
template <class A, class B> constexpr auto dot(float3<A> const& a, float3<B> const& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
/// 6 multiplications, 3 additions.
template <class T> constexpr float3<T> cross(float3<T> const& a, float3<T> const& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// v / |v|; NaN for a zero vector, as HLSL's.
template <class T> constexpr float3<T> normalize(float3<T> const& v)
{
    T const inverse = T(1) / sqrt(T(dot(v, v)));
    return {T(v.x * inverse), T(v.y * inverse), T(v.z * inverse)};
}
/// a + t (b - a), as HLSL defines it: does not give b at t = 1, so never on a shared edge.
template <class T> constexpr float3<T> lerp(float3<T> const& a, float3<T> const& b, T t)
{
    return a + t * float3<T>(b - a);
}
template <ShaderScalar T> constexpr T saturate(T x)
{
    return min(max(x, T(0)), T(1));
}

template <class P>
concept Record = requires
{
    P::signature();
};

namespace detail {
template <class V> inline constexpr std::size_t array_size = 0;
template <class V, std::size_t n> inline constexpr std::size_t array_size<std::array<V, n>> = n;
} // namespace detail

namespace detail {
template <class P> struct Rebind;
template <template <class> class P, class T> struct Rebind<P<T>> {
    template <class U> using to = P<U>;
};
} // namespace detail

/// Record P<T> as P<U>.
template <class P, class U> using rebind = typename detail::Rebind<P>::template to<U>;

/// Calls f on every scalar of a record, vector or scalar, in memory order.
template <class P, class F> constexpr void for_each_scalar(P& p, F&& f)
{
    using V = std::remove_const_t<P>;
    if constexpr (Record<V>)
        std::apply([&](auto... member) { (for_each_scalar(p.*member, f), ...); }, V::signature());
    else if constexpr (detail::array_size<V> > 0)
        for (auto& element : p) for_each_scalar(element, f);
    else if constexpr (requires { p.w; })
        f(p.x), f(p.y), f(p.z), f(p.w);
    else if constexpr (requires { p.z; })
        f(p.x), f(p.y), f(p.z);
    else if constexpr (requires { p.x; })
        f(p.x), f(p.y);
    else
        f(p);
}

/// Scalars of a record.
template <class P> constexpr int scalar_count()
{
    if constexpr (Record<P>) {
        return std::apply(
            [](auto... member) {
                return (0 + ... +
                        scalar_count<std::remove_cvref_t<decltype(std::declval<P&>().*member)>>());
            },
            P::signature());
    } else if constexpr (detail::array_size<P> > 0) {
        return int(detail::array_size<P>) * scalar_count<typename P::value_type>();
    } else {
        if constexpr (requires(P p) { p.w; })
            return 4;
        else if constexpr (requires(P p) { p.z; })
            return 3;
        else if constexpr (requires(P p) { p.x; })
            return 2;
        else
            return 1;
    }
}

/// What a geometry stage writes: scalars, and how many of the last ones are SV_ClipDistance and
/// then SV_CullDistance. A record declares them as `static constexpr int kClipDistances,
/// kCullDistances`.
struct OutputLayout {
    int floats = 0, clip_distances = 0, cull_distances = 0;
    std::type_info const* record = nullptr; ///< of float, whatever scalar wrote it

    template <class P> bool holds() const { return record && *record == typeid(P); }
};
/// Of a shader's `Output<float>`.
template <class P> constexpr OutputLayout output_layout()
{
    OutputLayout l{scalar_count<P>(), 0, 0, &typeid(P)};
    if constexpr (requires { P::kClipDistances; }) l.clip_distances = P::kClipDistances;
    if constexpr (requires { P::kCullDistances; }) l.cull_distances = P::kCullDistances;
    return l;
}

/// Record from memory: every invocation reads the same one.
template <class P, class S> constexpr P load_record(S const* memory)
{
    P p{};
    for_each_scalar(p, [&](auto& scalar) {
        scalar = std::remove_cvref_t<decltype(scalar)>(*memory);
        ++memory;
    });
    return p;
}

/// Record from arrays by component: scalar k at memory[k * stride].
template <class P, class S> constexpr P load_column(S const* memory, std::size_t stride)
{
    P p{};
    for_each_scalar(p, [&](auto& scalar) {
        scalar = std::remove_cvref_t<decltype(scalar)>(*memory);
        memory += stride;
    });
    return p;
}

/// select() on every scalar of two records.
template <class M, class P> constexpr P select_record(M mask, P const& yes, P const& no)
{
    if constexpr (Record<P>) {
        P r = no;
        std::apply(
            [&](auto... member) {
                ((r.*member = select_record(mask, yes.*member, no.*member)), ...);
            },
            P::signature());
        return r;
    } else if constexpr (detail::array_size<P> > 0) {
        P r = no;
        for (std::size_t i = 0; i < r.size(); ++i) r[i] = select_record(mask, yes[i], no[i]);
        return r;
    } else if constexpr (requires { yes.w; }) {
        return P(select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z),
                 select(mask, yes.w, no.w));
    } else if constexpr (requires { yes.z; }) {
        return P(select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z));
    } else if constexpr (requires { yes.x; }) {
        return P(select(mask, yes.x, no.x), select(mask, yes.y, no.y));
    } else {
        return select(mask, yes, no);
    }
}

/// select() on vectors.
template <class M, class T>
constexpr float3<T> select(M mask, float3<T> const& a, float3<T> const& b)
{
    return select_record(mask, a, b);
}

} // namespace tessemu
