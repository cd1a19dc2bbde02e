// Models: identified, read, simulated, judged.
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "analysis/rule_models.hpp"
#include "base/csv.hpp"
#include "bind.hpp"
#include "config/loop_file.hpp"
#include "config/structure_file.hpp"
#include "convert.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "identification/row_reading.hpp"
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

/// Sets a field from a value of Python.
using Setter = std::function<void(IdentifyArguments&, py::handle)>;

template <typename T>
Setter into(T IdentifyArguments::*field) {
  return [field](IdentifyArguments& a, py::handle value) { a.*field = value.cast<T>(); };
}

/// Fields of the arguments by the names of the options; what is left out is as the tool has it.
void setArguments(const py::dict& options, IdentifyArguments& a) {
  static const std::map<std::string, Setter> fields{
      {"structure", into(&IdentifyArguments::structure)},
      {"rows", into(&IdentifyArguments::rows)},
      {"validate_rows", into(&IdentifyArguments::validate_rows)},
      {"inputs", into(&IdentifyArguments::inputs)},
      {"outputs", into(&IdentifyArguments::outputs)},
      {"disturbances", into(&IdentifyArguments::disturbances)},
      {"time", into(&IdentifyArguments::time)},
      {"sample_time_s", into(&IdentifyArguments::sample_time_s)},
      {"kind", into(&IdentifyArguments::kind)},
      {"work", into(&IdentifyArguments::work)},
      {"budget_s", into(&IdentifyArguments::budget_s)},
      {"blocks", into(&IdentifyArguments::blocks)},
      {"window", into(&IdentifyArguments::window)},
      {"reach", into(&IdentifyArguments::reach)},
      {"longest_delay", into(&IdentifyArguments::longest_delay)},
      {"input_row", into(&IdentifyArguments::input_row)},
      {"keep_inputs", into(&IdentifyArguments::keep_inputs)},
      {"known", into(&IdentifyArguments::known)},
      {"seed", into(&IdentifyArguments::seed)},
      {"name", into(&IdentifyArguments::out)}};
  for (const auto& [key, value] : options) {
    const auto name = key.cast<std::string>();
    const auto field = fields.find(name);
    require(field != fields.end(), "identify", "an option, not '" + name + "'");
    try {
      field->second(a, value);
    } catch (const py::cast_error&) {
      throw InputError(name + ": expected another type of value");
    }
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
  watch.during([&] {
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
      if (!cancelled) model->report = tool::toJson(report);
      model->identified.model = std::move(report.found.model);
    }
  });
  if (cancelled) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
  return model;
}

/// Rows of the model's signals, outputs first, all missing.
DataSet emptyData(const TsModel& model, Eigen::Index rows) {
  DataSet data;
  data.source = "arrays";
  data.sample_time_s = model.sample_time_s;
  data.outputs = model.outputs;
  data.inputs = model.inputs;
  data.disturbances = model.disturbances;
  data.values.setConstant(
      rows, countOf(model.outputs) + countOf(model.inputs) + countOf(model.disturbances), kNaN);
  data.constant.assign(static_cast<std::size_t>(data.values.cols()), false);
  return data;
}

/// y, u and d of the model, a row a sample, as it reads them.
DataSet dataOf(const IdentifiedModel& identified, py::handle y, py::handle u, py::handle d) {
  const TsModel& model = identified.model;
  const Eigen::Index n_y = countOf(model.outputs), n_u = countOf(model.inputs),
                     n_d = countOf(model.disturbances);
  const Matrix outputs = readMatrix(y, n_y, "y");
  DataSet data = emptyData(model, outputs.rows());
  data.values.leftCols(n_y) = outputs;
  const auto fill = [&](py::handle given, Eigen::Index first, Eigen::Index n, const char* what) {
    if (n == 0 && given.is_none()) return;
    const Matrix read = readMatrix(given, n, what);
    require(read.rows() == outputs.rows(), what, std::to_string(outputs.rows()) + " rows, as y");
    data.values.middleCols(first, n) = read;
  };
  fill(u, n_y, n_u, "u");
  fill(d, n_y + n_u, n_d, "d");
  return asRead(data, identified.same_row);
}

Eigen::Index longestLag(const TsModel& model) {
  Eigen::Index longest = 0;
  for (const OutputModel& s : model.submodels)
    for (const auto* list : {&s.antecedents, &s.regressors})
      for (const Regressor& r : *list) longest = std::max<Eigen::Index>(longest, r.lag);
  return longest;
}

