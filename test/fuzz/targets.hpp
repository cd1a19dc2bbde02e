// What the fuzzers call with any bytes: each answers with an InputError in words or with a result
// that holds what it promises; anything else escapes and is a finding. The committed corpora are
// replayed by replay_test.cpp, so that every finding becomes a test.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fpc::fuzz {

using Target = void (*)(const std::string& bytes);

void loopFile(const std::string& bytes);       ///< read; run over at most 30 samples, limits held
void modelFile(const std::string& bytes);      ///< read, written, read again: the same
void structureFile(const std::string& bytes);  ///< read
void tuningFile(const std::string& bytes);     ///< read
void csvTable(const std::string& bytes);       ///< read in three formats; resampled
void qp(const std::string& bytes);             ///< solved, or infeasible with a certificate
// With ROS:
void message(const std::string& bytes);  ///< read; if it can be, it comes back the same
void exchange(
    const std::string& bytes);       ///< a run with messages lost, late and changed: it ends well
void bag(const std::string& bytes);  ///< read as a table

struct NamedTarget {
  const char* name;  ///< folder of its corpus
  Target run;
  bool decisions{};  ///< any bytes mean something, so that random ones find something too
};
const std::vector<NamedTarget>& targets();  ///< of targets.cpp or ros_targets.cpp

}  // namespace fpc::fuzz
