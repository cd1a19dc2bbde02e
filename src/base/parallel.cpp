#include "base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

/// Asked once: the answer is read from files of the system.
int coreCount() {
  static const int count = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return count;
}

void parallelFor(std::size_t n, int threads, const std::function<void(std::size_t)>& work) {
  require(threads >= 0, "threads", "an integer >= 0 (0: all cores)");
  const auto asked = static_cast<std::size_t>(threads == 0 ? coreCount() : threads);
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> errors(n);
  const auto serve = [&] {
    for (std::size_t i = next++; i < n; i = next++) {
      try {
        work(i);
      } catch (...) {
        errors[i] = std::current_exception();
      }
    }
  };
  std::vector<std::thread> others;
  for (std::size_t t = 1; t < std::min(asked, n); ++t) others.emplace_back(serve);
  serve();
  for (auto& other : others) other.join();
  for (const auto& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace fpc
