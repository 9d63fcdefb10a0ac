// From a recorded expression to instructions of four-component vectors, as an assembly programmer
// of 2003 writes them for a GeForce FX (NV_fragment_program).
//
//     ExpressionGraph graph;
//     float3<Graph> const sum = shader.operator()<Graph>(...);
//     VectorCode const code = vector_code(graph, {sum.x, sum.y, sum.z});
//
// The order is the recorded one. Operations of one kind become one instruction of up to four
// components where each operand is one register: one instruction's result, constants, or inputs
// (swizzles and write masks are free, and constants and inputs lie as the code wants them). An
// operation joins an earlier instruction across others that are no wider than that, never across a
// texture fetch: so vectors come together whether they were written component by component or not,
// and the turns of a loop stay apart. Where it makes less code, three components are the most, or
// two: sums of three numbers side by side must not be torn into four and two.
//
// A product that feeds one sum alone becomes a MAD, a sum of three or four products of two
// registers DP3 or DP4, a division RCP and MUL, 1 / sqrt(x) RSQ, sqrt(x) RSQ and RCP; negation and
// absolute value are free. A fetch writes component k of a register with channel k, and has two
// components of one register as its address; MOV brings them together.
//
// Left out: that an instruction reads at most one constant and one input register, and that
// results go to output registers, which instructions can write as well as temporary ones.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graph.h"

#include <array>
#include <initializer_list>
#include <span>
#include <string>

namespace tessemu {

struct VectorCode {
    /// Instructions by kind; subtractions are ADD.
    std::uint64_t add = 0, mul = 0, mad = 0, tex = 0, other = 0;
    int registers = 0; ///< temporary ones of four components that are in use at once
    /// A line each: "ADD R1.xyzw, c0.xyzw, t0.xyxy", "TEX R1.x, R1.xy, tex0" (its slot).
    std::vector<std::string> listing;
    /// The nodes in c0, c1, ... and in t0, t1, ...: constants, and what comes from outside; -1 is
    /// unused.
    std::vector<std::array<int, 4>> constants, inputs;
    std::vector<std::string> results; ///< where each is at the end: "R0.x"

    std::uint64_t instructions() const { return add + mul + mad + tex + other; }
};

/// \param results  of the recording `graph`, or constants, which become nodes of it; what they do
///                 not need is left out. One that no operation made costs a MOV
VectorCode vector_code(ExpressionGraph& graph, std::span<Graph const> results);
inline VectorCode vector_code(ExpressionGraph& graph, std::initializer_list<Graph> results)
{
    return vector_code(graph, std::span(results.begin(), results.size()));
}

} // namespace tessemu
