// Does a valve follow its signal? Stiction and backlash from what a loop records anyway.
#pragma once

#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// A valve that sticks and slips: it rests until its signal has gone `band` back, or `jump` on
/// after a stop, then jumps by `jump` and follows. jump 0: pure backlash. Source: kano2004
class StickingValve {
 public:
  StickingValve(double band, double jump) : band_(band), jump_(jump) {}
  /// Where the valve stands at this signal. The first signal is where it stands.
  double move(double signal);

 private:
  double band_, jump_, position_{}, signal_{}, turned_{};
  int way_{1};
  bool started_{false}, rests_{false};
};

/// A valve that comes to rest after every slip: the force on it builds up until it exceeds static
/// friction, (band + jump) / 2, and falls to that of motion, (band - jump) / 2. Source: he2007
class SlippingValve {
 public:
  SlippingValve(double band, double jump)
      : still_(0.5 * (band + jump)), moves_(0.5 * (band - jump)) {}
  double move(double signal);  ///< as StickingValve::move()

 private:
  double still_, moves_, position_{}, signal_{}, force_{};
  bool started_{false};
};

/// The valve that explains a record best, beside a linear one.
struct ValveFit {
  double band{};               ///< in units of the signal; 0: a linear valve does as well
  double jump{};               ///< at most `band`
  double share{};              ///< of the variance that a linear valve leaves unexplained
  double significance{};       ///< F of the best band against none
  double jump_significance{};  ///< F of the jump against pure backlash
  bool sticks{};               ///< certain, with a jump
  bool plays{};                ///< certain, without
};

/// The error of a linear model one step ahead, over a grid of bands and jumps of both kinds of
/// valve: y from its past, the signal's and the valve's. Certain only where the signal turns ten
/// times by more than half of the band (only turns show one), and where it explains more than an
/// answer that bends smoothly: a gain that changes is no valve. Source: jelali2008, karra2009
/// @param signal, y  equally long, NaN where unknown
/// @param delay      largest dead time that is expected [means]
/// @param factor     samples in a mean; at least 1000 means are needed, else the fit is empty
ValveFit fitValve(const std::vector<double>& signal, const std::vector<double>& y, int delay,
                  Eigen::Index factor);

}  // namespace fpc
