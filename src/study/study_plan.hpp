// The runs of a study: every loop on every case, a case being a scenario with a seed. All loops get
// the same seeds, drawn numbers and noise, so that they are compared in pairs.
#pragma once

#include <string>
#include <vector>

#include "config/study_file.hpp"

namespace fpc {

/// What one pair of runs has in common.
struct StudyCase {
  std::string name;      ///< "seed 7", "storm", "storm, seed 7"
  std::string scenario;  ///< empty if the study has none
  bool has_seed{false};
  std::uint64_t seed{};
  std::vector<double> drawn;  ///< of StudyFile::vary, in its order: factors or numbers
};

class StudyPlan {
 public:
  /// @throws InputError: a loop that does not read, a key that it has not, a seed without use.
  explicit StudyPlan(StudyFile study);

  const StudyFile& study() const { return study_; }
  const std::vector<StudyCase>& cases() const { return cases_; }
  std::size_t runs() const { return study_.loops.size() * cases_.size(); }
  std::size_t loopOf(std::size_t run) const { return run / cases_.size(); }
  std::size_t caseOf(std::size_t run) const { return run % cases_.size(); }
  /// The loop of a run, ready to read.
  LoopFile loop(std::size_t run) const;
  /// Changes when the study, a loop file, one of their overrides, or a model or record that a loop
  /// names does.
  const std::string& fingerprint() const { return fingerprint_; }

 private:
  /// A loop under one scenario, before seeds.
  struct Prepared {
    std::string text;                 ///< resolved
    std::string contents;             ///< of the files it names
    std::vector<double> numbers;      ///< its own, of vary
    std::vector<std::string> seeded;  ///< keys that take the seed
    Overrides noise;
  };
  Prepared prepare(const StudyLoop& loop, const TuningScenario* scenario) const;
  void makeCases();

  StudyFile study_;
  std::vector<StudyCase> cases_;
  std::vector<std::vector<Prepared>> prepared_;  // by loop, by scenario
  std::string fingerprint_;
};

}  // namespace fpc
