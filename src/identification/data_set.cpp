// Takes the signals of a structure out of a table and refuses what cannot be identified from.
#include "identification/data_set.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "identification/data_repair.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr Index kFewestReadable = 10;

std::vector<StructureSignal> allSignals(const Structure& structure) {
  std::vector<StructureSignal> all = structure.outputs;
  all.insert(all.end(), structure.inputs.begin(), structure.inputs.end());
  all.insert(all.end(), structure.disturbances.begin(), structure.disturbances.end());
  return all;
}

/// @return true if the column holds one value only.
bool isConstant(const Eigen::Ref<const Vector>& values) {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  return !(highest > lowest);
}

bool sameColumn(const Eigen::Ref<const Vector>& a, const Eigen::Ref<const Vector>& b) {
  for (Index k = 0; k < a.size(); ++k)
    if (a[k] != b[k] && !(std::isnan(a[k]) && std::isnan(b[k]))) return false;
  return true;
}

void checkColumns(DataSet& data, const Structure& structure) {
  const auto signals = allSignals(structure);
  data.constant.assign(signals.size(), false);
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const std::string where = data.source + ": column '" + signals[i].column + "'";
    const auto column = data.values.col(static_cast<Index>(i));
    if (isConstant(column)) {
      const bool droppable = i >= structure.outputs.size() && structure.repair.drop_constant;
      require(droppable, where, "values that move; they are all the same");
      data.constant[i] = true;
      data.repairs.push_back("'" + signals[i].info.name +
                             "' never moves: its regressors tell nothing");
      continue;
    }
    for (std::size_t j = 0; j < i; ++j)
      require(data.constant[j] || !sameColumn(data.values.col(static_cast<Index>(j)), column),
              where,
              "other values than column '" + signals[j].column + "': one of the two is redundant");
  }
}

void setRanges(DataSet& data) {
  Index column = 0;
  for (auto* signals : {&data.outputs, &data.inputs, &data.disturbances})
    for (auto& signal : *signals) {
      const auto values = data.values.col(column++);
      signal.lower = std::numeric_limits<double>::infinity();
      signal.upper = -signal.lower;
      for (const double value : values)
        if (!std::isnan(value)) {
          signal.lower = std::min(signal.lower, value);
          signal.upper = std::max(signal.upper, value);
        }
      if (signal.lower < signal.upper) continue;  // a model file needs lower < upper
      signal.lower = -std::numeric_limits<double>::infinity();
      signal.upper = std::numeric_limits<double>::infinity();
    }
}

DataSet emptySet(const Structure& structure) {
  const TsModel names = structure.emptyModel();
  DataSet data;
  data.sample_time_s = structure.sample_time_s;
  data.outputs = names.outputs;
  data.inputs = names.inputs;
  data.disturbances = names.disturbances;
  return data;
}

void checkAndRepair(DataSet& data, const Structure& structure, const CellName& where) {
  require(data.values.rows() >= kFewestReadable, data.source,
          "at least " + std::to_string(kFewestReadable) + " rows, got " +
              std::to_string(data.values.rows()));
  holdLastInputs(data);
  repairCells(data, structure, allSignals(structure), where);
  checkColumns(data, structure);
  setRanges(data);
}

Index parseRow(const std::string& text, const std::string& whole, Index absent) {
  if (text.empty()) return absent;
  Index value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  require(result.ec == std::errc() && result.ptr == text.data() + text.size() && value >= 1,
          "rows '" + whole + "'", "FIRST:LAST, counted from 1");
  return value;
}

}  // namespace

RowRange parseRows(const std::string& text) {
  const auto colon = text.find(':');
  require(colon != std::string::npos, "rows '" + text + "'", "FIRST:LAST, counted from 1");
  const RowRange range{parseRow(text.substr(0, colon), text, 1),
                       parseRow(text.substr(colon + 1), text, 0)};
  require(range.last == 0 || range.first <= range.last, "rows '" + text + "'",
          "FIRST not above LAST");
  return range;
}

Index DataSet::column(SignalKind kind, int index) const {
  auto offset = static_cast<Index>(index);
  if (kind != SignalKind::kOutput) offset += static_cast<Index>(outputs.size());
  if (kind == SignalKind::kDisturbance) offset += static_cast<Index>(inputs.size());
  return offset;
}

DataSet makeDataSet(const CsvTable& table, const Structure& structure, RowRange range) {
  const Index last = range.last == 0 ? table.rows() : range.last;
  require(range.first >= 1 && range.first <= last && last <= table.rows(), table.file,
          "rows within 1:" + std::to_string(table.rows()) + ", got " + std::to_string(range.first) +
              ":" + std::to_string(last));
  const Index count = last - range.first + 1;
  DataSet data = emptySet(structure);
  data.source = table.file + " rows " + std::to_string(range.first) + ":" + std::to_string(last);
  const auto signals = allSignals(structure);
  data.values.resize(count, static_cast<Index>(signals.size()));
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const Index column = table.column(signals[i].column);
    const std::string& unit = table.units[static_cast<std::size_t>(column)];
    require(unit.empty() || signals[i].info.unit.empty() || unit == signals[i].info.unit,
            table.file + ": column '" + signals[i].column + "'",
            "the unit [" + signals[i].info.unit + "] of the structure, got [" + unit + "]");
    data.values.col(static_cast<Index>(i)) =
        table.values.col(column).segment(range.first - 1, count);
  }
  TableRows rows(static_cast<std::size_t>(count));
  std::iota(rows.begin(), rows.end(), range.first - 1);
  if (!structure.time_column.empty())
    rows = repairTime(data, table, structure, range.first - 1, count);
  checkAndRepair(data, structure, [&](Index column, Index row) {
    const std::string& name = signals[static_cast<std::size_t>(column)].column;
    const Index of_table = rows[static_cast<std::size_t>(row)];
    return of_table < 0 ? table.file + ": column '" + name + "': the times lack data row " +
                              std::to_string(row + 1)
                        : table.at(of_table, table.column(name));
  });
  return data;
}

DataSet makeDataSet(const Matrix& values, const Structure& structure, const std::string& source) {
  DataSet data = emptySet(structure);
  data.source = source;
  const auto columns = static_cast<Index>(allSignals(structure).size());
  require(values.cols() == columns, source, std::to_string(columns) + " columns");
  data.values = values;
  const auto signals = allSignals(structure);
  checkAndRepair(data, structure, [&](Index column, Index row) {
    return source + ": column '" + signals[static_cast<std::size_t>(column)].column +
           "', data row " + std::to_string(row + 1);
  });
  return data;
}

}  // namespace fpc
