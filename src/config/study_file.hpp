// A study file read into structs: which loops are compared, over which seeds, parameters, noise and
// records, and what is counted. All keys: docs/study_file.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/tuning_file.hpp"

namespace fpc {

/// One of the loops that are compared.
struct StudyLoop {
  std::string name;  ///< in tables
  std::string loop;  ///< name of config/loop, or path
  Overrides set;     ///< laid over it
};

struct StudyFile {
  std::string file;
  std::string title;
  std::string text;  ///< as read, or made of the options
  std::vector<StudyLoop> loops;
  std::string against;  ///< name of the loop that each other one is paired with
  Overrides set;        ///< laid over all loops
  std::vector<std::uint64_t> seeds;
  std::vector<Variation> vary;
  std::vector<std::pair<std::string, double>> noise;  ///< std by output, in its unit
  double noise_percent{};  ///< std of each output in percent of the span of its setpoints, or of
                           ///< the setpoint where that never changes; 0: none
  std::vector<TuningScenario> scenarios;  ///< records, schedules; crossed with the seeds
  FitnessParams fitness;
  bool noise_free{true};  ///< outputs are judged as the plant had them, not as they were measured
  int locked_samples{0};  ///< an input that long at its bound may be locked; 0: a tenth of the run
  int confidence_percent{95};
  /// @throws InputError naming the field.
  void validate() const;
};

/// A study file from its name in config/study, or path. @throws InputError listing the known names.
std::string findStudy(const std::string& name_or_path);
std::vector<std::string> studyNames();
/// @throws InputError naming file, line, key and what was expected.
StudyFile readStudy(const std::string& name_or_path);
StudyFile parseStudy(const std::string& text, const std::string& file);

}  // namespace fpc
