// What a tuner minimises: the loop run with other numbers, over scenarios, on all cores.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/tuning_file.hpp"
#include "study/run_pool.hpp"

namespace fpc {

/// Of one point.
struct TuningScore {
  double cost{};
  std::vector<double> scenarios;  ///< cost of each
  int failures{};                 ///< runs that failed
  std::string trouble;            ///< of the first of them, in words
};

class TuningObjective {
 public:
  using Stop = std::function<bool()>;  ///< may be empty; called from several threads

  /// `set` is laid over the loop (and the tuning file's own `set`) in every scenario. Runs the
  /// untouched loop on all scenarios.
  /// threads: 0 = all cores. @throws InputError: a key or signal that the loop has not, a scenario
  /// without what its seed is for, fitness.relative where the untouched loop fails or costs 0.
  TuningObjective(const std::string& loop, TuningFile tuning, const Overrides& set, int threads);
  /// The same, the runs made in a pool that others may share.
  TuningObjective(const std::string& loop, TuningFile tuning, const Overrides& set,
                  std::shared_ptr<RunPool> pool);

  Eigen::Index size() const { return static_cast<Eigen::Index>(tuning_.parameters.size()); }
  /// Where a search begins: the loop's own numbers (or those of `start`), as shares 0..1 of the
  /// ranges, moved into them; the middle where it has none.
  const Vector& start() const { return start_; }
  /// The loop's own numbers as they stand, which untouched() judges; NaN where it has none.
  const std::vector<double>& own() const { return own_; }
  std::vector<double> values(const Vector& shares) const;
  /// What a tuned loop file changes: `set` and the values.
  Overrides changes(const Vector& shares) const;

  /// Columns are points in the unit box. Empty if stopped. The answer does not depend on the number
  /// of threads. `known`: what runs are known to have found, point by point and scenario by
  /// scenario (empty: nothing); `done` is told of each other one.
  std::optional<std::vector<TuningScore>> judge(const Matrix& points, const Stop& stop = {},
                                                RunPool::Texts known = {},
                                                const RunPool::Done& done = {}) const;
  std::optional<TuningScore> judgeHeldOut(const Vector& point, const Stop& stop = {}) const;
  const TuningScore& untouched() const { return untouched_; }
  const TuningScore& untouchedHeldOut() const { return untouched_held_out_; }
  const TuningFile& tuning() const { return tuning_; }
  /// Changes when the loop files, the models and records they name, the tuning file or the
  /// overrides do.
  const std::string& fingerprint() const { return fingerprint_; }
  RunPool& pool() const { return *pool_; }

 private:
  /// A scenario ready to run.
  struct Case {
    std::string name, text;
    FitnessParams fitness;  ///< the terms that count in it
    double scale{1.0};      ///< cost of the untouched loop if costs are relative
  };
  struct Run {
    double cost{};
    std::string trouble;
    bool stopped{false};
  };
  std::vector<Case> casesOf(const std::string& loop, const std::vector<TuningScenario>& scenarios);
  std::vector<double> ownValues() const;
  Vector startOf() const;
  Run run(const Case& scenario, const Overrides& changes, const Stop& stop) const;
  std::vector<Run> runAll(const std::vector<Case>& cases, const std::vector<Overrides>& changes,
                          const Stop& stop, RunPool::Texts known, const RunPool::Done& done) const;
  std::optional<std::vector<TuningScore>> judge(const std::vector<Case>& cases,
                                                const std::vector<Overrides>& changes,
                                                const Stop& stop, RunPool::Texts known,
                                                const RunPool::Done& done) const;
  static std::string textOf(const Run& run);
  static Run runOf(const std::optional<std::string>& text);
  TuningScore scoreOf(const std::vector<Run>& runs, std::size_t first, std::size_t count) const;
  void judgeUntouched(std::vector<Case>& cases, TuningScore& untouched) const;
  Overrides valueOverrides(const Vector& shares) const;

  TuningFile tuning_;
  Overrides set_;
  std::shared_ptr<RunPool> pool_;
  std::vector<Case> cases_, held_out_;
  std::vector<double> own_;
  Vector start_;
  TuningScore untouched_, untouched_held_out_;
  std::string fingerprint_;
};

}  // namespace fpc
