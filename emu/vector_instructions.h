// Which instructions of four-component vectors an expression needs, before they have registers
// (vector_code.h has the rules).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graph.h"

#include <array>
#include <compare>
#include <cstdint>
#include <vector>

namespace tessemu::detail {

enum class VectorOp {
    Add,
    Mul,
    Mad,
    Min,
    Max,
    Floor,
    Move,
    Reciprocal,
    ReciprocalRoot,
    Dot,
    Texel
};

/// Whether the first two operands may change places.
inline bool commutes(VectorOp k)
{
    return k == VectorOp::Add || k == VectorOp::Mul || k == VectorOp::Mad || k == VectorOp::Min ||
           k == VectorOp::Max;
}

/// A number that an instruction reads: a component of a temporary vector, or a leaf of the graph.
struct Source {
    enum class Bank { Temporary, Constant, Input };
    Bank bank;
    int vector; ///< of temporaries
    int at;     ///< component of the vector, or node
    bool negated = false, absolute = false;

    /// Whether one operand can hold both.
    bool beside(Source const& o) const
    {
        return bank == o.bank && vector == o.vector && negated == o.negated &&
               absolute == o.absolute;
    }
    Source minus() const
    {
        Source s = *this;
        s.negated = !s.negated;
        return s;
    }
    friend auto operator<=>(Source const&, Source const&) = default;
};

struct VectorInstruction {
    VectorOp kind;
    int vector;                              ///< that it writes
    std::vector<int> components;             ///< of it
    std::array<std::vector<Source>, 3> in{}; ///< each operand's components
    std::uint32_t texture = 0;               ///< of a fetch

    std::size_t width() const { return components.size(); }
};

/// A vector of temporaries, and the instruction that writes each component.
struct Vector {
    std::vector<int> written_by;
    std::vector<int> place; ///< of each component where it is not free to choose, 0 to 3
};

struct VectorInstructions {
    std::vector<VectorInstruction> code;
    std::vector<Vector> vectors;
    std::vector<Source> results; ///< temporaries, by result
};

/// \param results  nodes of the graph
/// \param widest   components of an instruction, 2 to 4
VectorInstructions select_instructions(ExpressionGraph const& graph,
                                       std::vector<int> const& results, std::size_t widest);

} // namespace tessemu::detail
