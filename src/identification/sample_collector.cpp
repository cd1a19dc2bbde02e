#include "identification/sample_collector.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "model/longest_lag.hpp"

namespace fpc {
namespace {

constexpr std::uint64_t kLongestBreak =
    1000;  // rows that are kept; rows() shortens breaks to the longest lag

double finiteOrMissing(double value) { return std::isfinite(value) ? value : kNaN; }

bool allMissing(const std::vector<double>& row) {
  return std::all_of(row.begin(), row.end(), [](double value) { return std::isnan(value); });
}

/// Numbers of the newest rows, without those of breaks that are longer than any lag needs.
std::vector<std::size_t> neededRows(const std::deque<std::vector<double>>& rows, std::size_t newest,
                                    std::size_t lag) {
  std::vector<std::size_t> needed;
  std::size_t missing = 0;
  for (std::size_t k = rows.size() - newest; k < rows.size(); ++k) {
    missing = allMissing(rows[k]) ? missing + 1 : 0;
    if (missing <= lag + 1) needed.push_back(k);
  }
  return needed;
}

}  // namespace

SampleCollector::SampleCollector(PlantInfo plant, std::size_t window)
    : plant_(std::move(plant)),
      window_(window),
      n_y_(plant_.outputs.size()),
      n_u_(plant_.inputs.size()),
      n_d_(plant_.disturbances.size()) {}

Arrival SampleCollector::take(const Measurement& m) {
  const auto fits = [](const Vector& v, std::size_t n, const char* field) {
    require(static_cast<std::size_t>(v.size()) == n, std::string("measurement.") + field,
            std::to_string(n) + " numbers");
  };
  fits(m.outputs, n_y_, "outputs");
  fits(m.disturbances, n_d_, "disturbances");
  fits(m.input_applied, n_u_, "input_applied");
  const std::uint32_t before = gate_.last().step;
  const Arrival arrival = gate_.pass(m.header);
  if (!isNew(arrival)) return arrival;
  if (arrival == Arrival::kFirst || arrival == Arrival::kNewRun) ++counts_.runs;
  if (arrival == Arrival::kNewRun || arrival == Arrival::kResync) breakRows(kLongestBreak);
  if (arrival == Arrival::kGap) {
    counts_.missing += m.header.step - before - 1;
    breakRows(std::min<std::uint64_t>(m.header.step - before - 1, kLongestBreak));
  }
  if ((arrival == Arrival::kNext || arrival == Arrival::kGap) && !rows_.empty())
    for (std::size_t j = 0; j < n_u_; ++j)
      rows_.back()[n_y_ + j] = finiteOrMissing(m.input_applied[static_cast<Eigen::Index>(j)]);
  Row row;
  row.reserve(n_y_ + n_u_ + n_d_);
  for (const double value : m.outputs) row.push_back(finiteOrMissing(value));
  row.resize(n_y_ + n_u_, kNaN);
  for (const double value : m.disturbances) row.push_back(finiteOrMissing(value));
  push(std::move(row));
  ++counts_.samples;
  if (m.outputs.allFinite() && m.disturbances.allFinite() && m.input_applied.allFinite())
    present_ = m;
  else
    ++counts_.incomplete;
  return arrival;
}

void SampleCollector::push(Row row) {
  rows_.push_back(std::move(row));
  if (window_ > 0 && rows_.size() > window_) rows_.pop_front();
}

void SampleCollector::breakRows(std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i) push(Row(n_y_ + n_u_ + n_d_, kNaN));
}

std::size_t SampleCollector::placeOf(const StructureSignal& signal,
                                     const std::vector<SignalInfo>& of, std::size_t offset,
                                     const char* kind) const {
  const std::string where = std::string("structure ") + kind + "." + signal.info.name;
  for (std::size_t i = 0; i < of.size(); ++i) {
    if (of[i].name != signal.info.name) continue;
    require(signal.info.unit.empty() || signal.info.unit == of[i].unit, where,
            "the plant's unit '" + of[i].unit + "', got '" + signal.info.unit + "'");
    return offset + i;
  }
  throw InputError(where + ": expected one of the plant's " + kind + " " + join(namesOf(of)));
}

Matrix SampleCollector::rows(const Structure& structure, std::size_t newest) const {
  require(std::abs(structure.sample_time_s - plant_.sample_time_s) <= 1e-9 * plant_.sample_time_s,
          "structure sample_time_s",
          "the plant's " + exactText(plant_.sample_time_s) + ", got " +
              exactText(structure.sample_time_s));
  std::vector<std::size_t> places;
  for (const auto& s : structure.outputs)
    places.push_back(placeOf(s, plant_.outputs, 0, "outputs"));
  for (const auto& s : structure.inputs)
    places.push_back(placeOf(s, plant_.inputs, n_y_, "inputs"));
  for (const auto& s : structure.disturbances)
    places.push_back(placeOf(s, plant_.disturbances, n_y_ + n_u_, "disturbances"));
  const std::size_t count = newest == 0 ? rows_.size() : std::min(newest, rows_.size());
  const auto needed = neededRows(rows_, count, static_cast<std::size_t>(longestLag(structure)));
  Matrix table(static_cast<Eigen::Index>(needed.size()), static_cast<Eigen::Index>(places.size()));
  for (std::size_t k = 0; k < needed.size(); ++k)
    for (std::size_t j = 0; j < places.size(); ++j)
      table(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j)) =
          rows_[needed[k]][places[j]];
  const auto first = static_cast<Eigen::Index>(structure.outputs.size());
  const auto n = static_cast<Eigen::Index>(structure.inputs.size());
  if (table.rows() > 1)
    table.row(table.rows() - 1).segment(first, n) = table.row(table.rows() - 2).segment(first, n);
  return table;
}

}  // namespace fpc
