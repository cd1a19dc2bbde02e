// Plant type `transfer_matrix`: plant.matrix holds lags with dead times.
#include "config/read.hpp"
#include "plant/transfer_matrix.hpp"

namespace fpc {
namespace {

std::vector<Quantity> readQuantities(YamlSection& section, const std::string& key) {
  std::vector<Quantity> quantities;
  for (auto& item : section.list(key)) {
    Quantity q{"", "-", 0.0, -1e6, 1e6};
    need(item, "name", "a name");
    item.text("name", q.name);
    item.text("unit", q.unit);
    item.number("nominal", q.nominal, kFinite);
    item.number("lower", q.lower, kFinite);
    item.number("upper", q.upper, kFinite);
    item.finish();
    quantities.push_back(std::move(q));
  }
  return quantities;
}

TransferElement readElement(YamlSection& item) {
  TransferElement e;
  for (const char* key : {"output", "from", "gain", "time_constant_min"})
    need(item, key, "a value");
  item.text("output", e.output);
  item.text("from", e.from);
  item.number("gain", e.gain, kFinite);
  item.number("time_constant_min", e.time_constant, kFinitePositive);
  item.number("dead_time_min", e.dead_time, kFiniteNotNegative);
  item.number("second_time_constant_min", e.second_time_constant, kFiniteNotNegative);
  item.finish();
  return e;
}

PlantFactory readMatrixPlant(YamlSection& plant) {
  need(plant, "matrix", "outputs, inputs and elements");
  YamlSection section = plant.section("matrix");
  TransferMatrix matrix;
  matrix.name = "transfer_matrix";
  matrix.title = "Matrix of lags with dead times, of the loop file";
  matrix.outputs = readQuantities(section, "outputs");
  matrix.inputs = readQuantities(section, "inputs");
  matrix.disturbances = readQuantities(section, "disturbances");
  for (auto& item : section.list("elements")) matrix.elements.push_back(readElement(item));
  section.finish();
  if (matrix.empty()) section.fail("elements", "at least one element");
  checked(section, [&] { matrix.validate(); });
  return [matrix](const PlantParameters& none) {
    auto made = std::make_unique<TransferMatrixPlant>(matrix);
    parameterValues(made->description(), none);  // has none: refuses every name
    return made;
  };
}

const bool kTransferMatrixReaderRegistered = registerPlantReader(
    "transfer_matrix", "Any matrix of lags with dead times: plant.matrix", &readMatrixPlant);

}  // namespace
}  // namespace fpc
