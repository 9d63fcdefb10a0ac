// Triangles one by one, of any size, clipped where they must be: what the ways for many at a time
// leave over.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/fragment_shading.h"

namespace tessemu {

class SingleTriangles {
public:
    explicit SingleTriangles(FragmentShading& shading) : shading_(shading) {}

    /// Starts a draw, whose `setup` and `assembler` must outlive it.
    void bind(RasterSetup const& setup, PrimitiveAssembler const& assembler);
    /// Starts a chunk.
    void begin() { fragments_ = 0; }
    /// What is left of a triangle, whose fragments wait for the pixel shader from now on.
    /// \param v  its vertices
    void add(AssembledVertices& vertices, std::uint32_t const* v, std::int32_t primitive_id,
             AssemblyCounters& counters);
    /// Of the chunk.
    std::uint64_t fragments() const { return fragments_; }

private:
    void draw(AssembledVertices const& vertices, AssembledPrimitive const& p);

    FragmentShading& shading_;
    PrimitiveAssembler const* assembler_ = nullptr;
    Rect bounds_;
    std::vector<AssembledPrimitive> assembled_;
    std::uint64_t fragments_ = 0;
};

} // namespace tessemu
