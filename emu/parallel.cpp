// SPDX-License-Identifier: Apache-2.0
#include "emu/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <optional>

// Debian's oneTBB is not instrumented: under the thread sanitizer this file is not either, and
// tells by hand what orders what, so that races between our own work items still show.
#if defined(TESSEMU_THREAD_SANITIZER)
extern "C" void __tsan_acquire(void*);
extern "C" void __tsan_release(void*);
#endif

namespace tessemu {

namespace {
#if defined(TESSEMU_THREAD_SANITIZER)
void acquire(void* order)
{
    __tsan_acquire(order);
}
void release(void* order)
{
    __tsan_release(order);
}
#else
void acquire(void*) {}
void release(void*) {}
#endif
} // namespace

struct ThreadPool::Impl {
    std::optional<tbb::global_control> limit;
    tbb::task_arena arena;
};

ThreadPool::ThreadPool(int threads) : impl_(std::make_unique<Impl>())
{
    if (threads > 0) {
        impl_->limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
        impl_->arena.initialize(threads);
    } else {
        impl_->arena.initialize();
    }
}

ThreadPool::ThreadPool(Caller) {}

ThreadPool::~ThreadPool() = default;

int ThreadPool::threads() const
{
    return impl_ ? impl_->arena.max_concurrency() : 1;
}

void ThreadPool::parallel_for(std::size_t n, std::function<void(std::size_t)> const& work) const
{
    if (n == 1 || threads() == 1) {
        for (std::size_t i = 0; i < n; ++i) work(i);
        return;
    }
    char started = 0, ended = 0;
    release(&started);
    auto const item = [&](std::size_t i) {
        acquire(&started);
        work(i);
        release(&ended);
    };
    impl_->arena.execute(
        [&] { tbb::parallel_for(std::size_t(0), n, item, tbb::simple_partitioner()); });
    acquire(&ended);
}

} // namespace tessemu
