// The machine a shader runs on: lanes, contraction, and the two scalar types that it is compiled for.
//
// Fast: the widest lanes that the build's instruction set fills, products and sums apart. Checking:
// four lanes, the fewest that derivatives need, where each sum asks at run time whether it takes
// its product; with Contraction::None it gives the fast machine's bits and counts. A build with
// TESSEMU_ALL_LANES has both for 4, 8 and 16 lanes, to show that results do not depend on them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/contracted.h"
#include "emu/error.h"
#include "emu/memory.h"

#include <memory>
#include <vector>

namespace tessemu {

struct Machine {
    int lanes = kNativeLanes; ///< that the build holds; changes no result and no count
    Contraction contraction = Contraction::None;
    std::uint64_t seed = 0; ///< of Contraction::Mixed
    /// Runs the checking form though nothing is contracted.
    bool checking = false;

    /// The thread's state at a stage's door.
    SiteState sites() const { return {contraction, seed, 0, 0}; }
};

template <int N> using FastLanes = Counted<Lanes<N>>;
template <int N> using CheckLanes = Contracted<Counted<Lanes<N>>>;
using FastScalar = FastLanes<kNativeLanes>;
using CheckScalar = CheckLanes<4>;

/// Lane counts that the build holds, ascending.
#if defined(TESSEMU_ALL_LANES)
inline constexpr int kBuiltLanes[] = {4, 8, 16};
#else
inline constexpr int kBuiltLanes[] = {kNativeLanes};
#endif

/// Throws Error that names the build option for lanes that the build does not hold.
void check_lanes(int lanes);

/// A stage's program: the shader compiled for the machine's scalar.
template <template <class, class> class Program, class Interface, class Shader>
std::unique_ptr<Interface> make_program(Shader const& shader, Machine const& machine)
{
    check_lanes(machine.lanes);
    auto const on = [&]<class T>(std::type_identity<T>) -> std::unique_ptr<Interface> {
        return std::make_unique<Program<Shader, T>>(shader, machine.sites());
    };
    bool const checking = machine.checking || machine.contraction != Contraction::None;
#if defined(TESSEMU_ALL_LANES)
    switch (machine.lanes) {
    case 4:
        return checking ? on(std::type_identity<CheckLanes<4>>()) : on(std::type_identity<FastLanes<4>>());
    case 8:
        return checking ? on(std::type_identity<CheckLanes<8>>()) : on(std::type_identity<FastLanes<8>>());
    default:
        return checking ? on(std::type_identity<CheckLanes<16>>()) : on(std::type_identity<FastLanes<16>>());
    }
#else
    return checking ? on(std::type_identity<CheckScalar>()) : on(std::type_identity<FastScalar>());
#endif
}

/// Buffers and textures that a shader reads; shaders without any need not say so.
template <class Shader> std::vector<ResourceInfo> resources_of(Shader const& shader)
{
    if constexpr (requires { shader.resources(); })
        return shader.resources();
    else
        return {};
}

} // namespace tessemu