/// What acts on the model, u and d side by side, a row a sample.
Matrix actingOn(const TsModel& model, py::handle u, py::handle d) {
  const Matrix input = readMatrix(u, countOf(model.inputs), "u");
  require(input.rows() > 0, "u", "rows");
  const Matrix disturbances =
      d.is_none() ? Matrix(input.rows(), 0) : readMatrix(d, countOf(model.disturbances), "d");
  require(disturbances.cols() == countOf(model.disturbances) && disturbances.rows() == input.rows(),
          "d", std::to_string(input.rows()) + " rows, as u");
  require(input.allFinite(), "u", "finite numbers");
  require(disturbances.allFinite(), "d", "finite numbers");
  Matrix acting(input.rows(), input.cols() + disturbances.cols());
  acting << input, disturbances;
  return acting;
}

/// Outputs from a rest at `start` and the first row of what acts on; row 0 is `start`. Models of
/// the outputs' past begin with it in all of it, those with a state of their own with the state
/// that a longer rest gives.
Matrix simulated(const ModelHandle& handle, const Vector& start, const Matrix& acting) {
  IdentifiedModel m = handle.identified;
  m.reach = 0;
  const auto n_y = countOf(m.model.outputs);
  const auto from = [&](Eigen::Index rest) {
    DataSet data = emptyData(m.model, rest + acting.rows());
    data.values.topRows(rest + 1).leftCols(n_y).rowwise() = start.transpose();
    data.values.rightCols(acting.cols()).topRows(rest).rowwise() = acting.row(0);
    data.values.rightCols(acting.cols()).bottomRows(acting.rows()) = acting;
    return asRead(data, m.same_row);
  };
  const auto run = [&](ModelKind kind, Eigen::Index rest) {
    return Matrix(predictKind(m, kind, from(rest)).free_run.bottomRows(acting.rows()));
  };
  const auto byPast = [&](ModelKind kind) {
    return run(kind, longestLag(kind == ModelKind::kLinear ? m.linearModel() : m.model));
  };
  constexpr Eigen::Index kRest = 200;  // of a state of its own, beyond any delay
  Matrix y(acting.rows(), n_y);
  for (std::size_t i = 0; i < m.model.outputs.size(); ++i) {
    const auto c = static_cast<Eigen::Index>(i);
    const ModelKind kind = i < m.outputs.size() ? m.outputs[i].best : ModelKind::kRegressors;
    if (kind == ModelKind::kBlend)
      y.col(c) = 0.5 * (byPast(ModelKind::kRegressors) + run(ModelKind::kState, kRest)).col(c);
    else
      y.col(c) = (kind == ModelKind::kState ? run(kind, kRest) : byPast(kind)).col(c);
  }
  y.row(0) = start.transpose();
  return y;
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
      .def("simulate",
           [](const ModelHandle& h, py::handle y0, py::handle u, py::handle d) {
             const TsModel& model = h.identified.model;
             Vector start = Vector::Constant(countOf(model.outputs), kNaN);
             readSignals(y0, namesOf(model.outputs), "y0", start);
             require(start.allFinite(), "y0", "a number for every output");
             const Matrix acting = actingOn(model, u, d);
             return toArray(withoutGil([&] { return simulated(h, start, acting); }));
           })
      .def("predict",
           [](const ModelHandle& h, py::handle y, py::handle u, py::handle d, int steps) {
             require(steps >= 1, "steps", "an integer >= 1");
             const DataSet data = dataOf(h.identified, y, u, d);
             return toArray(withoutGil([&] {
               return steps == 1 ? Matrix(predictBest(h.identified, data).one_step)
                                 : Matrix(predictSteps(h.identified, data, steps).best);
             }));
           })
      .def("validate",
           [](const ModelHandle& h, py::handle record, const std::string& rows,
              const Names& columns, int steps) {
             tool::ValidateArguments a;
             a.rows = rows;
             a.columns = columns;
             a.steps = steps;
             const CsvTable table = tableFrom(record, tool::csvFormat(a.format));
             return withoutGil([&] {
               return tool::validateOn(table, h.identified, a)
                   .json.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
             });
           })
      .def("linearise", &linearised);
  m.def("identify", &identifyFrom);
  m.def("read_model", [](const std::string& name) {
    return std::make_shared<ModelHandle>(ModelHandle{readIdentified(tool::requireModel(name)), {}});
  });
}

}  // namespace fpc::python
