// What the fuzzy predictive law believes of the process: everything whose size depends on the
// model.
#pragma once

#include <utility>

#include "fmbpc/control/coincidence.hpp"
#include "fmbpc/fuzzy/local_model.hpp"

namespace fpc {

struct FmbpcBelief {
  FmbpcBelief(TsModel model, Eigen::Index n_y, Eigen::Index n_u)
      : local(std::move(model)),
        gains(local.stateSize(), n_u, n_y),
        state(Vector::Zero(local.stateSize())),
        measured(state),
        next(state),
        offset_state(state),
        offset_output(Vector::Zero(n_y)),
        error_filtered(offset_output),
        outputs(offset_output),
        lacking(offset_output) {}

  /// Takes over the memory of another belief; false if their states have other rows.
  bool inherit(const FmbpcBelief& other, bool realigned);

  LocalModel local;
  CoincidenceGains gains;
  Vector state;           ///< xi(k): own (parallel) or measured (realigned)
  Vector measured;        ///< the same rows filled with measurements
  Vector next;            ///< xi(k) as predicted at k-1
  Vector offset_state;    ///< g
  Vector offset_output;   ///< y - y_m
  Vector error_filtered;  ///< w_hat
  Vector outputs;         ///< y_m, for signals
  Vector lacking;         ///< e, without C A^H xi
};

}  // namespace fpc
