// What was seen of a plant while it was watched and tested.
#pragma once

#include <string>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// A row a sample: what was measured, and the inputs that were sent then.
class PlantRecord {
 public:
  PlantRecord() = default;
  explicit PlantRecord(const PlantInfo& plant) : info_(plant) {}
  /// After fillTo().
  void add(const Measurement& now, VectorRef sent);
  /// Rows of samples that never came before this one: NaN, the inputs held.
  /// @throws InputError where too many are missing, or the run is another one.
  void fillTo(const StepHeader& next);
  Eigen::Index rows() const { return rows_; }
  const PlantInfo& info() const { return info_; }
  /// rows x n each; NaN where a measurement is missing.
  auto outputs() const { return y_.topRows(rows_); }
  auto inputs() const { return u_.topRows(rows_); }
  auto disturbances() const { return d_.topRows(rows_); }
  auto applied() const { return applied_.topRows(rows_); }  ///< before the input of the row
  Matrix inputsAndDisturbances() const;

  /// Columns time[h], outputs, inputs, disturbances, NAME_applied. @throws InputError.
  void write(const std::string& file) const;
  static PlantRecord read(const std::string& file, const PlantInfo& plant);

 private:
  void reserve();

  PlantInfo info_;
  Eigen::Index rows_{};
  Matrix y_, u_, d_, applied_;
  StepHeader last_;
};

}  // namespace fpc
