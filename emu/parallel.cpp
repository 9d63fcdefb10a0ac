// SPDX-License-Identifier: Apache-2.0
#include "emu/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <optional>

namespace tessemu {

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

ThreadPool::~ThreadPool() = default;

int ThreadPool::threads() const
{
    return impl_->arena.max_concurrency();
}

void ThreadPool::parallel_for(std::size_t n, std::function<void(std::size_t)> const& work) const
{
    if (n == 1 || threads() == 1) {
        for (std::size_t i = 0; i < n; ++i) work(i);
        return;
    }
    impl_->arena.execute([&] {
        tbb::parallel_for(
            std::size_t(0), n, [&](std::size_t i) { work(i); }, tbb::simple_partitioner());
    });
}

} // namespace tessemu
