// A loop's law with its guard, optimizer and identifier before a plant that is not ours.
#pragma once

#include <memory>

#include "convert.hpp"
#include "model_handle.hpp"
#include "runtime/loop_controller.hpp"
#include "used_alone.hpp"

namespace fpc::python {

using LoopPtr = std::shared_ptr<const LoopFile>;

/// Sample by sample what runLoop() does with the same measurements, bit for bit.
class SteppedController : public UsedAlone {
 public:
  explicit SteppedController(LoopPtr loop);

  /// u(k), n_u, inside the limits of the loop. See Controller.step() of the package.
  /// @throws InputError, then nothing has happened.
  Array step(py::handle outputs, py::handle setpoint, py::handle disturbance, py::handle applied,
             py::handle quality);
  /// Sample 0 of a new run.
  Array reset(py::handle outputs, py::handle setpoint, py::handle disturbance, py::handle applied,
              py::handle quality);
  void manual(py::handle input);
  void automatic();
  void releaseSetpoint();
  bool retune(const Settings& settings);
  bool adapt(bool on);
  void setModel(const ModelHandle& model);

  std::uint32_t steps() const { return step_; }  ///< answered in this run
  Array setpoint() const;
  Array reference() const;
  std::string source() const;
  const std::vector<Event>& events() const { return events_; }  ///< of the last sample
  py::object prediction() const;  ///< a dict of arrays; None: the law does not predict
  py::dict signals() const;
  py::dict settings() const;
  py::object report() const;  ///< of the optimizer; None without

 private:
  void begin();
  Array answer();

  LoopPtr loop_;
  Names outputs_, inputs_, disturbances_, measured_;  // measured: outputs, then disturbances
  SampleClock clock_;
  LoopController controller_;
  std::uint64_t run_id_{1};
  std::uint32_t step_{};
  Measurement now_;                                    // the sample that is answered
  Vector outputs_good_, disturbances_good_, applied_;  // what counts where nothing new is said
  Vector setpoint_;                                    // in force by setpoint=; NaN: the schedule's
  std::vector<Event> events_;
};

}  // namespace fpc::python
