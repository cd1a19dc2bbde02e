#include "runtime/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plant/simulation.hpp"

namespace fpc {

Trajectory::Trajectory(const LoopFile& loop, const RecordLayout& layout, Row row)
    : layout_(layout),
      clock_(loop.plant_info.sample_time_s, loop.simulation.start_time_s),
      from_(std::max(
          0.0,
          std::ceil(loop.report.record_from_h * 3600.0 / loop.plant_info.sample_time_s - 1e-6))),
      row_(std::move(row)),
      step_(layout.first_step) {
  column("time", "h", [this](const View& view) { return clock_.hoursAt(view.step); });
  addOutputs();
  addInputs();
  addDisturbances(loop);
  addTracking();
  addActions(loop.has_clp);
  addOtherStates();
}

void Trajectory::column(const std::string& name, const std::string& unit, Value value) {
  names_.push_back(name);
  units_.push_back(unit);
  values_.push_back(std::move(value));
}

void Trajectory::addOutputs() {
  for (std::size_t i = 0; i < layout_.info.outputs.size(); ++i) {
    const SignalInfo& y = layout_.info.outputs[i];
    column(y.name, y.unit, [k = static_cast<Eigen::Index>(i)](const View& view) {
      return view.now.has_measurement ? view.now.measurement.outputs[k] : kNaN;
    });
  }
}

void Trajectory::addInputs() {
  for (std::size_t i = 0; i < layout_.info.inputs.size(); ++i) {
    const SignalInfo& u = layout_.info.inputs[i];
    column(u.name, u.unit, [k = static_cast<Eigen::Index>(i)](const View& view) {
      const bool known = view.next != nullptr && view.next->has_measurement;
      return known ? view.next->measurement.input_applied[k] : kNaN;
    });
  }
}

/// The true disturbances where the simulator tells them, else the measured ones.
void Trajectory::addDisturbances(const LoopFile& loop) {
  if (!layout_.states.empty()) {
    const auto all = makePlant(loop.simulation)->description().disturbances;
    for (std::size_t i = 0; i < all.size(); ++i)
      column(all[i].name, all[i].unit, [k = static_cast<Eigen::Index>(i)](const View& view) {
        return view.now.has_state ? view.now.state.disturbances[k] : kNaN;
      });
    return;
  }
  for (std::size_t i = 0; i < layout_.info.disturbances.size(); ++i) {
    const SignalInfo& d = layout_.info.disturbances[i];
    column(d.name, d.unit, [k = static_cast<Eigen::Index>(i)](const View& view) {
      return view.now.has_measurement ? view.now.measurement.disturbances[k] : kNaN;
    });
  }
}

void Trajectory::addTracking() {
  for (std::size_t i = 0; i < layout_.info.outputs.size(); ++i) {
    const SignalInfo& y = layout_.info.outputs[i];
    const auto k = static_cast<Eigen::Index>(i);
    column(y.name + "_setpoint", y.unit, [k](const View& view) {
      return view.now.has_tracking ? view.now.tracking.setpoint[k] : kNaN;
    });
    column(y.name + "_reference", y.unit, [k](const View& view) {
      return view.now.has_tracking ? view.now.tracking.reference[k] : kNaN;
    });
    if (layout_.states.empty()) continue;
    column(y.name + "_true", y.unit,
           [k](const View& view) { return view.now.has_state ? view.now.state.outputs[k] : kNaN; });
  }
}

void Trajectory::addActions(bool has_optimizer) {
  for (std::size_t i = 0; i < layout_.info.inputs.size(); ++i) {
    const SignalInfo& u = layout_.info.inputs[i];
    const auto k = static_cast<Eigen::Index>(i);
    column(u.name + "_commanded", u.unit,
           [k](const View& view) { return view.now.has_action ? view.now.action.input[k] : kNaN; });
    column(u.name + "_base", u.unit,
           [k](const View& view) { return view.now.has_base ? view.now.base.input[k] : kNaN; });
    if (!has_optimizer) continue;
    column(u.name + "_perturbation", u.unit, [k](const View& view) {
      const Vector& c = view.now.report.perturbation;
      return view.now.has_report && k < c.size() ? c[k] : kNaN;
    });
  }
}

void Trajectory::addOtherStates() {
  for (std::size_t i = 0; i < layout_.states.size(); ++i) {
    const bool is_output =
        std::any_of(layout_.info.outputs.begin(), layout_.info.outputs.end(),
                    [&](const SignalInfo& output) { return output.name == layout_.states[i]; });
    if (is_output) continue;
    column(layout_.states[i], layout_.state_units[i],
           [k = static_cast<Eigen::Index>(i)](const View& view) {
             return view.now.has_state ? view.now.state.state[k] : kNaN;
           });
  }
}

void Trajectory::emit(const SampleRecord* next) {
  const View view{step_, *now_, next};
  cells_.clear();
  for (const Value& value : values_) cells_.push_back(value(view));
  row_(cells_);
}

void Trajectory::add(const SampleRecord& sample) {
  if (now_) {
    if (static_cast<double>(step_) >= from_) emit(&sample);
    ++step_;
  }
  now_ = sample;
}

void Trajectory::close() {
  if (now_) emit(nullptr);
  now_.reset();
}

TrajectoryFile::TrajectoryFile(const LoopFile& loop, const RecordLayout& layout,
                               const std::string& file)
    : writer_(file),
      rows_(loop, layout, [this](const std::vector<double>& cells) { writer_.row(cells); }) {
  writer_.header(rows_.names(), rows_.units());
}

void TrajectoryFile::close() {
  rows_.close();
  writer_.close();
}

}  // namespace fpc
