// The tessellator's batch format: one case a line, one answer a line.
//
//     case:    <domain> <partitioning> <output> <f0> <f1> ...
//     answer:  <points> <indices> <points hash> <indices hash>
//
// Factors are the 8 hexadecimal digits of the float, hashes FNV-1a 64 over little-endian words.
// Lines end in LF or CR LF; empty ones may follow the last case.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/error.h"
#include "emu/tessellator.h"

#include <string>
#include <vector>

namespace tessemu {

struct TessellatorCase {
    TessellatorState state;
    TessFactors factors{};
};

/// Throws FormatError that names the line and the word.
TessellatorCase parse_tessellator_case(std::string_view text, std::string const& file, int line);
std::string format_tessellator_case(TessellatorCase const& c);

/// Of all lines, in order. Throws FormatError.
std::vector<TessellatorCase> parse_tessellator_cases(std::string_view text,
                                                     std::string const& file);

/// The reference tessellator gives outputs that Direct3D 11 forbids, and so do we.
TessellatedPatch run_tessellator_case(TessellatorCase const& c);
/// Whether Direct3D 11 has the output in the domain: points in all, lines in isolines, triangles in
/// the others (rule R75).
bool is_legal_output(TessellatorState const& state);

/// The answer line of a patch.
std::string tessellator_answer(TessellatedPatch const& patch);

} // namespace tessemu
