#include "study/run_pool.hpp"

#include <mutex>

#include "base/parallel.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {

ThreadPool::ThreadPool(int threads) : threads_(threads == 0 ? coreCount() : threads) {
  require(threads >= 0, "threads", "an integer >= 0 (0: all cores)");
}

void ThreadPool::fill(Texts& texts, const std::vector<std::size_t>& order, const Work& work,
                      const Done& done) {
  std::mutex mutex;
  parallelFor(order.size(), threads_, [&](std::size_t i) {
    std::optional<std::string> text = work(order[i]);
    if (!text) return;
    const std::lock_guard<std::mutex> lock(mutex);
    if (done) done(order[i], *text);
    texts[order[i]] = std::move(text);
  });
}

}  // namespace fpc
