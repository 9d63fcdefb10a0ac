// Domain shader stage: one invocation per domain point, lanes across the points of one patch.
//
// A domain shader is
//
//     struct S {
//         static constexpr TessellatorDomain kDomain;
//         static constexpr int kControlPoints;           // that it declares, as the hull shader's
//         template <class T> using ControlPoint = ...;   // the hull shader's records
//         template <class T> using PatchConstant = ...;
//         template <class T> using Output = ...;         // record; first member float4<T> position
//         template <class T> Output<T> operator()(
//             DomainInput<T> const&, ControlPoints<ControlPoint<T>> const&,
//             ControlPoints<PatchConstant<T>> const&) const;
//     };
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/machine.h"
#include "emu/statistics.h"
#include "emu/tessellator.h"

namespace tessemu {

/// SV_DomainLocation and SV_PrimitiveID. Each of u, v is a multiple of 2^-16 in [0,1]; w = 1-u-v is
/// given on a tri (exact), 0 elsewhere.
template <class T> struct DomainInput {
    T u, v, w;
    std::int32_t primitive_id = 0;
};

struct DomainBatch {
    float const* control_points;
    float const* patch_constants;
    std::int32_t primitive_id;
    float const* u; ///< padded to a whole group of lanes
    float const* v;
    std::size_t points;
    float* outputs; ///< out: component k of point i at [k * stride + i], whole groups are written
    std::size_t stride;
};

class DomainProgram {
public:
    virtual ~DomainProgram() = default;
    virtual TessellatorDomain domain() const = 0;
    virtual int control_points() const = 0;
    virtual int control_point_floats() const = 0;
    virtual int patch_constant_floats() const = 0;
    virtual OutputLayout output() const = 0;
    int output_floats() const { return output().floats; }
    virtual std::vector<ResourceInfo> resources() const = 0;
    /// Runs a patch, inside a StageScope that the caller holds open over many patches.
    /// `patch_constants` says how many registers the hull shader wrote.
    virtual void run(DomainBatch const& batch, int patch_constants,
                     StageCounters& counters) const = 0;
    /// The contraction seed of the stage's door.
    virtual std::uint64_t seed() const = 0;
};

template <class Shader, class T> class DomainProgramOn final : public DomainProgram {
    static constexpr int N = lanes_of<T>;
    using Point = typename Shader::template ControlPoint<T>;
    using Constant = typename Shader::template PatchConstant<T>;
    using Output = typename Shader::template Output<T>;

public:
    DomainProgramOn(Shader const& shader, std::uint64_t seed) : shader_(shader), seed_(seed) {}
    TessellatorDomain domain() const override { return Shader::kDomain; }
    int control_points() const override { return Shader::kControlPoints; }
    int control_point_floats() const override { return scalar_count<Point>(); }
    int patch_constant_floats() const override { return scalar_count<Constant>(); }
    OutputLayout output() const override { return output_layout<Output>(); }
    std::vector<ResourceInfo> resources() const override { return resources_of(shader_); }
    std::uint64_t seed() const override { return seed_; }

    // Flattened: only where shader and views are one function do the counts fold to a few
    // additions. With a sanitizer's checks in it that function would take minutes to compile.
#if !defined(__SANITIZE_ADDRESS__)
    [[gnu::flatten]]
#endif
    void
    run(DomainBatch const& b, int patch_constants, StageCounters& counters) const override
    {
        ControlPoints<Point> const points(b.control_points, Shader::kControlPoints);
        ControlPoints<Constant> const constants(b.patch_constants, patch_constants);
        for (std::size_t first = 0; first < b.points; first += N) {
            std::size_t const left = b.points - first;
            execution.activate(left >= std::size_t(N) ? (1u << N) - 1 : (1u << left) - 1);
            if constexpr (ScalarTraits<T>::kSites) site_state.scope = site_state.next = 0;
            Lanes<N> const u = Lanes<N>::load(b.u + first), v = Lanes<N>::load(b.v + first);
            Lanes<N> w(0.0f);
            if constexpr (Shader::kDomain == TessellatorDomain::Tri) w = Lanes<N>(1.0f) - u - v;
            Output const out =
                shader_(DomainInput<T>{T(u), T(v), T(w), b.primitive_id}, points, constants);
            float* at = b.outputs + first;
            for_each_scalar(out, [&](auto const& s) {
                lanes_value(s).store(at);
                at += b.stride;
            });
        }
        counters.invocations += b.points;
        counters.input_fetches += points.fetches();
        counters.input_touched += points.touched();
        counters.constant_fetches += constants.fetches();
        counters.constant_touched += constants.touched();
    }

private:
    Shader shader_;
    std::uint64_t seed_;
};

template <class Shader>
std::unique_ptr<DomainProgram> make_domain_program(Shader const& shader, Machine const& machine)
{
    return make_program<DomainProgramOn, DomainProgram>(shader, machine);
}

} // namespace tessemu
