#include "runtime/commissioning/plant_record.hpp"

#include <algorithm>

#include "base/csv.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"

namespace fpc {
namespace {

using Eigen::Index;

const char kApplied[] = "_applied";
constexpr std::uint32_t kMostMissing = 30;  // samples in a row

}  // namespace

void PlantRecord::reserve() {
  const Index room = std::max<Index>(256, 2 * rows_);
  y_.conservativeResize(room, countOf(info_.outputs));
  u_.conservativeResize(room, countOf(info_.inputs));
  d_.conservativeResize(room, countOf(info_.disturbances));
  applied_.conservativeResize(room, countOf(info_.inputs));
}

void PlantRecord::fillTo(const StepHeader& next) {
  if (rows_ == 0 || last_.run_id == 0) return;
  require(next.run_id == last_.run_id && next.step > last_.step &&
              next.step - last_.step <= kMostMissing + 1,
          "plant", "a run without gaps of more than " + std::to_string(kMostMissing) + " samples");
  for (; last_.step + 1 < next.step; ++last_.step) {
    if (rows_ >= y_.rows()) reserve();
    y_.row(rows_).setConstant(kNaN);
    if (d_.cols() > 0) d_.row(rows_).setConstant(kNaN);
    u_.row(rows_) = u_.row(rows_ - 1);
    applied_.row(rows_) = u_.row(rows_ - 1);
    ++rows_;
  }
}

void PlantRecord::add(const Measurement& now, VectorRef sent) {
  fillTo(now.header);
  last_ = now.header;
  if (rows_ >= y_.rows()) reserve();
  y_.row(rows_) = now.outputs.transpose();
  u_.row(rows_) = sent.transpose();
  if (d_.cols() > 0) d_.row(rows_) = now.disturbances.transpose();
  applied_.row(rows_) = now.input_applied.transpose();
  ++rows_;
}

Matrix PlantRecord::inputsAndDisturbances() const {
  Matrix all(rows_, u_.cols() + d_.cols());
  all.leftCols(u_.cols()) = inputs();
  all.rightCols(d_.cols()) = disturbances();
  return all;
}

void PlantRecord::write(const std::string& file) const {
  CsvTable table;
  table.file = file;
  const auto name = [&](const std::string& column, const std::string& unit) {
    table.names.push_back(column);
    table.units.push_back(unit);
  };
  name("time", "h");
  for (const auto* group : {&info_.outputs, &info_.inputs, &info_.disturbances})
    for (const SignalInfo& s : *group) name(s.name, s.unit);
  for (const SignalInfo& s : info_.inputs) name(s.name + kApplied, s.unit);
  table.values.resize(rows_, static_cast<Index>(table.names.size()));
  for (Index k = 0; k < rows_; ++k)
    table.values(k, 0) = static_cast<double>(k) * info_.sample_time_s / 3600.0;
  table.values.rightCols(table.values.cols() - 1) << outputs(), inputs(), disturbances(), applied();
  writeCsv(table, file);
}

PlantRecord PlantRecord::read(const std::string& file, const PlantInfo& plant) {
  const CsvTable table = readCsv(file);
  PlantRecord record(plant);
  record.rows_ = table.rows();
  const auto take = [&](const std::vector<SignalInfo>& signals, const char* suffix, Matrix& to) {
    to.resize(table.rows(), countOf(signals));
    for (std::size_t i = 0; i < signals.size(); ++i)
      to.col(static_cast<Index>(i)) = table.values.col(table.column(signals[i].name + suffix));
  };
  take(plant.outputs, "", record.y_);
  take(plant.inputs, "", record.u_);
  take(plant.disturbances, "", record.d_);
  take(plant.inputs, kApplied, record.applied_);
  return record;
}

}  // namespace fpc
