// Floating-point environment of a stage: IEEE arithmetic, denormals kept or flushed.
//
// Bit-exact results need three compiler flags, PUBLIC on the CMake target (contraction off, no
// errno, no traps), and no fast-math. D3D11 flushes denormals at every arithmetic operation of a
// shader (rule R9); the fixed-function tessellator is defined on plain IEEE numbers. The mode
// belongs to the thread, so every worker sets it at the stage's door and restores it on leaving.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#ifdef __FAST_MATH__
#error "tessemu needs IEEE arithmetic: do not compile with -ffast-math or -Ofast"
#endif

#include <xmmintrin.h>

namespace tessemu {

/// Sets the thread's denormal mode for the guard's lifetime and restores it afterwards.
class DenormalMode {
public:
    enum Kind : unsigned {
        Keep = 0,       ///< IEEE: denormals are numbers
        Flush = 0x8040, ///< D3D11 rule R9: denormal inputs and results become signed zero
    };

    explicit DenormalMode(Kind kind) : saved_(_mm_getcsr())
    {
        unsigned const wanted = (saved_ & ~0x8040u) | kind;
        if (wanted != saved_) _mm_setcsr(wanted);
    }
    ~DenormalMode() { _mm_setcsr(saved_); }
    DenormalMode(DenormalMode const&) = delete;
    DenormalMode& operator=(DenormalMode const&) = delete;

private:
    unsigned saved_;
};

} // namespace tessemu
