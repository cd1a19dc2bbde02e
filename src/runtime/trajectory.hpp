// trajectory.csv, row by row: what a record of any length becomes without being kept.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/csv_writer.hpp"
#include "config/loop_file.hpp"
#include "fmbpc/base/sample_clock.hpp"
#include "runtime/recorder_session.hpp"

namespace fpc {

/// A row for each sample from `report.record_from_h` on, and of the last one at least. The input
/// of a row is known from the sample after it, so that a row follows one sample late.
class Trajectory {
 public:
  using Row = std::function<void(const std::vector<double>&)>;

  Trajectory(const LoopFile& loop, const RecordLayout& layout, Row row);
  Trajectory(const Trajectory&) = delete;  // its columns know where it is
  Trajectory& operator=(const Trajectory&) = delete;
  const std::vector<std::string>& names() const { return names_; }
  const std::vector<std::string>& units() const { return units_; }
  void add(const SampleRecord& sample);
  void close();  ///< the last row

 private:
  struct View {
    std::uint32_t step;
    const SampleRecord& now;
    const SampleRecord* next;  // none: the last
  };
  using Value = std::function<double(const View&)>;
  void column(const std::string& name, const std::string& unit, Value value);
  void addOutputs();
  void addInputs();
  void addDisturbances(const LoopFile& loop);
  void addTracking();
  void addActions(bool has_optimizer);
  void addOtherStates();
  void emit(const SampleRecord* next);

  RecordLayout layout_;
  SampleClock clock_;
  double from_;  // first step that has a row
  Row row_;
  std::vector<std::string> names_, units_;
  std::vector<Value> values_;
  std::vector<double> cells_;
  std::optional<SampleRecord> now_;
  std::uint32_t step_{};
};

/// Writes trajectory.csv as writeCsv() would write the whole table.
class TrajectoryFile {
 public:
  /// @throws InputError if it cannot be written.
  TrajectoryFile(const LoopFile& loop, const RecordLayout& layout, const std::string& file);
  TrajectoryFile(const TrajectoryFile&) = delete;
  TrajectoryFile& operator=(const TrajectoryFile&) = delete;
  void add(const SampleRecord& sample) { rows_.add(sample); }
  void close();  ///< @throws InputError if there was no room for all of it.

 private:
  CsvWriter writer_;
  Trajectory rows_;
};

}  // namespace fpc
