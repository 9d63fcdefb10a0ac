// An uninitialised array for megabytes: large pages where the system has them, since targets are
// walked by columns and touched anew each frame.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace tessemu {

template <class T> class LargeArray {
    static_assert(std::is_trivial_v<T>);

public:
    explicit LargeArray(std::size_t n) : data_(allocate(n * sizeof(T))) {}
    T* get() const { return data_.get(); }

private:
    struct Free {
        void operator()(T* p) const { std::free(p); }
    };
    static T* allocate(std::size_t bytes)
    {
        constexpr std::size_t kPage = std::size_t(1) << 21;
        bool const large = bytes >= kPage;
        std::size_t const unit = large ? kPage : 64;
        bytes = (bytes + unit - 1) / unit * unit;
        void* const p = std::aligned_alloc(unit, bytes ? bytes : unit);
        if (!p) throw std::bad_alloc();
#if defined(__linux__)
        if (large) madvise(p, bytes, MADV_HUGEPAGE); // a hint
#endif
        return static_cast<T*>(p);
    }
    std::unique_ptr<T, Free> data_;
};

} // namespace tessemu
