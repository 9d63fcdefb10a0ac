// The machine a shader runs on: lanes, contraction, and the two scalars that it is compiled for.
//
// Fast: the widest lanes that the build's instruction set fills, products and sums apart. Checking:
// at most eight of them, where each sum asks at run time whether it takes its product; with
// Contraction::None it gives the fast machine's bits and counts. A build with TESSEMU_ALL_LANES has
// both for 4, 8 and 16 lanes, to show that results do not depend on them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/contracted.h"
#include "emu/error.h"
#include "emu/memory.h"

#include <algorithm>
#include <memory>
#include <type_traits>
#include <vector>

namespace tessemu {

struct Machine {
    int lanes = kNativeLanes; ///< that the build holds; changes no result and no count
    Contraction contraction = Contraction::None;
    std::uint64_t seed = 0; ///< of Contraction::Mixed
    /// Runs the checking form though nothing is contracted.
    bool checking = false;

    /// The thread's state at a stage's door.
    SiteState sites() const { return {contraction, seed}; }
};

template <int N> using FastLanes = Counted<Lanes<N>>;
template <int N> using CheckLanes = Contracted<Counted<Lanes<N>>>;
using FastScalar = FastLanes<kNativeLanes>;
using CheckScalar = CheckLanes<std::min(kNativeLanes, 8)>;

/// Lane counts that the build holds, ascending.
#if defined(TESSEMU_ALL_LANES)
inline constexpr int kBuiltLanes[] = {4, 8, 16};
#else
inline constexpr int kBuiltLanes[] = {kNativeLanes};
#endif

/// Throws Error that names the build option for lanes that the build does not hold.
void check_lanes(int lanes);

namespace detail {
/// Code has no state: one object for the process, which nobody owns.
template <class Interface, class Program> std::shared_ptr<Interface const> only_program()
{
    static Program const program{};
    return {std::shared_ptr<void>(), &program};
}
} // namespace detail

/// A stage's program: the shader type compiled for the machine's scalar, made once a process.
/// Throws Error for lanes that the build does not hold.
template <class Interface, class Shader, template <class, class> class ProgramOn>
std::shared_ptr<Interface const> program_on_machine(Machine const& machine)
{
    check_lanes(machine.lanes);
    auto const on = []<class Fast, class Check>(bool checking, Fast, Check) {
        return checking ? detail::only_program<Interface, ProgramOn<Shader, typename Check::type>>()
                        : detail::only_program<Interface, ProgramOn<Shader, typename Fast::type>>();
    };
    bool const checking = machine.checking || machine.contraction != Contraction::None;
#if defined(TESSEMU_ALL_LANES)
    if (machine.lanes == 4)
        return on(checking, std::type_identity<FastLanes<4>>(),
                  std::type_identity<CheckLanes<4>>());
    if (machine.lanes == 8)
        return on(checking, std::type_identity<FastLanes<8>>(),
                  std::type_identity<CheckLanes<8>>());
    return on(checking, std::type_identity<FastLanes<16>>(), std::type_identity<CheckLanes<16>>());
#else
    return on(checking, std::type_identity<FastScalar>(), std::type_identity<CheckScalar>());
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
