// Where the runs of a study or tuning are made: the threads of this process, or the ranks of an
// MPI job. A run is a number; what it found travels as text, so that every pool gives the same
// bits.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fpc {

class RunPool {
 public:
  using Texts = std::vector<std::optional<std::string>>;
  /// What run `index` found; empty if it was cut short. Called from several threads.
  using Work = std::function<std::optional<std::string>(std::size_t index)>;
  /// Told of each new text as it comes, one at a time; may be empty.
  using Done = std::function<void(std::size_t index, const std::string& text)>;

  virtual ~RunPool() = default;
  /// Makes the runs named in `order` and puts what they found into `texts`; those cut short stay
  /// empty. If processes share the pool, all of them call fill() as often; `texts`, `order` and
  /// `done` count on the leading one only, and afterwards all have its texts. What work throws is
  /// thrown.
  virtual void fill(Texts& texts, const std::vector<std::size_t>& order, const Work& work,
                    const Done& done) = 0;
  /// Whether this process keeps files and speaks; exactly one of those that share the pool does.
  virtual bool leads() const { return true; }
  /// Runs at once, over all processes.
  virtual int width() const = 0;
};

/// Threads of this process. threads = 0: all cores. @throws InputError if threads < 0.
class ThreadPool : public RunPool {
 public:
  explicit ThreadPool(int threads);
  void fill(Texts& texts, const std::vector<std::size_t>& order, const Work& work,
            const Done& done) override;
  int width() const override { return threads_; }

 private:
  int threads_;
};

}  // namespace fpc
