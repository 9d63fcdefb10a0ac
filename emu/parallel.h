// Threads: the one door to oneTBB.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace tessemu {

/// Runs independent work items on a fixed number of threads. A result never depends on the schedule
/// because callers write by item index and add integers.
class ThreadPool {
public:
    /// \param threads  1 or more, also more than the machine has; 0: all hardware threads
    explicit ThreadPool(int threads = 0);
    /// The calling thread alone: for work inside an item of another pool's.
    struct Caller {};
    explicit ThreadPool(Caller);
    ~ThreadPool();
    ThreadPool(ThreadPool const&) = delete;
    ThreadPool& operator=(ThreadPool const&) = delete;

    int threads() const;

    /// work(i) for 0 <= i < n, in any order, on any thread; returns when all are done.
    void parallel_for(std::size_t n, std::function<void(std::size_t)> const& work) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_; // none: the calling thread
};

} // namespace tessemu
