// A process as a matrix of lags with dead times, moved exactly: inputs that are held between
// samples reach each lag at their delayed times, whole or fractional in samples. The shipped case
// is the Wood-Berry column (R. K. Wood, M. W. Berry, Chem. Eng. Sci. 28 (1973) 1707-1717).
#pragma once

#include <string>
#include <vector>

#include "fmbpc/plant/plant.hpp"

namespace fpc {

/// One element: K exp(-theta s) / ((tau s + 1) (tau_2 s + 1)), from an input or a disturbance.
struct TransferElement {
  std::string output, from;       ///< names; `from` is an input or a disturbance
  double gain{};                  ///< output unit per unit of `from`
  double time_constant{};         ///< tau > 0, time units of the matrix
  double dead_time{};             ///< theta >= 0
  double second_time_constant{};  ///< tau_2 >= 0; 0 is a first-order element
};

/// Deviations from the nominal values of all signals: y = y_nominal + sum of the elements.
struct TransferMatrix {
  std::string name, title;
  double time_unit_s{60.0};
  std::vector<Quantity> outputs, inputs, disturbances;
  std::vector<TransferElement> elements;
  bool empty() const { return elements.empty(); }
  /// @throws InputError naming the element or signal: unknown or repeated names, an output without
  /// elements, values that are not finite or out of range.
  void validate() const;
};

/// Methanol and water: top y_D and bottom x_B [mol%] from reflux L, steam V and feed F [lb/min],
/// minutes; L, V and F are deviations from the operating point.
TransferMatrix woodBerry();

/// States: the outputs, then what each element but the first contributes to its output ("y_D_V"),
/// and the inner lag of each second-order element ("y_D_V_inner"); the first element's share is
/// what is left. Disturbances: those of the matrix, then "gain/OUTPUT/FROM" of every element, which
/// a command or a record may change while the plant runs (hidden from controllers). A gain acts on
/// the lag's input, after the dead time. derivatives() are those without dead times: the same
/// steady states.
class TransferMatrixPlant final : public Plant {
 public:
  /// @throws InputError, see TransferMatrix::validate().
  explicit TransferMatrixPlant(TransferMatrix matrix);
  const PlantDescription& description() const override { return description_; }
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override;
  std::unique_ptr<PlantStepper> makeStepper(double sample_time_s) const override;

  /// Where an element lives in x, u and d.
  struct Place {
    Eigen::Index output{};
    Eigen::Index share{-1};  ///< its state; -1: the first element of its output
    Eigen::Index inner{-1};  ///< its inner lag; -1: first order
    Eigen::Index source{};   ///< of u, or of d if from_disturbance
    bool from_disturbance{};
    Eigen::Index gain{};  ///< of d
    double source_nominal{}, output_nominal{};
  };
  const TransferMatrix& matrix() const { return matrix_; }
  const std::vector<Place>& places() const { return places_; }
  /// What element i contributes to its output in state x.
  double share(std::size_t i, VectorRef x) const;

 private:
  void place();
  void describe();

  TransferMatrix matrix_;
  std::vector<Place> places_;
  PlantDescription description_;
};

}  // namespace fpc
