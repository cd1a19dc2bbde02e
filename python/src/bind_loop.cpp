// Loops and their runs.
#include <chrono>
#include <memory>

#include "bind.hpp"
#include "config/command_file.hpp"
#include "convert.hpp"
#include "export/export.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"
#include "stepped_controller.hpp"
#include "stepped_plant.hpp"
#include "study/seeded_loop.hpp"
#include "watch.hpp"

namespace fpc::python {
namespace {

/// A run that was made here, with its loop.
struct MadeRun {
  LoopPtr loop;
  RunRecord record;
  double wall_s{};
  bool interrupted{};
};

LoopPtr readLoopFrom(const std::string& name, const Overrides& overrides) {
  return withoutGil([&] { return std::make_shared<const LoopFile>(readLoop(name, overrides)); });
}

std::shared_ptr<MadeRun> runHere(LoopPtr loop, const std::string& commands, py::object progress) {
  auto run = std::make_shared<MadeRun>();
  run->loop = std::move(loop);
  Watch watch{std::move(progress)};
  RunOptions options;
  if (!commands.empty()) options.commands = readCommands(commands, *run->loop);
  double share = 0.0;
  options.progress = [&share](std::uint32_t step, std::uint32_t samples) {
    share = static_cast<double>(step) / samples;
  };
  options.stop = [&] { return !watch.goOn(share); };
  watch.during([&] {
    const auto start = std::chrono::steady_clock::now();
    run->record = runLoop(*run->loop, options);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    run->wall_s = wall.count();
  });
  run->interrupted = watch.interrupted();
  return run;
}

py::tuple tableOf(const MadeRun& run) {
  const CsvTable table = withoutGil([&] { return trajectoryOf(*run.loop, run.record); });
  // Column by column, so that each is a vector without gaps.
  py::array_t<double, py::array::f_style> values({table.values.rows(), table.values.cols()});
  std::copy_n(table.values.data(), table.values.size(), values.mutable_data());
  return py::make_tuple(table.names, table.units, values);
}

std::string titleOf(const LoopFile& loop) {
  return loop.report.title.empty() ? loop.name : loop.report.title;
}

std::vector<std::string> exportHere(const LoopFile& loop, const std::string& folder, bool c99,
                                    bool structured_text, bool single, const std::string& name,
                                    int samples, std::uint64_t seed) {
  return withoutGil([&] {
    return exportLoop(
        loop, {c99, structured_text, single, name, samples, seed, "fmbpc " FMBPC_VERSION, ""},
        folder);
  });
}

}  // namespace

py::list listOf(const std::vector<SignalInfo>& signals) {
  py::list list;
  for (const SignalInfo& s : signals) list.append(py::make_tuple(s.name, s.unit, s.lower, s.upper));
  return list;
}

py::list listOf(const std::vector<Event>& events) {
  py::list list;
  for (const Event& e : events)
    list.append(py::make_tuple(kindOf(e.code).name, nameOf(e.severity()), e.signal, e.text, e.first,
                               e.last, e.count));
  return list;
}

void bindLoop(py::module_& m) {
  py::class_<LoopFile, std::shared_ptr<LoopFile>>(m, "Loop")
      .def_readonly("name", &LoopFile::name)
      .def_readonly("file", &LoopFile::file)
      .def_property_readonly("title", &titleOf)
      .def_readonly("resolved", &LoopFile::resolved)
      .def_readonly("model_file", &LoopFile::model_file)
      .def_property_readonly("plant", [](const LoopFile& l) { return l.plant_info.name; })
      .def_property_readonly("external", [](const LoopFile& l) { return l.external_plant; })
      .def_property_readonly("type", [](const LoopFile& l) { return l.controllerType().name; })
      .def_readonly("has_optimizer", &LoopFile::has_clp)
      .def_property_readonly(
          "seeded_keys",
          [](const LoopFile& l) { return seededKeys(l, l.simulation.noise_std.any()); })
      .def_property_readonly("samples", [](const LoopFile& l) { return l.simulation.samples; })
      .def_property_readonly("sample_time_s",
                             [](const LoopFile& l) { return l.plant_info.sample_time_s; })
      .def_property_readonly("outputs",
                             [](const LoopFile& l) { return listOf(l.plant_info.outputs); })
      .def_property_readonly("inputs",
                             [](const LoopFile& l) { return listOf(l.plant_info.inputs); })
      .def_property_readonly("disturbances",
                             [](const LoopFile& l) { return listOf(l.plant_info.disturbances); })
      .def("run",
           [](std::shared_ptr<LoopFile> loop, const std::string& commands, py::object progress) {
             return runHere(std::move(loop), commands, std::move(progress));
           })
      .def(
          "controller",
          [](std::shared_ptr<LoopFile> loop) {
            return withoutGil([&] { return std::make_unique<SteppedController>(std::move(loop)); });
          })
      .def("simulation",
           [](std::shared_ptr<LoopFile> loop) {
             return withoutGil([&] { return std::make_unique<LoopPlant>(std::move(loop)); });
           })
      .def("export", &exportHere);
  py::class_<MadeRun, std::shared_ptr<MadeRun>>(m, "Run")
      .def("table", &tableOf)
      .def("summary",
           [](const MadeRun& r) {
             return withoutGil([&] { return toJson(summarize(*r.loop, r.record, r.wall_s)); });
           })
      .def("save",
           [](const MadeRun& r, const std::string& folder) {
             const py::gil_scoped_release release;
             writeRun(*r.loop, r.record, summarize(*r.loop, r.record, r.wall_s), folder);
           })
      .def_readonly("wall_s", &MadeRun::wall_s)
      .def_readonly("interrupted", &MadeRun::interrupted)
      .def_property_readonly("complete", [](const MadeRun& r) { return r.record.complete; });
  m.def("read_loop", [](const std::string& name, const Overrides& overrides) {
    return std::const_pointer_cast<LoopFile>(readLoopFrom(name, overrides));
  });
  m.def("loop_names", &loopNames);
}

}  // namespace fpc::python
