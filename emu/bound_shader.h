// A shader as a draw brings it: a program, and the values that the program reads.
//
// A program is code: a shader type compiled for a scalar, made once a process and without state.
// What differs from draw to draw (constants, buffers, textures, the contraction of sums) travels
// beside it, as Direct3D 11 keeps constant buffers and resources apart from shader objects. So a
// draw with other values costs one small allocation and no program.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/machine.h"

#include <utility>

namespace tessemu {

/// The values of a shader in a draw: the shader struct itself, and how its sums are contracted.
class ShaderBinding {
public:
    ShaderBinding() = default;
    template <class Shader>
    ShaderBinding(Shader const& shader, SiteState const& sites)
        : shader_(std::make_shared<Shader const>(shader)),
          sites_(sites)
    {
    }
    /// The shader that it was made of; another type is undefined behaviour.
    template <class Shader> Shader const& as() const
    {
        return *static_cast<Shader const*>(shader_.get());
    }
    SiteState const& sites() const { return sites_; }

private:
    std::shared_ptr<void const> shader_;
    SiteState sites_;
};

/// What every stage's program is; a stage's interface adds its functions.
class ShaderProgram {
public:
    virtual ~ShaderProgram() = default;
    /// Buffers and textures that it reads, and writes in a compute shader.
    virtual std::vector<ResourceInfo> resources(ShaderBinding const& binding) const = 0;
};

/// A program that was compiled from a shader.
template <class Interface, class Shader> class CompiledProgram : public Interface {
public:
    std::vector<ResourceInfo> resources(ShaderBinding const& binding) const final
    {
        return resources_of(binding.as<Shader>());
    }
};

/// A program and its values. Copies share both.
///
/// \tparam Program  a stage's interface: its functions that depend on values take a ShaderBinding
template <class Program> class BoundShader {
public:
    BoundShader() = default;
    BoundShader(std::nullptr_t) {}
    BoundShader(std::shared_ptr<Program const> program, ShaderBinding binding = {})
        : program_(std::move(program)),
          binding_(std::move(binding))
    {
    }

    explicit operator bool() const { return program_ != nullptr; }
    friend bool operator==(BoundShader const& s, std::nullptr_t) { return !s.program_; }
    Program const* operator->() const { return program_.get(); }
    Program const& program() const { return *program_; }
    ShaderBinding const& binding() const { return binding_; }
    SiteState const& sites() const { return binding_.sites(); }

    /// Buffers and textures that it reads, and writes in a compute shader.
    std::vector<ResourceInfo> resources() const
    {
        return program_ ? program_->resources(binding_) : std::vector<ResourceInfo>();
    }
    template <class... Arguments> void run(Arguments&&... arguments) const
    {
        program_->run(binding_, std::forward<Arguments>(arguments)...);
    }

private:
    std::shared_ptr<Program const> program_;
    ShaderBinding binding_;
};

/// A shader's program for a machine, with the shader's values.
template <template <class, class> class ProgramOn, class Interface, class Shader>
BoundShader<Interface> bind_shader(Shader const& shader, Machine const& machine)
{
    return {program_on_machine<Interface, Shader, ProgramOn>(machine), {shader, machine.sites()}};
}

} // namespace tessemu
