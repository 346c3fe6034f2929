#pragma once

#include <cstddef>
#include <functional>
#include <span>

namespace isorim::quadrature {

/// body(task, thread) for every task in [0, count), tasks begun in increasing order on up to `threads` threads (0:
/// all that OpenMP offers), thread in [0, thread_count(threads)).
///
/// An exception thrown by body does not leave the parallel region: tasks not yet begun are dropped, and the exception
/// of the smallest failing task is rethrown, so the message does not depend on the number of threads. `progress`, if
/// any, is called from the calling thread alone with the fraction of finished tasks.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t, int)>& body,
                  const std::function<void(double)>& progress = {});

/// Calls body once, with a team of up to `threads` threads (0: all that OpenMP offers) standing by for together().
void with_team(int threads, const std::function<void()>& body);

/// Runs the tasks, side by side as far as threads of with_team() are free, and returns when all are done. Tasks may
/// call together() themselves. Of exceptions, that of the first task in the list is rethrown, after the others have
/// ended.
void together(std::span<const std::function<void()>> tasks);

/// The number of threads that `threads` asks for: itself, or all that OpenMP offers if 0.
int thread_count(int threads);

}  // namespace isorim::quadrature
