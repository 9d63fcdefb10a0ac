// Names of the tessellator's states, and what happens to tess factors before it (rules R56 to R60).
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/floating_point.h"
#include "emu/scalar.h"
#include "emu/tessellator.h"

#include <cmath>

namespace tessemu {

namespace {

float clamp_factor(float x, float lo, float hi)
{
    return min(hi, max(lo, x));
}

} // namespace

std::string_view name_of(TessellatorDomain d)
{
    return d == TessellatorDomain::Quad ? "quad" : d == TessellatorDomain::Tri ? "tri" : "isoline";
}

std::string_view name_of(Partitioning p)
{
    switch (p) {
    case Partitioning::Integer:
        return "integer";
    case Partitioning::Pow2:
        return "pow2";
    case Partitioning::FractionalOdd:
        return "fractional_odd";
    default:
        return "fractional_even";
    }
}

std::string_view name_of(OutputPrimitive p)
{
    switch (p) {
    case OutputPrimitive::Point:
        return "point";
    case OutputPrimitive::Line:
        return "line";
    case OutputPrimitive::TriangleCw:
        return "triangle_cw";
    default:
        return "triangle_ccw";
    }
}

namespace {
template <class E, std::size_t N>
std::optional<E> from_name(std::string_view name, std::array<E, N> const& values)
{
    for (E e : values)
        if (name_of(e) == name) return e;
    return {};
}
} // namespace

std::optional<TessellatorDomain> tessellator_domain_from_name(std::string_view name)
{
    using D = TessellatorDomain;
    return from_name(name, std::array{D::Quad, D::Tri, D::Isoline});
}

std::optional<Partitioning> partitioning_from_name(std::string_view name)
{
    using P = Partitioning;
    return from_name(name, std::array{P::Integer, P::Pow2, P::FractionalOdd, P::FractionalEven});
}

std::optional<OutputPrimitive> output_primitive_from_name(std::string_view name)
{
    using O = OutputPrimitive;
    return from_name(name, std::array{O::Point, O::Line, O::TriangleCw, O::TriangleCcw});
}

int tess_factor_count(TessellatorDomain d)
{
    return d == TessellatorDomain::Quad ? 6 : d == TessellatorDomain::Tri ? 4 : 2;
}

int edge_factor_count(TessellatorDomain d)
{
    return d == TessellatorDomain::Quad ? 4 : d == TessellatorDomain::Tri ? 3 : 2;
}

FixedFactors process_tess_factors(TessellatorState const& state, TessFactors const& factors)
{
    DenormalMode const ieee(DenormalMode::Keep);
    FixedFactors out;
    auto const edges = std::size_t(edge_factor_count(state.domain));
    auto const count = std::size_t(tess_factor_count(state.domain));
    for (std::size_t i = 0; i < edges; ++i) {
        if (factors[i] > 0) continue;
        out.culled = true;
        return out;
    }

    bool const whole =
        state.partitioning == Partitioning::Integer || state.partitioning == Partitioning::Pow2;
    bool const fractional_odd = state.partitioning == Partitioning::FractionalOdd;
    float const lo = state.partitioning == Partitioning::FractionalEven ? 2.0f : 1.0f;
    float const hi = fractional_odd ? 63.0f : 64.0f;
    constexpr float kAboveOne =
        1.0f + 1.0f / (1 << 17); // the largest value that still rounds to 1.0

    TessFactors clamped{};
    float inside_lo = lo;
    for (std::size_t i = 0; i < edges; ++i) {
        bool const density = state.domain == TessellatorDomain::Isoline && i == 0;
        clamped[i] = density ? clamp_factor(factors[i], 1, 64) : clamp_factor(factors[i], lo, hi);
        if (fractional_odd && clamped[i] > kAboveOne) inside_lo = 1.0f + 1.0f / (1 << 16);
        if (whole || density) clamped[i] = std::ceil(clamped[i]);
    }
    if (fractional_odd && state.domain == TessellatorDomain::Quad)
        for (std::size_t i = edges; i < count; ++i)
            if (factors[i] > kAboveOne) inside_lo = 1.0f + 1.0f / (1 << 16);
    for (std::size_t i = edges; i < count; ++i) {
        clamped[i] = clamp_factor(factors[i], inside_lo, hi);
        if (whole) clamped[i] = std::ceil(clamped[i]);
    }

    for (std::size_t i = 0; i < count; ++i) {
        out.value[i] = std::uint32_t(std::nearbyint(double(clamped[i]) * kFixedOne));
        bool const inside = i >= edges;
        if (whole || (state.domain == TessellatorDomain::Isoline && i == 0))
            out.odd[i] = ((out.value[i] >> 16) & 1) && !(inside && out.value[i] == kFixedOne);
        else
            out.odd[i] = fractional_odd;
    }
    return out;
}

} // namespace tessemu
