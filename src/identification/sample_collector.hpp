// Measurements of a running plant gathered as rows for identification: row k holds y(k) and the
// u(k), d(k) that act from then on, although u(k) only comes with measurement k + 1.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "base/step_gate.hpp"
#include "fmbpc/base/exchange.hpp"
#include "identification/structure.hpp"

namespace fpc {

/// What was collected since the collector was made.
struct CollectorCounts {
  std::uint64_t samples{};     ///< measurements taken
  std::uint64_t missing{};     ///< samples that never came, within runs
  std::uint64_t incomplete{};  ///< samples with a value that is not finite
  std::uint64_t runs{};        ///< runs of the plant that gave samples
};

/// Between two runs, and for samples that never came, rows of NaN stand: no regression reaches
/// across them.
class SampleCollector {
 public:
  /// `window`: only the newest so many rows are kept, those of NaN included; 0 keeps all.
  SampleCollector(PlantInfo plant, std::size_t window);

  /// Repeated, old and foreign samples are left out (see arrivals()); values that are not finite
  /// become NaN.
  /// @return what the sample was; it was taken if isNew(). @throws InputError naming a wrong size.
  Arrival take(const Measurement& measurement);
  /// From now on only samples of this run count.
  void announce(std::uint64_t run_id) { gate_.announce(run_id); }
  /// Rows in the window.
  std::size_t size() const { return rows_.size(); }
  const CollectorCounts& counts() const { return counts_; }
  const ArrivalCounts& arrivals() const { return gate_.counts(); }
  const StepHeader& last() const { return gate_.last(); }  ///< of the sample taken last
  /// The last complete sample; step and run of it are in its header. Empty outputs if there is
  /// none.
  const Measurement& present() const { return present_; }

  /// The newest `newest` rows (0: all) with the signals of the structure in its order, rows x (n_y
  /// + n_u + n_d). The u of the last row is not known yet: the one before stands there, nothing is
  /// predicted from it.
  /// @throws InputError naming a signal that the plant lacks or whose unit differs, or another
  /// sample time.
  Matrix rows(const Structure& structure, std::size_t newest = 0) const;

 private:
  using Row = std::vector<double>;  // outputs, inputs, disturbances of the plant

  void push(Row row);
  void breakRows(std::uint64_t count);
  std::size_t placeOf(const StructureSignal& signal, const std::vector<SignalInfo>& of,
                      std::size_t offset, const char* kind) const;

  PlantInfo plant_;
  std::size_t window_, n_y_, n_u_, n_d_;
  StepGate gate_;
  CollectorCounts counts_;
  Measurement present_;
  std::deque<Row> rows_;
};

}  // namespace fpc
