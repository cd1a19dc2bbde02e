// A record of a known process and its structure as files, for tests of `fmbpc identify`.
#pragma once

#include <nlohmann/json.hpp>

#include "base/csv.hpp"
#include "identification/identify_fixture.hpp"
#include "runtime/loop_fixture.hpp"
#include "tool/tool_run.hpp"

namespace fpc {

class IdentifyTool : public LoopFolder {
 protected:
  IdentifyTool() {
    data_ = writeRecord("data.csv", record());
    structure_ = write("known.yaml", kStructure);
  }

  /// Noise-free: time[s], y[mg/l], u[m3/h].
  static CsvTable record(Eigen::Index rows = 300) {
    const Matrix values = test::knownRecord(rows, 1);
    CsvTable table;
    table.names = {"time", "y", "u"};
    table.units = {"s", "mg/l", "m3/h"};
    table.values.resize(values.rows(), 3);
    table.values.col(0) = Vector::LinSpaced(rows, 0.0, static_cast<double>(rows - 1));
    table.values.rightCols(2) = values;
    return table;
  }
  std::string writeRecord(const std::string& name, const CsvTable& table) const {
    writeCsv(table, path(name));
    return path(name);
  }
  std::string onRecord(const std::string& rest) const {
    return "identify " + data_ + " " + structure_ + " " + rest;
  }
  static nlohmann::json parsed(const std::string& text) { return nlohmann::json::parse(text); }

  static inline const std::string kStructure =
      "name: known\nsample_time_s: 1\ntime: {column: time, unit: s}\n"
      "outputs: {y: {unit: mg/l, plausible: [-50, 50]}}\ninputs: {u: {unit: m3/h}}\nsubmodels:\n"
      "  y:\n    N_y: {y: 1}\n    N_u: {u: 1}\n    antecedents: [u(k)]\n    clusters: 3\n";
  std::string data_, structure_;
};

}  // namespace fpc
