// Independent work on all cores: indices are handed out one by one, results belong to indices, so
// that answers do not depend on the number of threads.
#pragma once

#include <cstddef>
#include <functional>

namespace fpc {

/// Number of cores, at least 1.
int coreCount();

/// work(i) for i = 0..n-1 on `threads` threads (0: all cores), this one among them. Returns when
/// all are done. What work throws is thrown here, that of the lowest index; the others are still
/// done.
/// @throws InputError if threads < 0.
void parallelFor(std::size_t n, int threads, const std::function<void(std::size_t)>& work);

}  // namespace fpc
