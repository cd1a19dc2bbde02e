// Models: identified, read, simulated, judged.
#include <map>
#include <memory>
#include <optional>

#include "analysis/rule_models.hpp"
#include "base/csv.hpp"
#include "bind.hpp"
#include "config/structure_file.hpp"
#include "convert.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "model_handle.hpp"
#include "tool/commands.hpp"
#include "tool/identify_auto.hpp"
#include "tool/read_record.hpp"
#include "tool/record_files.hpp"
#include "watch.hpp"

namespace fpc::python {
namespace {

using ModelPtr = std::shared_ptr<ModelHandle>;
using tool::IdentifyArguments;
using tool::IdentifyTables;

/// A path of a CSV, or (name, columns, units, dates, rows x columns).
CsvTable tableFrom(py::handle record, const CsvFormat& format) {
  if (py::isinstance<py::str>(record)) return tool::readRecord(record.cast<std::string>(), format);
  const auto parts = record.cast<py::tuple>();
  CsvTable table;
  table.file = parts[0].cast<std::string>();
  table.names = parts[1].cast<Names>();
  table.units = parts[2].cast<Names>();
  table.is_date = parts[3].cast<std::vector<bool>>();
  table.texts.assign(table.names.size(), "");
  table.values = readMatrix(parts[4], countOf(table.names), table.file.c_str());
  return table;
}

/// Fields of the arguments by the names of the options.
void setArguments(const py::dict& options, IdentifyArguments& a) {
  for (const auto& item : options) {
    const auto key = item.first.cast<std::string>();
    const py::handle value = item.second;
    if (key == "structure")
      a.structure = value.cast<std::string>();
    else if (key == "rows")
      a.rows = value.cast<std::string>();
    else if (key == "validate_rows")
      a.validate_rows = value.cast<std::string>();
    else if (key == "inputs")
      a.inputs = value.cast<Names>();
    else if (key == "outputs")
      a.outputs = value.cast<Names>();
    else if (key == "disturbances")
      a.disturbances = value.cast<Names>();
    else if (key == "time")
      a.time = value.cast<std::string>();
    else if (key == "sample_time_s")
      a.sample_time_s = value.cast<double>();
    else if (key == "kind")
      a.kind = value.cast<std::string>();
    else if (key == "work")
      a.work = value.cast<double>();
    else if (key == "budget_s")
      a.budget_s = value.cast<double>();
    else if (key == "blocks")
      a.blocks = value.cast<int>();
    else if (key == "window")
      a.window = value.cast<int>();
    else if (key == "longest_delay")
      a.longest_delay = value.cast<int>();
    else if (key == "keep_inputs")
      a.keep_inputs = value.cast<bool>();
    else if (key == "known")
      a.known = value.cast<std::string>();
    else if (key == "seed")
      a.seed = value.cast<std::uint64_t>();
    else if (key == "name")
      a.out = value.cast<std::string>();
    else
      throw InputError("identify: unknown option '" + key + "'");
  }
}

ModelPtr identifyFrom(const py::list& records, const py::object& validation,
                      const py::dict& options, py::object progress) {
  IdentifyArguments a;
  setArguments(options, a);
  const bool automatic = a.structure.empty();
  const CsvFormat format =
      automatic ? tool::csvFormat(a.format) : readStructure(findStructure(a.structure)).csv;
  IdentifyTables tables;
  for (const py::handle record : records) tables.data.push_back(tableFrom(record, format));
  if (!validation.is_none()) tables.validation = tableFrom(validation, format);
  Watch watch{std::move(progress)};
  auto model = std::make_shared<ModelHandle>();
  bool cancelled = false;
  {
    const py::gil_scoped_release release;
    if (automatic) {
      tool::AutoReport report = tool::searchModel(
          a, tables, [&](const AutoProgress& p) { return watch.goOn(p.share, p.stage); });
      model->identified = std::move(report.model);
      model->report = report.json.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
    } else {
      tool::IdentifyReport report = tool::identifyWith(a, tables, [&](const IdentifyProgress& p) {
        return watch.goOn(p.share, p.output + ": " + p.stage);
      });
      cancelled = report.found.cancelled;
      model->identified.model = std::move(report.found.model);
      if (!cancelled) model->report = tool::toJson(report);
    }
  }
  watch.rethrow();
  if (cancelled) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
  return model;
}

/// y, u and d of the model, a row a sample.
DataSet dataOf(const TsModel& model, py::handle y, py::handle u, py::handle d) {
  DataSet data;
  data.source = "arrays";
  data.sample_time_s = model.sample_time_s;
  data.outputs = model.outputs;
  data.inputs = model.inputs;
  data.disturbances = model.disturbances;
  const Eigen::Index n_y = countOf(model.outputs), n_u = countOf(model.inputs),
                     n_d = countOf(model.disturbances);
  const Matrix outputs = readMatrix(y, n_y, "y");
  data.values.resize(outputs.rows(), n_y + n_u + n_d);
  data.values.leftCols(n_y) = outputs;
  const auto fill = [&](py::handle given, Eigen::Index first, Eigen::Index n, const char* what) {
    if (n == 0 && given.is_none()) return;
    const Matrix read = readMatrix(given, n, what);
    require(read.rows() == outputs.rows(), what, std::to_string(outputs.rows()) + " rows, as y");
    data.values.middleCols(first, n) = read;
  };
  fill(u, n_y, n_u, "u");
  fill(d, n_y + n_u, n_d, "d");
  data.constant.assign(static_cast<std::size_t>(data.values.cols()), false);
  return data;
}

int longestLag(const TsModel& model) {
  int lag = 0;
  for (const SignalKind kind : {SignalKind::kOutput, SignalKind::kInput, SignalKind::kDisturbance})
    for (std::size_t i = 0; i < model.signals(kind).size(); ++i)
      lag = std::max(lag, model.maxLag(kind, static_cast<int>(i)));
  return lag;
}

py::dict linearised(const ModelHandle& handle, py::handle y, py::handle u, py::handle d) {
  const TsModel& model = handle.identified.model;
  const auto middle = [](const std::vector<SignalInfo>& signals) {
    Vector values(countOf(signals));
    for (std::size_t i = 0; i < signals.size(); ++i) {
      const double mean = 0.5 * (signals[i].lower + signals[i].upper);
      values[static_cast<Eigen::Index>(i)] = std::isfinite(mean) ? mean : 0.0;
    }
    return values;
  };
  Vector outputs = middle(model.outputs), input = middle(model.inputs),
         disturbances = middle(model.disturbances);
  readSignals(y, namesOf(model.outputs), "y", outputs);
  readSignals(u, namesOf(model.inputs), "u", input);
  readSignals(d, namesOf(model.disturbances), "d", disturbances);
  const AffineModel linear = blendedModel(model, outputs, input, disturbances).affine;
  py::dict found;
  found["A"] = toArray(linear.A);
  found["B"] = toArray(linear.B);
  found["C"] = toArray(linear.C);
  found["offset_state"] = toArray(Vector(linear.g));
  return found;
}

}  // namespace

void bindModel(py::module_& m) {
  py::class_<ModelHandle, ModelPtr>(m, "Model")
      .def_property_readonly("name", [](const ModelHandle& h) { return h.identified.model.name; })
      .def_property_readonly("source",
                             [](const ModelHandle& h) { return h.identified.model.source; })
      .def_property_readonly("sample_time_s",
                             [](const ModelHandle& h) { return h.identified.model.sample_time_s; })
      .def_property_readonly(
          "outputs", [](const ModelHandle& h) { return listOf(h.identified.model.outputs); })
      .def_property_readonly("inputs",
                             [](const ModelHandle& h) { return listOf(h.identified.model.inputs); })
      .def_property_readonly(
          "disturbances",
          [](const ModelHandle& h) { return listOf(h.identified.model.disturbances); })
      .def_property_readonly("rules",
                             [](const ModelHandle& h) {
                               py::dict rules;
                               const TsModel& model = h.identified.model;
                               for (std::size_t i = 0; i < model.outputs.size(); ++i)
                                 rules[py::str(model.outputs[i].name)] =
                                     model.submodels[i].rules.size();
                               return rules;
                             })
      .def_property_readonly("longest_lag",
                             [](const ModelHandle& h) { return longestLag(h.identified.model); })
      .def_readonly("report", &ModelHandle::report)
      .def_property_readonly("text",
                             [](const ModelHandle& h) { return writeIdentified(h.identified); })
      .def_property_readonly("remarks",
                             [](const ModelHandle& h) {
                               py::list list;
                               for (const RuleRemark& r : reportModel(h.identified.model))
                                 list.append(py::make_tuple(r.output, r.rule, r.text));
                               return list;
                             })
      .def("free_run",
           [](const ModelHandle& h, py::handle y, py::handle u, py::handle d) {
             const DataSet data = dataOf(h.identified.model, y, u, d);
             return toArray(predictBest(h.identified, data).free_run);
           })
      .def("predict",
           [](const ModelHandle& h, py::handle y, py::handle u, py::handle d, int steps) {
             require(steps >= 1, "steps", "an integer >= 1");
             const DataSet data = dataOf(h.identified.model, y, u, d);
             if (steps == 1) return toArray(predictBest(h.identified, data).one_step);
             return toArray(predictSteps(h.identified, data, steps).best);
           })
      .def("validate",
           [](const ModelHandle& h, py::handle record, const std::string& rows,
              const Names& columns, int steps) {
             tool::ValidateArguments a;
             a.rows = rows;
             a.columns = columns;
             a.steps = steps;
             return tool::validateOn(tableFrom(record, tool::csvFormat(a.format)), h.identified, a)
                 .json.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
           })
      .def("linearise", &linearised);
  m.def("identify", &identifyFrom);
  m.def("read_model", [](const std::string& name) {
    return std::make_shared<ModelHandle>(ModelHandle{readIdentified(tool::requireModel(name)), {}});
  });
}

}  // namespace fpc::python
