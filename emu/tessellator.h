// The fixed-function tessellator of Direct3D 11 (specification section 11.7), bit for bit.
//
// Tess factors in, domain points and connectivity out. Positions are 16.16 fixed point; the order
// of points and triangles, which D3D11 leaves open (I-1), is that of Microsoft's reference: outer
// ring, inner rings, centre.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace tessemu {

enum class TessellatorDomain { Quad, Tri, Isoline };
enum class Partitioning { Integer, Pow2, FractionalOdd, FractionalEven };
enum class OutputPrimitive { Point, Line, TriangleCw, TriangleCcw };

/// "quad", "tri", "isoline", ... as in HLSL attributes; from_name returns nothing for another word.
std::string_view name_of(TessellatorDomain d);
std::string_view name_of(Partitioning p);
std::string_view name_of(OutputPrimitive p);
std::optional<TessellatorDomain> tessellator_domain_from_name(std::string_view name);
std::optional<Partitioning> partitioning_from_name(std::string_view name);
std::optional<OutputPrimitive> output_primitive_from_name(std::string_view name);

struct TessellatorState {
    TessellatorDomain domain = TessellatorDomain::Quad;
    Partitioning partitioning = Partitioning::FractionalOdd;
    OutputPrimitive output = OutputPrimitive::TriangleCw;

    friend bool operator==(TessellatorState const&, TessellatorState const&) = default;
};

inline constexpr float kMaxTessFactor = 64.0f;
inline constexpr std::uint32_t kFixedOne = 65536;

/// Tess factors in Direct3D's order (rule R52).
///
/// quad:    edge u=0, v=0, u=1, v=1, inside u, inside v
/// tri:     edge u=0, v=0, w=0, inside
/// isoline: density, detail
using TessFactors = std::array<float, 6>;

/// Factors per domain: 6, 4, 2; how many of them are edges: 4, 3, 2.
int tess_factor_count(TessellatorDomain d);
int edge_factor_count(TessellatorDomain d);

/// Factors after clamping and rounding, 16.16, with the parity that each span is built with.
struct FixedFactors {
    std::array<std::uint32_t, 6> value{};
    std::array<bool, 6> odd{};
    bool culled = false;

    friend bool operator==(FixedFactors const&, FixedFactors const&) = default;
};

/// Clamps and rounds (rules R56 to R60). Never throws: NaN, infinities and denormals have defined
/// results. Sets IEEE mode for its own arithmetic.
FixedFactors process_tess_factors(TessellatorState const& state, TessFactors const& factors);

/// Points u, v (and w = 1-u-v on a tri) in units of 1/65536; three indices a triangle, two a line.
/// A culled patch has none of either.
struct TessellatedPatch {
    std::vector<std::uint32_t> u, v;
    std::vector<std::uint32_t> indices;

    std::size_t points() const { return u.size(); }
};

/// Tessellates one patch, reusing `out`'s memory. At most 4225 points and 8192 triangles.
void tessellate(TessellatorState const& state, FixedFactors const& factors, TessellatedPatch& out);

/// One factor's subdivided span: positions P(0) = 0 to P(n-1) = 1, 16.16, symmetric bit for bit.
/// \param factor  16.16, 1 to 64
/// \param odd     the parity label: fractional_odd spans, and integer factors that are odd
/// \returns       at most 65 positions
std::vector<std::uint32_t> span_positions(std::uint32_t factor, bool odd);

} // namespace tessemu
