// The machine a shader runs on: lanes, contraction, and the table that turns both into a scalar
// type.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/contracted.h"
#include "emu/error.h"
#include "emu/memory.h"

#include <memory>

namespace tessemu {

/// What the shader compiler does to a product that feeds a sum (choice I-6).
enum class Contraction {
    None,  ///< two roundings
    All,   ///< one rounding wherever a sum can take the product
    Mixed, ///< site by site, from a seed; for testing shaders
};

struct Machine {
    int lanes = kNativeLanes; ///< 4, 8 or 16; changes no result and no count
    Contraction contraction = Contraction::None;
    std::uint64_t seed = 0; ///< of Contraction::Mixed
};

namespace detail {
template <template <class, class> class Program, class Interface, class Shader, int N>
std::unique_ptr<Interface> make_program_on(Shader const& shader, Machine const& machine)
{
    using T = Counted<Lanes<N>>;
    switch (machine.contraction) {
    case Contraction::All:
        return std::make_unique<Program<Shader, Contracted<T, policy::All>>>(shader, machine.seed);
    case Contraction::Mixed:
        return std::make_unique<Program<Shader, Contracted<T, policy::Mixed>>>(shader,
                                                                               machine.seed);
    default:
        return std::make_unique<Program<Shader, T>>(shader, machine.seed);
    }
}
} // namespace detail

/// A stage's program: the shader compiled for the machine's scalar.
template <template <class, class> class Program, class Interface, class Shader>
std::unique_ptr<Interface> make_program(Shader const& shader, Machine const& machine)
{
    switch (machine.lanes) {
    case 4:
        return detail::make_program_on<Program, Interface, Shader, 4>(shader, machine);
    case 8:
        return detail::make_program_on<Program, Interface, Shader, 8>(shader, machine);
    case 16:
        return detail::make_program_on<Program, Interface, Shader, 16>(shader, machine);
    default:
        throw Error("lanes is " + std::to_string(machine.lanes) + ", it must be 4, 8 or 16");
    }
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
