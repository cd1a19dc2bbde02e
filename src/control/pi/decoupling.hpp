// Inverted decoupling of two loops: what the other input does to an output is taken out before it
// happens. Sampled, causal, without algebraic loop. Source: garrido2010;
// mekki, eq. 19, with the sign that decouples: subtracted.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/fopdt.hpp"

namespace fpc {

/// u_1 = c_1 - D12 u_2, u_2 = c_2 - D21 u_1 with
///   D12(z) = K12 (1 - a12) (1 - a11/z) / (K11 (1 - a11) (1 - a12/z)) z^-(theta12 - theta11) / Ts
/// and likewise D21: output i then answers c_i through G_ii alone. All in deviations from where the
/// loop rested. A delay of no whole number of samples is interpolated linearly.
class InvertedDecoupling {
 public:
  /// Why these elements cannot be decoupled, in words; empty if they can. Each cross dead time must
  /// not be shorter than the direct one of its output (else the future of an input is needed), and
  /// one of the two must be longer by a sample (else u_1(k) and u_2(k) each wait for the other).
  static std::string refusal(const FopdtMatrix& model, double sample_time_min);
  /// @throws InputError with the refusal.
  InvertedDecoupling(const FopdtMatrix& model, double sample_time_min);

  /// Both inputs have always been at these.
  void rest(double input_1, double input_2);
  /// Takes what was really applied at k-1; crosses() then belong to sample k.
  void record(double input_1, double input_2);
  /// Gains of the model from now on; the dynamics stay. No allocation.
  void setGains(const std::array<std::array<double, 2>, 2>& gains);
  /// u(k) for c(k): what is to be subtracted is in cross(). Nothing is remembered but by record().
  std::array<double, 2> apply(const std::array<double, 2>& asked);
  const std::array<double, 2>& cross() const { return cross_; }  ///< D12 u_2, D21 u_1 at k

 private:
  struct Path {
    double a_own{}, a_cross{}, scale{}, ratio{};  ///< scale: of the unit-gain filter
    int whole{};                                  ///< samples of delay, and the rest of it
    double fraction{};
    std::vector<double> past;  ///< v(k-1), v(k-2), ...: past[next - 1], ...
    std::size_t next{};
    double filtered{};  ///< at k-1
    double delayed(double present, int more) const;
    double at(double present) const;  ///< of the unit-gain filter at k, for v(k)
  };
  std::array<Path, 2> paths_;
  std::array<double, 2> cross_{};
};

}  // namespace fpc
