// Sides of patch types that are one in a mesh, and which control points of both are the same
// (docs/math/subdivision.md, 5.5 and 5.6).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/type_tables.h"

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace tessemu {

/// v = 0, u = 1, v = 1 and u = 0, each followed away from the patch's corner or the edges at it:
/// Lower and Left from (0,0), Right from (1,0), Upper from (0,1).
enum class PatchSide : std::uint8_t { Lower, Right, Upper, Left };

/// The side of a joint's b that is `side` of its a.
PatchSide other_side(PatchSide side);

/// Sharpness of the edge along Lower.
float lower_sharpness(PatchType const& t);
/// Sharpness of the edge along Left.
float left_sharpness(PatchType const& t);
/// With two faces around, points on both sides of the patch are one, and its neighbours' are not.
bool is_fold(PatchType const& t);

/// A control point of the ring of a vertex beyond.
struct BeyondName {
    int of, index, is_face; ///< of: PatchType::Beyond

    auto operator<=>(BeyondName const&) const = default;
};

/// The control points of a type, in 0..points - 1, by where they lie; none: -1. Refers to the type.
class PointsOfType {
public:
    /// Column and row of a control point on the grid around a patch, -1 to 2: (0,0) is the patch's
    /// corner V, (1,1) the one across it.
    using Cell = std::array<int, 2>;

    explicit PointsOfType(PatchTypeTables const& t);

    /// Ends of V's edges, by their numbers in its ring, which a closed ring takes modulo its faces.
    int edge(int i) const;
    /// Vertices across V's faces, likewise.
    int face(int i) const;
    int at(Cell cell) const;
    int beyond(BeyondName const& name) const;
    std::map<Cell, int> const& grid() const { return grid_; }
    std::map<BeyondName, int> const& beyond() const { return beyond_; }

private:
    PatchType const* type_;
    std::span<std::uint16_t const> point_of_;
    std::map<Cell, int> grid_;
    std::map<BeyondName, int> beyond_;
};

/// Sides of two types, by number, that are one: Lower of a with Left of b, or Right of a with Upper
/// of b.
struct Joint {
    std::uint32_t a;
    PatchSide side; ///< of a: Lower or Right
    std::uint32_t b;
    bool mirrored = false; ///< b is a's mirror image, or its own: not a neighbour

    auto operator<=>(Joint const&) const = default;
};

/// Of a joint: control points of a and of b that are one.
using JointPoints = std::vector<std::array<std::uint16_t, 2>>;

/// Of a joint: which control point of a is which of b; -1: it has none.
struct JointMatch {
    std::vector<int> of_a, of_b;

    JointMatch(PatchTypeTables const& a, PatchTypeTables const& b)
        : of_a(std::size_t(a.points), -1),
          of_b(std::size_t(b.points), -1)
    {
    }
    void set(int a, int b)
    {
        if (a < 0 || b < 0) return;
        of_a[std::size_t(a)] = b;
        of_b[std::size_t(b)] = a;
    }
};
/// By the types' names of their control points. Where a mesh is at hand, its vertices tell better:
/// two names may be of one vertex.
JointMatch match_of(Joint const& joint, PatchTypeTables const& a, PatchTypeTables const& b);

/// What the types of one set of rules can share with each other, and with their mirror images; of
/// types that nothing beyond has an influence on, and without finite sharpness.
std::vector<Joint> possible_joints(std::span<PatchTypeTables const> types);

} // namespace tessemu
