// Exact motion of a transfer matrix over one sample: within it each lag sees at most two held
// values of its delayed input. Private to the room.
#pragma once

#include <vector>

#include "plant/transfer_matrix.hpp"

namespace fpc {

class TransferStepper final : public PlantStepper {
 public:
  /// Keeps a reference to `plant`. @throws InputError for a dead time of more than 1e6 samples.
  TransferStepper(const TransferMatrixPlant& plant, double sample_time_s);
  void reset(VectorRef u, VectorRef d) override;
  void advance(Eigen::Ref<Vector> x, VectorRef u, VectorRef d) override;

 private:
  /// The two pieces of a sample: the older value acts for `first` of it, then the newer one.
  struct Delay {
    std::vector<double> past;  ///< u(k), u(k-1), ... as a ring
    std::size_t next{};
    double first{}, second{};  ///< time units; either may be 0
  };
  void move(std::size_t i, double drive, double time, double& inner, double& share) const;

  const TransferMatrixPlant& plant_;
  std::vector<Delay> delays_;  // one per element
  Vector shares_;
};

}  // namespace fpc
